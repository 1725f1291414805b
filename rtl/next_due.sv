// The first due one of a list: a priority encoder, without a clock.
//
// `first` has the lowest set bit of `pending` and no other, or none if nothing is pending.
module next_due #(
    parameter int WIDTH = 8
) (
    input  logic [WIDTH-1:0] pending,
    output logic [WIDTH-1:0] first
);
    assign first = pending & (~pending + 1'b1);
endmodule
