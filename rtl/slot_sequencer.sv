// The slots: when each of them begins, which rows then wait for their readout, and whether it
// lasted too long.
//
// `slot_start` begins a slot, the first one as soon as `is_ready`. The samples of the exposures
// that end with it are ready then, in the rows `next_rows`. A slot lasts slot_clocks, and if the
// chip `stretches` slots, until no row that is due in the next one still waits. `rows_done` frees
// rows in this clock. A chip that cannot expose while it reads does not count the clocks of a scan
// (`is_reading`) if a pixel is open in the next slot. `slot_end` comes with the next slot_start and
// tells of the slot that has ended whether rows were due in it, and whether it was longer than
// budget_clocks (0: no limit).
//
// `takes` makes the slot other_period the next one, of another bank of the schedule memory, and
// `is_swapping` lets it begin only when no row waits. If the chip `stops`, the slot that would begin
// does not, and none does any more (`is_over`).
//
// Slots count in the tables of the program: slots 0 .. period - 1 are those of the first period,
// period .. 2 x period - 1 stand for all later ones.
module slot_sequencer #(
    parameter int ROWS = 8,
    parameter int SLOT_BITS = 8,  // of a slot of the tables
    parameter int LENGTH_BITS = 42
) (
    input  logic                   clk,
    input  logic                   rst,
    input  logic                   is_ready,
    input  logic                   stops,
    input  logic                   takes,
    input  logic                   is_swapping,
    input  logic [SLOT_BITS-1:0]   period,
    input  logic [SLOT_BITS-1:0]   other_period,
    input  logic                   exposes_while_reading,
    input  logic                   stretches,
    input  logic [LENGTH_BITS-1:0] slot_clocks,
    input  logic [LENGTH_BITS-1:0] budget_clocks,
    input  logic [ROWS-1:0]        next_rows,  // of next_slot
    input  logic                   next_is_open,   // a pixel is, in next_slot
    input  logic                   after_is_open,  // ... in the slot after it
    input  logic [ROWS-1:0]        rows_done,
    input  logic                   is_reading,
    output logic [SLOT_BITS-1:0]   next_slot,
    output logic                   slot_start,
    output logic                   slot_end,
    output logic                   ended_has_rows,
    output logic                   ended_overrun,
    output logic                   is_over
);
    logic has_begun, has_rows, pauses, is_due, may_begin;
    logic [LENGTH_BITS-1:0] length;   // of the slot so far, at most all ones
    logic [LENGTH_BITS-1:0] counted;  // clocks of it that count, the same
    logic [ROWS-1:0] waits, still_waits;

    assign still_waits    = waits & ~rows_done;
    assign may_begin      = !stretches || (still_waits & (is_swapping ? '1 : next_rows)) == '0;
    assign is_due         = !is_over && (has_begun ? counted >= slot_clocks && may_begin : is_ready);
    assign slot_start     = is_due && !stops;
    assign slot_end       = is_due && has_begun;
    assign ended_has_rows = has_rows;
    assign pauses         = !exposes_while_reading && is_reading &&
                            (slot_start ? after_is_open : next_is_open);
    assign ended_overrun  = budget_clocks != '0 && length > budget_clocks;

    always_ff @(posedge clk)
        if (rst) begin
            has_begun <= 1'b0;
            has_rows <= 1'b0;
            length <= '0;
            counted <= '0;
            waits <= '0;
            next_slot <= '0;
            is_over <= 1'b0;
        end else if (slot_start) begin
            has_begun <= 1'b1;
            has_rows <= next_rows != '0;
            length <= LENGTH_BITS'(1);
            counted <= LENGTH_BITS'(!pauses);
            waits <= still_waits | next_rows;
            next_slot <= next_slot + 1'b1 == period << 1 ? period : next_slot + 1'b1;
        end else begin
            length <= length + LENGTH_BITS'(length != '1);
            counted <= counted + LENGTH_BITS'(counted != '1 && !pauses);
            waits <= still_waits;
            if (takes) next_slot <= other_period;
            is_over <= is_over || is_due;
        end

`ifdef STIPPLE_ASSERT
    // Rows that wait are due in no slot that begins, if slots are stretched.
    always_ff @(posedge clk)
        if (!rst && slot_start && has_begun) begin
            assert (counted >= slot_clocks);
            assert (!stretches || (waits & ~rows_done & next_rows) == '0);
        end
`endif
endmodule
