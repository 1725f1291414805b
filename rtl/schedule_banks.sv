// The two banks of the schedule memory with their due tables, and the swap between two slots.
//
// After reset the tables of the `active` bank are filled (`is_filled`). If a `swap` is wanted, those of
// the other one are, while the chip runs. Then, in a clock without slot_start, `takes` tells that the
// next slot is the first one of the other bank, and `is_swapping` holds until that slot begins. It
// begins when no row of an earlier slot waits (slot_sequencer), so that the samples of a slot are those
// of one bank.
module schedule_banks #(
    parameter int ROWS = 8,
    parameter int COLS = 8,
    parameter int CHANNELS = 2,
    parameter int GROUP_ROWS = 1,
    parameter int GROUP_COLS = 1,
    parameter int TILE_ROWS = 4,
    parameter int TILE_COLS = 4,
    parameter int PIXEL_BITS = 1,
    parameter int DEPTH = 16,  // slots
    parameter IMAGE = "",
    parameter int SLOT_BITS = $clog2(2 * DEPTH)
) (
    input  logic                   clk,
    input  logic                   rst,
    input  logic                   set_at,   // of the memory
    input  logic                   write,
    input  logic [31:0]            write_data,
    output logic                   write_bank,
    output logic                   is_beyond,
    input  logic [2*SLOT_BITS-1:0] periods,  // slots, at most DEPTH
    input  logic [2*SLOT_BITS-1:0] offsets,  // less than the period
    input  logic [15:0]            rows,
    input  logic [15:0]            cols,
    input  logic                   active,
    input  logic                   swap,
    input  logic                   slot_start,
    output logic                   is_filled,
    output logic                   takes,
    output logic                   is_swapping,
    output logic [SLOT_BITS-1:0]   period,   // of the bank of the next slot
    output logic [SLOT_BITS-1:0]   other_period,

    // Those of due_tables, of the bank of the next slot and of that of the scan.
    input  logic [SLOT_BITS-1:0]   next_slot,
    output logic [ROWS-1:0]        next_rows,
    output logic                   next_is_open,
    output logic                   after_is_open,
    input  logic [SLOT_BITS-1:0]   scan_slot,
    output logic [ROWS-1:0]        scan_rows,
    output logic [15:0]            scan_least,
    input  logic [15:0]            scan_row,
    output logic [COLS-1:0]        row_due,
    output logic [COLS-1:0]        row_columns
);
    localparam int ADDRESS_BITS = $clog2(DEPTH * TILE_ROWS);

    logic next_bank, scan_bank, filled_bank;
    logic [1:0] filled;
    logic [ADDRESS_BITS-1:0] image_address [0:1];
    logic [TILE_COLS*PIXEL_BITS-1:0] image_word;
    logic [ROWS-1:0] next_rows_of [0:1], scan_rows_of [0:1];
    logic [1:0] next_is_open_of, after_is_open_of;
    logic [15:0] scan_least_of [0:1];
    logic [COLS-1:0] row_due_of [0:1], row_columns_of [0:1];

    assign next_bank     = active ^ is_swapping;
    assign scan_bank     = slot_start ? next_bank : active;
    assign filled_bank   = active ^ filled[active];
    assign is_filled     = filled[active];
    assign takes         = swap && filled[!active] && !is_swapping && !slot_start;
    assign period        = periods[next_bank*SLOT_BITS+:SLOT_BITS];
    assign other_period  = periods[(!active)*SLOT_BITS+:SLOT_BITS];
    assign next_rows     = next_rows_of[next_bank];
    assign next_is_open  = next_is_open_of[next_bank];
    assign after_is_open = after_is_open_of[next_bank];
    assign scan_rows     = scan_rows_of[scan_bank];
    assign scan_least    = scan_least_of[scan_bank];
    assign row_due       = row_due_of[scan_bank];
    assign row_columns   = row_columns_of[scan_bank];

    always_ff @(posedge clk)
        if (rst) is_swapping <= 1'b0;
        else is_swapping <= takes || (is_swapping && !slot_start);

    schedule_memory #(
        .TILE_ROWS(TILE_ROWS), .TILE_COLS(TILE_COLS), .PIXEL_BITS(PIXEL_BITS), .DEPTH(DEPTH),
        .IMAGE(IMAGE)
    ) u_memory (
        .clk,
        .set_at,
        .at_bank(write_data[31]),
        .at(write_data[30:0]),
        .write,
        .part(write_data),
        .write_bank,
        .is_beyond,
        .bank(filled_bank),
        .address(image_address[filled_bank]),
        .word(image_word)
    );
    for (genvar b = 0; b < 2; b = b + 1) begin : g_bank
        due_tables #(
            .ROWS(ROWS), .COLS(COLS), .CHANNELS(CHANNELS), .GROUP_ROWS(GROUP_ROWS),
            .GROUP_COLS(GROUP_COLS), .TILE_ROWS(TILE_ROWS), .TILE_COLS(TILE_COLS),
            .PIXEL_BITS(PIXEL_BITS), .DEPTH(DEPTH)
        ) u_tables (
            .clk,
            .rst(rst || (active != 1'(b) && !swap)),
            .period(periods[b*SLOT_BITS+:SLOT_BITS]),
            .offset(offsets[b*SLOT_BITS+:SLOT_BITS]),
            .rows,
            .cols,
            .image_address(image_address[b]),
            .image_word,
            .is_ready(filled[b]),
            .next_slot,
            .next_rows(next_rows_of[b]),
            .next_is_open(next_is_open_of[b]),
            .after_is_open(after_is_open_of[b]),
            .scan_slot,
            .scan_rows(scan_rows_of[b]),
            .scan_least(scan_least_of[b]),
            .scan_row,
            .row_due(row_due_of[b]),
            .row_columns(row_columns_of[b])
        );
    end
endmodule
