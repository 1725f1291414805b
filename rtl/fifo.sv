// A queue that an item passes in no time: `head` is valid in the clock of the push into an empty
// queue, and may be popped in that clock.
//
// DEPTH is a power of two. `overflow` is a clock in which an item is lost.
module fifo #(
    parameter int WIDTH = 8,
    parameter int DEPTH = 4
) (
    input  logic             clk,
    input  logic             rst,
    input  logic             push,
    input  logic [WIDTH-1:0] item,
    input  logic             pop,
    output logic             valid,
    output logic [WIDTH-1:0] head,
    output logic             overflow
);
    localparam int BITS = $clog2(DEPTH);

    logic [WIDTH-1:0] items [0:DEPTH-1];
    logic [BITS:0] pushed, popped;  // the highest bit tells full from empty
    logic is_empty;

    assign is_empty = pushed == popped;
    assign valid    = !is_empty || push;
    assign head     = is_empty ? item : items[popped[BITS-1:0]];
    assign overflow = push && !pop && (pushed - popped) == (BITS + 1)'(DEPTH);

    always_ff @(posedge clk) begin
        if (push) items[pushed[BITS-1:0]] <= item;
        if (rst) begin
            pushed <= '0;
            popped <= '0;
        end else begin
            if (push) pushed <= pushed + 1'b1;
            if (pop) popped <= popped + 1'b1;
        end
    end

`ifdef STIPPLE_ASSERT
    logic lost;  // an item was
    always_ff @(posedge clk) begin
        lost <= !rst && (lost || overflow);
        if (!rst) begin
            assert (!pop || valid);
            assert (lost || pushed - popped <= (BITS + 1)'(DEPTH));
        end
    end
`endif
endmodule
