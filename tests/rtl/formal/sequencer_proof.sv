// chip_control, schedule_banks, scan_scheduler and row_scanner, with any due rows in two banks of two
// slots, any commands after START, and a readout that is done with its rows after any time, the last
// one of a scan at the end. Slots are stretched, pixels are exposed during scans.
module sequencer_proof #(
    parameter int ROWS = 4,
    parameter int DEPTH = 2,
    parameter int SLOT_BITS = 2,
    parameter int PLACES = ROWS + 1,
    parameter int PLACE_BITS = 3
) (
    input logic              clk,
    input logic              rst,
    input logic              control_write,
    input logic [2:0]        control,
    input logic              may_select,
    input logic [PLACES-1:0] ends
);
    (* anyconst *) logic [2*SLOT_BITS-1:0] periods;
    (* anyconst *) logic [1:0] slot_clocks;
    (* anyconst *) logic select_wait;
    (* anyconst *) logic has_dark;

    logic is_running, is_exposing, active, swap_pending, core_rst, stops, is_swapping, is_over;
    logic is_filled, is_ready, takes, slot_waits, scan_start, is_reading, scan_over, slot_start;
    logic select, is_last, overflow, refused;
    logic [31:0] slot_count, swap_slot;
    logic [SLOT_BITS-1:0] period, other_period, next_slot, scan_slot;
    logic [ROWS-1:0] next_rows, scan_rows, kept_rows, rows_done;
    logic [15:0] scan_number;
    logic [PLACE_BITS-1:0] place;

    chip_control u_control (
        .clk, .rst, .control_write, .control,
        .slots('0), .can_run(1'b1), .can_use(2'b11), .drops(1'b0), .refused,
        .is_running, .is_exposing, .active_bank(active), .swap_pending, .core_rst, .stops,
        .slot_start, .is_swapping, .is_over, .is_idle(1'b0), .packet_valid(1'b0),
        .packet_flags('0), .packet_samples('0), .slot_count, .swap_slot
    );
    schedule_banks #(
        .ROWS(ROWS), .COLS(1), .CHANNELS(1), .TILE_ROWS(1), .TILE_COLS(1), .DEPTH(DEPTH)
    ) u_banks (
        .clk, .rst(core_rst), .set_at(1'b0), .write(1'b0), .write_data('0), .periods,
        .offsets('0), .rows(16'(ROWS)), .cols(16'd1), .active, .swap(swap_pending && is_exposing),
        .slot_start, .is_filled, .takes, .is_swapping, .period, .other_period, .next_slot,
        .next_rows, .scan_slot, .scan_rows, .scan_row('0)
    );
    scan_scheduler #(.ROWS(ROWS), .DEPTH(DEPTH)) u_scheduler (
        .clk, .rst(core_rst), .is_filled, .is_ready, .stops, .takes, .is_swapping, .period,
        .other_period, .exposes_while_reading(1'b1), .drops(1'b0), .slot_clocks(32'(slot_clocks)),
        .budget_clocks('0), .rows(16'(ROWS)), .next_slot, .next_rows, .next_is_open(1'b0),
        .after_is_open(1'b0), .scan_slot, .scan_rows, .kept_rows, .slot_waits, .scan_start,
        .is_reading, .rows_done, .scan_over, .slot_start, .is_over, .scan_number, .overflow
    );
    row_scanner #(.ROWS(ROWS), .DARK_ROWS(1), .WAIT_BITS(2)) u_scanner (
        .clk, .rst(core_rst), .slot_waits, .slot_rows(scan_rows & kept_rows),
        .dark_rows(PLACE_BITS'(has_dark)), .select_wait(2'(select_wait)),
        .transfer_wait(2'(select_wait)), .may_select, .scan_over, .scan_start, .is_reading,
        .select, .place, .is_last
    );

    // The readout.
    logic [PLACES-1:0] under_way, last, done;
    assign done      = ends & under_way;
    assign rows_done = done[PLACES-1:1];
    assign scan_over = (done & last) != '0;
    always_ff @(posedge clk)
        if (core_rst) begin
            under_way <= '0;
            last <= '0;
        end else begin
            under_way <= (under_way & ~done) | (select ? PLACES'(1) << place : '0);
            last <= (scan_over ? '0 : last) | (select && is_last ? PLACES'(1) << place : '0);
        end

    // What waits: rows by the slot in which they are due, and its bank.
    logic begun;
    logic [5:0] number, last_scan, scan;
    logic [2:0] age;
    logic [ROWS-1:0] held_waits, waits, held_chosen, chosen, left, chosen_now, of_scan;
    logic [5:0] held_slot_of [0:ROWS-1];
    logic [ROWS-1:0] held_bank_of, bank_of;
    logic [5:0] slot_of [0:ROWS-1];
    logic bank, may_begin;
    assign left       = held_waits & ~rows_done;
    assign bank       = active ^ (slot_start && is_swapping);
    assign chosen_now = select && place != '0 ? ROWS'(1) << (place - 1'b1) : '0;
    assign scan       = scan_number[5:0];
    for (genvar r = 0; r < ROWS; r = r + 1) begin : g_row
        logic begins;
        assign begins     = slot_start && next_rows[r];
        assign waits[r]   = begins || left[r];
        assign chosen[r]  = !begins && held_chosen[r];
        assign slot_of[r] = begins ? number : held_slot_of[r];
        assign bank_of[r] = begins ? bank : held_bank_of[r];
        assign of_scan[r] = waits[r] && slot_of[r] == scan;
        always_ff @(posedge clk) begin
            held_slot_of[r] <= slot_of[r];
            held_bank_of[r] <= bank_of[r];
            if (!core_rst) begin
                assert (!begins || !left[r]);  // due again before it was read
                if (rows_done[r]) assert (held_waits[r] && held_chosen[r]);
                if (chosen_now[r]) assert (of_scan[r] && !chosen[r] && bank_of[r] == bank);
                if (scan_start && waits[r] && !chosen[r]) assert (slot_of[r] >= scan);
                if (scan_over && held_waits[r]) assert (held_slot_of[r] != last_scan || held_chosen[r]);
            end
        end
    end
    assign may_begin = (left & (is_swapping ? '1 : next_rows)) == '0;

    logic was_swapped;
    always_ff @(posedge clk) begin
        was_swapped <= !core_rst && slot_start && is_swapping;
        if (core_rst) begin
            begun <= 1'b0;
            number <= '0;
            age <= '0;
            held_waits <= '0;
            held_chosen <= '0;
            last_scan <= '1;
        end else begin
            begun <= begun || slot_start;
            number <= number + 6'(slot_start);
            age <= slot_start ? 3'd1 : age + 3'(age != '1);
            held_waits <= waits;
            held_chosen <= chosen | chosen_now;
            if (scan_start) last_scan <= scan;
            // A slot begins in the first clock in which it may, a scan in which a row waits, and a
            // row is selected in which it can be.
            if (begun && !is_over)
                assert (slot_start == (age >= 3'(slot_clocks) && may_begin && !stops));
            assert (is_reading || (waits & ~chosen) == '0);
            assert (select || !may_select || select_wait || (of_scan & ~chosen) == '0 || !is_reading);
            assert (!scan_start || last_scan == '1 || scan > last_scan);
            assert (!overflow);
            // A swap.
            if (slot_start && is_swapping) assert (left == '0 && swap_pending);
            if (was_swapped) assert (!swap_pending && !is_swapping);
        end
    end

    logic started;
    initial assume (rst && core_rst);
    always_ff @(posedge clk) started <= !rst;
    always_comb begin
        assume (slot_clocks != '0);
        for (int b = 0; b < 2; b = b + 1)
            assume (periods[b*SLOT_BITS+:SLOT_BITS] == 2'd1 || periods[b*SLOT_BITS+:SLOT_BITS] == 2'd2);
        assume (!scan_over || (under_way & ~done) == '0);
        if (!rst && !started) assume (control_write && control == 3'b001);
    end
    always_ff @(posedge clk) if (!$initstate) assume (!rst);
    always_ff @(posedge clk) cover (was_swapped && number == 6'd4);
endmodule

// Stands for the tables: any due rows.
module due_tables #(
    parameter int ROWS = 8,
    parameter int COLS = 8,
    parameter int CHANNELS = 2,
    parameter int GROUP_ROWS = 1,
    parameter int GROUP_COLS = 1,
    parameter int TILE_ROWS = 4,
    parameter int TILE_COLS = 4,
    parameter int PIXEL_BITS = 1,
    parameter int DEPTH = 16,
    parameter int SLOT_BITS = $clog2(2 * DEPTH)
) (
    input  logic                 clk,
    input  logic                 rst,
    input  logic [SLOT_BITS-1:0] period,
    input  logic [SLOT_BITS-1:0] offset,
    input  logic [15:0]          rows,
    input  logic [15:0]          cols,
    output logic                 image_address,
    input  logic                 image_word,
    output logic                 is_ready,
    input  logic [SLOT_BITS-1:0] next_slot,
    output logic [ROWS-1:0]      next_rows,
    output logic                 next_is_open,
    output logic                 after_is_open,
    input  logic [SLOT_BITS-1:0] scan_slot,
    output logic [ROWS-1:0]      scan_rows,
    output logic [15:0]          scan_least,
    input  logic [15:0]          scan_row,
    output logic [COLS-1:0]      row_due,
    output logic [COLS-1:0]      row_columns
);
    (* anyconst *) logic [2*DEPTH*ROWS-1:0] table_rows;
    assign next_rows = table_rows[next_slot*ROWS+:ROWS];
    assign scan_rows = table_rows[scan_slot*ROWS+:ROWS];
    assign {next_is_open, after_is_open, scan_least, row_due, row_columns, image_address} = '0;
    always_ff @(posedge clk) is_ready <= !rst;
endmodule

module schedule_memory #(
    parameter int TILE_ROWS = 1,
    parameter int TILE_COLS = 1,
    parameter int PIXEL_BITS = 1,
    parameter int DEPTH = 1,
    parameter IMAGE = ""
) (
    input  logic        clk,
    input  logic        set_at,
    input  logic        at_bank,
    input  logic [30:0] at,
    input  logic        write,
    input  logic [31:0] part,
    output logic        write_bank,
    output logic        is_beyond,
    input  logic        bank,
    input  logic        address,
    output logic        word
);
    assign {write_bank, is_beyond, word} = '0;
endmodule
