// Which pixels are due in which slot. After reset the tables are filled from the schedule memory,
// in about (3 TILE_ROWS + 2 ROWS) x period clocks; then `is_ready` holds.
//
//  1. One period without readout finds the exposures under way at slot 0, by charge store, and the
//     slots in which a pixel is open.
//  2. Slots 0 .. period - 1: a pixel is due if it is read, but not if the exposure began before
//     slot 0. Slots period .. 2 x period - 1 stand for all later ones: due is what is read.
//  3. For each of these slots, the least columns that the busiest channel has in a row.
//
// The rows of a group (GROUP_ROWS x GROUP_COLS pixels; 1 x 1: columns are skipped one by one) are
// read together, and all columns of a group with a due pixel are transferred. The outputs follow
// their slots and rows without a clock. Pixels outside the window rows x cols are never due.
module due_tables #(
    parameter int ROWS = 8,
    parameter int COLS = 8,
    parameter int CHANNELS = 2,
    parameter int GROUP_ROWS = 1,
    parameter int GROUP_COLS = 1,
    parameter int TILE_ROWS = 4,
    parameter int TILE_COLS = 4,
    parameter int PIXEL_BITS = 1,
    parameter int DEPTH = 16,  // slots
    parameter int ADDRESS_BITS = $clog2(DEPTH * TILE_ROWS),
    parameter int SLOT_BITS = $clog2(2 * DEPTH),
    parameter int SIDE_BITS = 16
) (
    input  logic                            clk,
    input  logic                            rst,
    input  logic [SLOT_BITS-1:0]            period,
    input  logic [SLOT_BITS-1:0]            offset,  // slot of the program in slot 0
    input  logic [SIDE_BITS-1:0]            rows,
    input  logic [SIDE_BITS-1:0]            cols,
    output logic [ADDRESS_BITS-1:0]         image_address,
    input  logic [TILE_COLS*PIXEL_BITS-1:0] image_word,
    output logic                            is_ready,

    input  logic [SLOT_BITS-1:0]            next_slot,
    output logic [ROWS-1:0]                 next_rows,  // with due pixels, or of their groups
    output logic                            next_is_open,   // a pixel of the tile is open in it
    output logic                            after_is_open,  // ... in the slot after it
    input  logic [SLOT_BITS-1:0]            scan_slot,
    output logic [ROWS-1:0]                 scan_rows,
    output logic [SIDE_BITS-1:0]            scan_least,
    input  logic [SIDE_BITS-1:0]            scan_row,   // of scan_slot
    output logic [COLS-1:0]                 row_due,
    output logic [COLS-1:0]                 row_columns  // transferred
);
    localparam int TILE_BITS = TILE_ROWS > 1 ? $clog2(TILE_ROWS) : 1;
    localparam int WORD_BITS = SLOT_BITS + TILE_BITS;  // slot and tile row: no product of them
    localparam int MOD_BITS = $clog2(ROWS > TILE_ROWS ? ROWS : TILE_ROWS);
    localparam int COUNT_BITS = $clog2(COLS / CHANNELS + 2);
    localparam int ROW_BITS = ROWS > 1 ? $clog2(ROWS) : 1;
    localparam logic [1:0] WARM_UP = 0, FILL = 1, COUNT = 2, READY = 3;

    logic [TILE_COLS-1:0] due_words [0:2**WORD_BITS-1];
    logic [TILE_ROWS-1:0] row_words [0:2*DEPTH-1];
    logic [COUNT_BITS-1:0] least_words [0:2*DEPTH-1];
    logic [2*DEPTH-1:0] open_slots;  // of the period

    logic [1:0] step;
    logic [SLOT_BITS-1:0] slot, image_slot;
    logic [SIDE_BITS-1:0] row;
    logic [COUNT_BITS-1:0] least;
    logic [TILE_ROWS-1:0] row_word, row_word_now;  // rows of the slot that is filled
    logic [2*TILE_COLS-1:0] under_way [0:TILE_ROWS-1];  // by store: began before slot 0

    assign is_ready = step == READY;

    function automatic logic [WORD_BITS-1:0] word_at(input logic [SLOT_BITS-1:0] of_slot,
                                                     input logic [MOD_BITS:0] of_row);
        word_at = {of_slot, TILE_BITS'(of_row % (MOD_BITS + 1)'(TILE_ROWS))};
    endfunction

    function automatic logic [SLOT_BITS-1:0] in_period(input logic [SLOT_BITS-1:0] of_slot);
        in_period = of_slot >= period ? of_slot - period : of_slot;
    endfunction
    logic [SLOT_BITS-1:0] next_in_period;
    assign next_in_period = in_period(next_slot);
    assign next_is_open   = open_slots[next_in_period];
    assign after_is_open  = open_slots[in_period(next_in_period + 1'b1)];

    // Steps 1 and 2.
    logic [TILE_COLS-1:0] is_read, is_open, in_second, is_used, due;
    logic [2*TILE_COLS-1:0] early, early_next;
    assign image_slot = in_period(in_period(slot) + offset);
    assign image_address = ADDRESS_BITS'(image_slot) * ADDRESS_BITS'(TILE_ROWS) +
                           ADDRESS_BITS'(row);
    assign early = step == WARM_UP && slot == '0 ? '0 : under_way[TILE_BITS'(row)];
    for (genvar c = 0; c < TILE_COLS; c = c + 1) begin : g_pixel
        logic is_early;
        assign is_read[c] = image_word[c*PIXEL_BITS];
        if (PIXEL_BITS > 1) assign is_open[c] = image_word[c*PIXEL_BITS+1];
        else assign is_open[c] = 1'b1;
        if (PIXEL_BITS > 2) assign in_second[c] = image_word[c*PIXEL_BITS+2];
        else assign in_second[c] = 1'b0;
        assign is_used[c] = cols > SIDE_BITS'(c);
        assign is_early = in_second[c] ? early[TILE_COLS+c] : early[c];
        assign due[c] = is_read[c] && is_used[c] && (slot >= period || !is_early);
        // Reading empties the store; in the first pass an open one is under way.
        assign early_next[c] = in_second[c] ? early[c]
            : !is_read[c] && (early[c] || (step == WARM_UP && is_open[c]));
        assign early_next[TILE_COLS+c] = !in_second[c] ? early[TILE_COLS+c]
            : !is_read[c] && (early[TILE_COLS+c] || (step == WARM_UP && is_open[c]));
    end

    // The rows that are read, and the columns of one of them: live, or of step 3.
    logic [SLOT_BITS-1:0] at_slot;
    logic [SIDE_BITS-1:0] at_row, first_row;
    assign at_slot   = is_ready ? scan_slot : slot;
    assign at_row    = is_ready ? scan_row : row;
    assign first_row = at_row - at_row % SIDE_BITS'(GROUP_ROWS);

    function automatic logic [ROWS-1:0] rows_of(input logic [TILE_ROWS-1:0] tile,
                                                input logic [SIDE_BITS-1:0] window_rows);
        rows_of = '0;
        for (int r = 0; r < ROWS; r = r + 1)
            for (int i = 0; i < GROUP_ROWS; i = i + 1)
                if (SIDE_BITS'(r) < window_rows &&
                    SIDE_BITS'(r - r % GROUP_ROWS + i) < window_rows &&
                    tile[(r-r%GROUP_ROWS+i)%TILE_ROWS])
                    rows_of[r] = 1'b1;
    endfunction
    assign next_rows    = rows_of(row_words[next_slot], rows);
    assign scan_rows    = rows_of(row_words[at_slot], rows);
    assign scan_least   = SIDE_BITS'(least_words[at_slot]);

    logic [TILE_COLS-1:0] word_of_row;
    logic [GROUP_ROWS*TILE_COLS-1:0] group_words;
    if (GROUP_ROWS > 1) assign word_of_row = due_words[word_at(at_slot, (MOD_BITS + 1)'(at_row))];
    else assign word_of_row = group_words;
    for (genvar i = 0; i < GROUP_ROWS; i = i + 1) begin : g_group_row
        logic [SIDE_BITS-1:0] r;
        assign r = first_row + SIDE_BITS'(i);
        assign group_words[i*TILE_COLS+:TILE_COLS] = r < rows
            ? due_words[word_at(at_slot, (MOD_BITS + 1)'(r))] : '0;
    end

    logic [TILE_COLS-1:0] due_in_group_rows;
    always_comb begin
        due_in_group_rows = '0;
        for (int i = 0; i < GROUP_ROWS; i = i + 1)
            due_in_group_rows = due_in_group_rows | group_words[i*TILE_COLS+:TILE_COLS];
    end
    function automatic logic [COLS-1:0] columns_of(input logic [TILE_COLS-1:0] tile,
                                                   input logic [SIDE_BITS-1:0] window_cols);
        columns_of = '0;
        for (int c = 0; c < COLS; c = c + 1)
            for (int i = 0; i < GROUP_COLS; i = i + 1)
                if (SIDE_BITS'(c) < window_cols &&
                    SIDE_BITS'(c - c % GROUP_COLS + i) < window_cols &&
                    tile[(c-c%GROUP_COLS+i)%TILE_COLS])
                    columns_of[c] = 1'b1;
    endfunction
    assign row_columns = columns_of(due_in_group_rows, cols);
    for (genvar c = 0; c < COLS; c = c + 1) begin : g_column
        assign row_due[c] = SIDE_BITS'(c) < cols && word_of_row[c%TILE_COLS];
    end

    // Columns of the busiest channel.
    logic [COUNT_BITS-1:0] busiest, of_channel;
    always_comb begin
        busiest = '0;
        for (int channel = 0; channel < CHANNELS; channel = channel + 1) begin
            of_channel = '0;
            for (int c = 0; c < COLS; c = c + 1)
                if (c % CHANNELS == channel) of_channel = of_channel + COUNT_BITS'(row_columns[c]);
            if (of_channel > busiest) busiest = of_channel;
        end
    end

    logic is_last_row, is_last_slot;
    logic [COUNT_BITS-1:0] least_now;
    assign is_last_row  = row + 1'b1 == (step == COUNT ? rows : SIDE_BITS'(TILE_ROWS));
    assign is_last_slot = slot + 1'b1 == (step == WARM_UP ? period : period << 1);
    assign least_now    = scan_rows[ROW_BITS'(row)] && busiest < least ? busiest : least;

    always_ff @(posedge clk)
        if (rst) begin
            step <= WARM_UP;
            slot <= '0;
            row <= '0;
        end else if (step != READY) begin
            row <= is_last_row ? '0 : row + 1'b1;
            if (is_last_row) slot <= is_last_slot ? '0 : slot + 1'b1;
            if (is_last_row && is_last_slot) step <= step + 1'b1;
        end

    always_comb begin
        row_word_now = row == '0 ? '0 : row_word;
        row_word_now[TILE_BITS'(row)] = due != '0;
    end

    always_ff @(posedge clk) begin
        if (step == WARM_UP || step == FILL) under_way[TILE_BITS'(row)] <= early_next;
        if (step == FILL) begin
            due_words[word_at(slot, (MOD_BITS + 1)'(row))] <= due;
            row_word <= row_word_now;
            if (is_last_row) row_words[slot] <= row_word_now;
        end
        if (step == WARM_UP) open_slots[slot] <= is_open != '0 || (row != '0 && open_slots[slot]);
        if (step == COUNT && is_last_row) least_words[slot] <= least_now;
        least <= step != COUNT || is_last_row ? '1 : least_now;
    end
endmodule
