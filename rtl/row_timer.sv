// The ends of the rows: a row is read when it has left the chip and its row time is over, which is
// at least that of its conversion except in the sequential law.
//
// `transfer` starts the timer of a row, `transfer_end` tells that it has left. `done` is a strobe
// for each timer, `done_row` holds the row, at the earliest in the clock of `transfer_end`:
// blanking_clocks after the end of its transfer and of min_clocks. Rows end in the order of their
// transfers if their conversions take the same time; `overflow` if no timer is free.
module row_timer #(
    parameter int ROW_BITS = 8,
    parameter int TIMERS = 4,  // a power of two
    parameter int CLOCK_BITS = 32
) (
    input  logic                       clk,
    input  logic                       rst,
    input  logic                       transfer,
    input  logic [ROW_BITS-1:0]        row,         // at `transfer`
    input  logic [CLOCK_BITS-1:0]      min_clocks,  // of it, since `transfer`
    input  logic [CLOCK_BITS-1:0]      blanking_clocks,
    input  logic                       transfer_end,
    output logic [TIMERS-1:0]          done,
    output logic [TIMERS*ROW_BITS-1:0] done_row,
    output logic                       overflow
);
    localparam int BITS = $clog2(TIMERS);

    logic [BITS-1:0] newest;  // timer of the row under transfer
    logic [BITS-1:0] next;
    logic [TIMERS-1:0] runs;

    assign next     = newest + 1'b1;
    assign overflow = transfer && runs[next] && !done[next];

    always_ff @(posedge clk)
        if (rst) newest <= '0;
        else if (transfer) newest <= next;

    for (genvar i = 0; i < TIMERS; i = i + 1) begin : g_timer
        logic [ROW_BITS-1:0] held_row;
        logic [CLOCK_BITS-1:0] least, age, rested;
        logic has_left, has_left_now, is_over, starts;

        assign starts       = transfer && next == BITS'(i);
        assign has_left_now = has_left || (transfer_end && newest == BITS'(i));
        assign is_over      = runs[i] && has_left_now && age >= least;
        assign done[i]      = is_over && rested == blanking_clocks;
        assign done_row[i*ROW_BITS+:ROW_BITS] = held_row;

        always_ff @(posedge clk) begin
            if (rst) runs[i] <= 1'b0;
            else runs[i] <= starts || (runs[i] && !done[i]);
            has_left <= !starts && has_left_now;
            age      <= starts ? CLOCK_BITS'(1) : age + 1'b1;
            rested   <= starts ? '0 : rested + CLOCK_BITS'(is_over);
            if (starts) begin
                held_row <= row;
                least <= min_clocks;
            end
        end
    end
endmodule
