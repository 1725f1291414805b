// The readout of rows: a row that is selected is converted, transferred and done, by the law of
// its row time (docs/readout_timing.md). The samples of its due pixels come out together.
//
// `select` begins a row, its place, columns and due pixels come with it. Precondition: may_select.
// Two rows are under way at once, one in the sequential law: `latches`. The strobes convert,
// convert_end, transfer, transfer_end and row_done are the steps of a row (row_convert,
// row_transfer, row_timer). In the clock of convert_end the ADCs present the DN of row adc_row. In
// that of sent_valid, sent_due and sent_dn are those of a row that has left; dark rows do not
// count. rows_done frees the rows that are read, scan_over comes with the last one of a scan.
module row_readout #(
    parameter int ROWS = 16,
    parameter int COLS = 16,
    parameter int CHANNELS = 4,
    parameter int COLUMNS_PER_ADC = 1,
    parameter int BIT_DEPTH = 10,
    parameter int DARK_ROWS = 2,
    parameter int TABLE = 4,
    parameter int TIMERS = 4,
    parameter int PLACE_BITS = $clog2(ROWS + DARK_ROWS + 1),
    parameter int DN_BITS = COLS * BIT_DEPTH
) (
    input  logic         clk,
    input  logic         rst,
    input  logic         is_sequential,
    input  logic         is_full_width,
    input  logic [31:0]  rot_clocks,
    input  logic [31:0]  skip_row_clocks,
    input  logic [31:0]  settle_clocks,  // of the scan
    input  logic [31:0]  adc_clocks,
    input  logic         adc_skip,
    input  logic [31:0]  blanking_clocks,
    input  logic [31:0]  clocks_per_column,
    input  logic [31:0]  io_clocks,
    input  logic [63:0]  link_bits,
    input  logic [63:0]  link_rate,
    input  logic         has_table,
    input  logic [32*TABLE-1:0] table_cols,
    input  logic [32*TABLE-1:0] table_clocks,

    input  logic                  select,
    input  logic [PLACE_BITS-1:0] select_row,  // its place
    input  logic [PLACE_BITS-1:0] skipped,     // rows before it
    input  logic                  is_last,
    input  logic [COLS-1:0]       row_columns,
    input  logic [COLS-1:0]       row_due,
    input  logic                  may_transfer,
    output logic                  may_select,

    output logic                          convert,
    output logic [PLACE_BITS-1:0]         convert_row,
    output logic                          convert_end,
    output logic [PLACE_BITS-1:0]         adc_row,
    input  logic [DN_BITS-1:0]            adc_dn,
    output logic                          transfer,
    output logic [PLACE_BITS-1:0]         transfer_row,
    output logic [CHANNELS-1:0]           channel_valid,
    output logic [CHANNELS*BIT_DEPTH-1:0] channel_dn,
    output logic                          transfer_end,
    output logic [TIMERS-1:0]             row_done,
    output logic [TIMERS*PLACE_BITS-1:0]  row_done_row,
    output logic [ROWS-1:0]               rows_done,
    output logic                          scan_over,
    output logic                          sent_valid,
    output logic                          sent_is_last,
    output logic [COLS-1:0]               sent_due,
    output logic [DN_BITS-1:0]            sent_dn,
    output logic                          timers_overflow
);
    localparam int ROW_BITS = PLACE_BITS + 1 + 32 + COLS + DN_BITS;

    logic columns_are_free, converts_selected, row_ready, link_free;
    logic [1:0] latches, latches_now;  // in use

    assign latches_now = latches - 2'(link_free);
    assign may_select  = columns_are_free && latches_now < (is_sequential ? 2'd1 : 2'd2);
    always_ff @(posedge clk)
        if (rst) latches <= '0;
        else latches <= latches_now + 2'(select);

    // Columns: from the selection to the latches.
    logic [COLS-1:0] held_columns, held_due;
    logic held_is_last;
    logic [31:0] convert_clocks, held_convert_clocks, row_convert_clocks;
    logic [DN_BITS-1:0] held_dn, ready_dn;

    row_convert #(.COLS(COLS), .COLUMNS_PER_ADC(COLUMNS_PER_ADC), .CLOCK_BITS(32)) u_convert (
        .clk, .rst,
        .select,
        .select_clocks(rot_clocks + 32'(skipped) * skip_row_clocks),
        .settle_clocks,
        .columns(adc_skip ? row_columns : '1),
        .adc_clocks,
        .rest_clocks(is_sequential ? '0 : blanking_clocks),
        .is_free(columns_are_free),
        .convert,
        .converts_selected,
        .convert_end,
        .convert_clocks,
        .row_ready
    );
    assign convert_row        = converts_selected ? select_row : adc_row;
    assign ready_dn           = convert_end ? adc_dn : held_dn;
    assign row_convert_clocks = rot_clocks + (convert_end ? convert_clocks : held_convert_clocks);

    // The link, and the ends of the rows.
    logic [ROW_BITS-1:0] link_row, sent_row;
    logic [COLS-1:0] unused_columns, unused_due, begun;
    logic [DN_BITS-1:0] link_dn, unused_dn;
    logic [31:0] link_convert_clocks, unused_clocks;
    logic [PLACE_BITS-1:0] sent_place;
    logic link_is_last;
    logic [TIMERS*(PLACE_BITS+1)-1:0] done_rows;

    row_transfer #(
        .COLS(COLS), .CHANNELS(CHANNELS), .ROW_BITS(ROW_BITS), .TABLE(TABLE)
    ) u_transfer (
        .clk, .rst,
        .full_width(is_full_width),
        .clocks_per_column,
        .io_clocks,
        .blanking_clocks,
        .link_bits,
        .link_rate,
        .has_table,
        .table_cols,
        .table_clocks,
        .row_ready,
        .ready_columns(held_columns),
        .ready_row({adc_row, held_is_last, row_convert_clocks, held_due, ready_dn}),
        .may_transfer,
        .transfer,
        .columns(unused_columns),
        .row(link_row),
        .sent_row,
        .begun,
        .transfer_end,
        .link_free
    );
    assign {transfer_row, link_is_last, link_convert_clocks, unused_due, link_dn} = link_row;
    assign {sent_place, sent_is_last, unused_clocks, sent_due, unused_dn} = sent_row;

    row_timer #(.ROW_BITS(PLACE_BITS + 1), .TIMERS(TIMERS)) u_timer (
        .clk, .rst,
        .transfer,
        .row({link_is_last, transfer_row}),
        .min_clocks(is_sequential ? '0 : link_convert_clocks),
        .blanking_clocks,
        .transfer_end,
        .done(row_done),
        .done_row(done_rows),
        .overflow(timers_overflow)
    );
    always_comb begin
        rows_done = '0;
        scan_over = 1'b0;
        for (int i = 0; i < TIMERS; i = i + 1)
            if (row_done[i]) begin
                scan_over = scan_over || done_rows[i*(PLACE_BITS+1)+PLACE_BITS];
                for (int r = 0; r < ROWS; r = r + 1)
                    if (done_rows[i*(PLACE_BITS+1)+:PLACE_BITS] == PLACE_BITS'(DARK_ROWS + r))
                        rows_done[r] = 1'b1;
            end
    end
    for (genvar i = 0; i < TIMERS; i = i + 1) begin : g_done_row
        assign row_done_row[i*PLACE_BITS+:PLACE_BITS] = done_rows[i*(PLACE_BITS+1)+:PLACE_BITS];
    end

    assign sent_valid = transfer_end && sent_place >= PLACE_BITS'(DARK_ROWS);

    // The channels: each has one of its columns on its output. The samples of a row are gathered.
    for (genvar k = 0; k < CHANNELS; k = k + 1) begin : g_channel
        logic [BIT_DEPTH-1:0] dn;
        logic valid;
        always_comb begin
            dn = '0;
            valid = 1'b0;
            for (int c = k; c < COLS; c = c + CHANNELS)
                if (begun[c]) begin
                    dn = dn | link_dn[c*BIT_DEPTH+:BIT_DEPTH];
                    valid = 1'b1;
                end
        end
        assign channel_valid[k] = valid;
        assign channel_dn[k*BIT_DEPTH+:BIT_DEPTH] = dn;
    end
    for (genvar c = 0; c < COLS; c = c + 1) begin : g_sent
        always_ff @(posedge clk)
            if (begun[c])
                sent_dn[c*BIT_DEPTH+:BIT_DEPTH] <=
                    channel_dn[(c%CHANNELS)*BIT_DEPTH+:BIT_DEPTH];
    end

    always_ff @(posedge clk) begin
        if (select) begin
            adc_row <= select_row;
            held_columns <= row_columns;
            held_due <= row_due;
            held_is_last <= is_last;
        end
        if (convert_end) begin
            held_dn <= adc_dn;
            held_convert_clocks <= convert_clocks;
        end
    end

`ifdef STIPPLE_ASSERT
    localparam int PLACES = 2 ** PLACE_BITS;
    // Rows that are selected and not done; each is done once.
    logic [PLACES-1:0] under_way, done_now;
    logic is_twice;
    always_comb begin
        done_now = '0;
        is_twice = 1'b0;
        for (int i = 0; i < TIMERS; i = i + 1)
            if (row_done[i]) begin
                is_twice = is_twice || done_now[row_done_row[i*PLACE_BITS+:PLACE_BITS]];
                done_now[row_done_row[i*PLACE_BITS+:PLACE_BITS]] = 1'b1;
            end
    end
    always_ff @(posedge clk)
        if (rst) begin
            under_way <= '0;
        end else begin
            under_way <= (under_way & ~done_now) | (select ? PLACES'(1) << select_row : '0);
            assert ((done_now & ~under_way) == '0);
            assert (!is_twice);
            assert (!select || may_select);
            assert (!scan_over || (under_way & ~done_now) == '0);
        end
`endif
endmodule
