// fifo: if no item is popped from an empty queue and none is lost, each item comes out unchanged, in
// order. A watched item, any one, stands for all.
module fifo_proof #(
    parameter int WIDTH = 4,
    parameter int DEPTH = 4
) (
    input logic             clk,
    input logic             rst,
    input logic             push,
    input logic [WIDTH-1:0] item,
    input logic             pop,
    input logic             watch
);
    logic valid, overflow;
    logic [WIDTH-1:0] head, watched;
    logic has_watched, was_watched, is_taken;
    logic [7:0] count, before;  // in the queue; of these, before the watched one

    fifo #(.WIDTH(WIDTH), .DEPTH(DEPTH)) u_fifo (
        .clk, .rst, .push, .item, .pop, .valid, .head, .overflow
    );

    assign is_taken = has_watched ? before == '0 : push && watch && !was_watched && count == '0;
    initial assume (rst);
    always_comb
        if (!rst) begin
            assume (!pop || valid);
            assume (!overflow);
        end

    always_ff @(posedge clk)
        if (rst) begin
            has_watched <= 1'b0;
            was_watched <= 1'b0;
            count <= '0;
        end else begin
            count <= count + 8'(push) - 8'(pop);
            assert (valid == (count != '0 || push));
            assert (count <= 8'(DEPTH));
            if (push && watch && !was_watched) begin
                was_watched <= 1'b1;
                watched <= item;
                before <= count - 8'(pop);
                has_watched <= !(pop && is_taken);
                if (pop && is_taken) assert (head == item);
            end else if (has_watched) begin
                assert (before < count);
                if (pop) before <= before - 1'b1;
                if (pop && is_taken) has_watched <= 1'b0;
                if (is_taken) assert (head == watched);
            end
        end
endmodule
