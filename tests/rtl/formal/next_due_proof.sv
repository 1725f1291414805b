// next_due: `first` is the lowest pending one, of any list.
module next_due_proof #(
    parameter int WIDTH = 8
) (
    input logic [WIDTH-1:0] pending
);
    logic [WIDTH-1:0] first;

    next_due #(.WIDTH(WIDTH)) u_next (
        .pending,
        .first
    );

    for (genvar i = 0; i < WIDTH; i = i + 1) begin : g_item
        always_comb assert (first[i] == (pending[i] && (pending & ((WIDTH'(1) << i) - 1'b1)) == '0));
    end
endmodule
