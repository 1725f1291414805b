// The slots and their scans: begins slots, lets those with due rows wait for the one scan in their
// order, and drops rows that would miss their deadline.
//
// `slot_start` begins a slot; what is known of it follows in the clock of `slot_end`. A scan begins
// (`scan_start`) if `slot_waits`, with those of its rows that are in kept_rows. It is that of the
// slot `scan_number`, counted from 0; sent_number and sent_end_row (rows from there on are dropped)
// are those of the rows that leave in this clock. Slots before `undecided` are not scanned any more
// than they are now. Before `is_ready` scans are rehearsed (deadline_table).
module scan_scheduler #(
    parameter int ROWS = 8,
    parameter int DEPTH = 16,
    parameter int SLOT_BITS = $clog2(2 * DEPTH)
) (
    input  logic                 clk,
    input  logic                 rst,
    input  logic                 is_filled,  // the tables are
    output logic                 is_ready,
    input  logic                 stops,
    input  logic                 takes,
    input  logic                 is_swapping,
    input  logic [SLOT_BITS-1:0] period,
    input  logic [SLOT_BITS-1:0] other_period,
    input  logic                 exposes_while_reading,
    input  logic                 drops,
    input  logic [31:0]          slot_clocks,
    input  logic [31:0]          budget_clocks,
    input  logic [15:0]          rows,
    output logic [SLOT_BITS-1:0] next_slot,
    input  logic [ROWS-1:0]      next_rows,
    input  logic                 next_is_open,
    input  logic                 after_is_open,
    output logic [SLOT_BITS-1:0] scan_slot,
    input  logic [ROWS-1:0]      scan_rows,
    output logic [ROWS-1:0]      kept_rows,
    output logic                 slot_waits,
    input  logic                 scan_start,
    input  logic                 is_reading,
    input  logic [ROWS-1:0]      rows_done,
    input  logic                 scan_over,
    output logic                 slot_start,
    output logic                 slot_end,
    output logic                 is_over,
    output logic                 ended_has_rows,
    output logic                 ended_overrun,
    output logic [15:0]          ended_first_row,
    output logic [15:0]          undecided,
    output logic [15:0]          scan_number,
    output logic [15:0]          sent_number,
    output logic [15:0]          sent_end_row,
    output logic                 overflow
);
    localparam int TIME_BITS = 48;

    logic [SLOT_BITS-1:0] begun_slot;

    slot_sequencer #(.ROWS(ROWS), .SLOT_BITS(SLOT_BITS), .LENGTH_BITS(42)) u_slots (
        .clk, .rst,
        .is_ready,
        .stops,
        .takes,
        .is_swapping,
        .period,
        .other_period,
        .exposes_while_reading,
        .stretches(!drops),
        .slot_clocks(42'(slot_clocks)),
        .budget_clocks(42'(budget_clocks)),
        .next_rows,
        .next_is_open,
        .after_is_open,
        .rows_done,
        .is_reading,
        .next_slot(begun_slot),
        .slot_start,
        .slot_end,
        .ended_has_rows,
        .ended_overrun,
        .is_over
    );

    // Deadlines, and the queue of slots with rows to read.
    logic [SLOT_BITS-1:0] rehearsed_slot, queued_slot, held_scan_slot;
    logic rehearses, is_rehearsing, queue_valid;
    logic [ROWS*TIME_BITS-1:0] next_slack, scan_slack;
    logic [ROWS-1:0] next_first, late_rows, first_late;
    logic [TIME_BITS-1:0] now, first_slack, delay, begun;
    logic [15:0] slot_number, queued_number, end_row, first_row;

    deadline_table #(.ROWS(ROWS), .DEPTH(DEPTH), .TIME_BITS(TIME_BITS)) u_deadlines (
        .clk, .rst,
        .is_filled,
        .drops,
        .exposes_while_reading,
        .period,
        .slot_clocks(TIME_BITS'(slot_clocks)),
        .is_ready,
        .slot(rehearsed_slot),
        .slot_rows(next_rows),
        .after_is_open,
        .rehearses,
        .scan_start,
        .scan_over,
        .rows_done,
        .next_slot,
        .next_slack,
        .scan_slot,
        .scan_slack
    );
    assign next_slot = is_ready ? begun_slot : rehearsed_slot;

    next_due #(.WIDTH(ROWS)) u_first_row (
        .pending(next_rows),
        .first(next_first)
    );
    always_comb begin
        first_slack = '0;
        first_row = '0;
        for (int r = 0; r < ROWS; r = r + 1)
            if (next_first[r]) begin
                first_slack = first_slack | next_slack[r*TIME_BITS+:TIME_BITS];
                first_row = first_row | 16'(r);
            end
    end
    scan_queue #(
        .DEPTH(2 ** $clog2(DEPTH + 2)), .SLOT_BITS(SLOT_BITS), .TIME_BITS(TIME_BITS)
    ) u_scan_queue (
        .clk, .rst,
        .now,
        .push(slot_start && next_rows != '0),
        .push_slot(next_slot),
        .push_number(slot_number),
        .push_limit(drops ? now + first_slack : {1'b0, {(TIME_BITS - 1){1'b1}}}),
        .pop(scan_start && is_ready),
        .valid(queue_valid),
        .slot(queued_slot),
        .number(queued_number),
        .begun,
        .undecided,
        .overflow
    );

    // Rows of a scan from the first one on that would be late are dropped.
    assign delay = now - begun;
    for (genvar r = 0; r < ROWS; r = r + 1) begin : g_late
        assign late_rows[r] = drops && is_ready && scan_rows[r] &&
            $signed(delay) > $signed(scan_slack[r*TIME_BITS+:TIME_BITS]);
    end
    next_due #(.WIDTH(ROWS)) u_first_late (
        .pending(late_rows),
        .first(first_late)
    );
    assign kept_rows = late_rows == '0 ? '1 : first_late - 1'b1;
    always_comb begin
        end_row = late_rows == '0 ? rows : '0;
        for (int r = 0; r < ROWS; r = r + 1) if (first_late[r]) end_row = end_row | 16'(r);
    end
    assign slot_waits   = is_ready ? queue_valid : rehearses && !is_rehearsing;
    assign scan_slot    = !is_ready ? rehearsed_slot : scan_start ? queued_slot : held_scan_slot;
    assign scan_number  = scan_start ? queued_number : sent_number;

    always_ff @(posedge clk)
        if (rst) begin
            now <= '0;
            slot_number <= '0;
            is_rehearsing <= 1'b0;
        end else begin
            now <= now + 1'b1;
            slot_number <= slot_number + 16'(slot_start);
            is_rehearsing <= !is_ready && is_reading;
        end

    always_ff @(posedge clk) begin
        held_scan_slot <= scan_slot;
        sent_number <= scan_number;
        if (scan_start) sent_end_row <= end_row;
        if (slot_start) ended_first_row <= first_row;
    end
endmodule
