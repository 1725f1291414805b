// By when the scan of a slot must begin so that a row of it meets its deadline: for the overrun
// policy "drop". After the other tables are filled (`is_filled`) each slot is rehearsed, the last
// one first: its scan is run, and the clocks until each of its rows is done are noted. `is_ready`
// comes at once if the chip does not drop rows.
//
// The deadline of a row is the slot in which it is due again; on a chip that cannot expose while it
// reads, the next slot in which a pixel is open. `slack` of a row is the deadline, in clocks since
// its slot began, less those until it is done: a scan that begins later is too late for it. The
// slacks follow their slots without a clock.
module deadline_table #(
    parameter int ROWS = 8,
    parameter int DEPTH = 16,
    parameter int SLOT_BITS = $clog2(2 * DEPTH),
    parameter int TIME_BITS = 48
) (
    input  logic                      clk,
    input  logic                      rst,
    input  logic                      is_filled,
    input  logic                      drops,
    input  logic                      exposes_while_reading,
    input  logic [SLOT_BITS-1:0]      period,
    input  logic [TIME_BITS-1:0]      slot_clocks,
    output logic                      is_ready,
    output logic [SLOT_BITS-1:0]      slot,  // rehearsed
    input  logic [ROWS-1:0]           slot_rows,
    input  logic                      after_is_open,  // a pixel is, in the slot after it
    output logic                      rehearses,      // a scan of `slot` waits or is under way
    input  logic                      scan_start,
    input  logic                      scan_over,
    input  logic [ROWS-1:0]           rows_done,
    input  logic [SLOT_BITS-1:0]      next_slot,
    output logic [ROWS*TIME_BITS-1:0] next_slack,
    input  logic [SLOT_BITS-1:0]      scan_slot,
    output logic [ROWS*TIME_BITS-1:0] scan_slack
);
    localparam logic [1:0] WAIT = 0, WARM_UP = 1, REHEARSE = 2, READY = 3;

    logic [1:0] step;
    logic is_next;  // the slot before this one is the next
    logic [TIME_BITS-1:0] age, held_age;  // of the scan
    logic [TIME_BITS-1:0] closed, closed_before;  // clocks of closed slots

    assign is_ready  = step == READY;
    assign rehearses = step == REHEARSE && slot_rows != '0;
    assign is_next   = step == WARM_UP || (step == REHEARSE && (!rehearses || scan_over));
    assign age       = scan_start ? '0 : held_age;
    assign closed    = after_is_open ? '0 : closed_before + slot_clocks;

    always_ff @(posedge clk)
        if (rst) begin
            step <= WAIT;
            slot <= '0;
            closed_before <= '0;
        end else begin
            case (step)
                WAIT: begin
                    slot <= (period << 1) - 1'b1;
                    if (is_filled) step <= drops ? WARM_UP : READY;
                end
                WARM_UP: begin  // a period, for what follows the last slot
                    slot <= slot == period ? (period << 1) - 1'b1 : slot - 1'b1;
                    if (slot == period) step <= REHEARSE;
                end
                REHEARSE: if (is_next) begin
                    slot <= slot - 1'b1;
                    if (slot == '0) step <= READY;
                end
                default: ;
            endcase
            if (is_next) closed_before <= closed;
        end

    always_ff @(posedge clk) held_age <= age + 1'b1;

    for (genvar r = 0; r < ROWS; r = r + 1) begin : g_row
        logic [TIME_BITS-1:0] slacks [0:2*DEPTH-1];
        logic [TIME_BITS-1:0] until_due;  // again, after this slot
        assign next_slack[r*TIME_BITS+:TIME_BITS] = slacks[next_slot];
        assign scan_slack[r*TIME_BITS+:TIME_BITS] = slacks[scan_slot];
        always_ff @(posedge clk) begin
            if (rst) until_due <= slot_clocks;
            else if (is_next) until_due <= slot_rows[r] ? slot_clocks : until_due + slot_clocks;
            if (rehearses && rows_done[r])
                slacks[slot] <= (exposes_while_reading ? until_due : closed) - age;
        end
    end
endmodule
