// Sequencer, column readout and packets of an image sensor with coded exposure.
//
//     schedule_banks -> scan_scheduler -> row_scanner -> row_convert -> ADCs
//                              ^                              |
//                         row_timer <----- row_transfer <-----+
//                                               |
//            AXI-Stream <- packet_sender <- sample_packer
//
// A capture begins after reset: the due tables of the `active` bank are filled, then slot 0 begins. It
// ends (`is_idle`) when the chip `stops` and all packets are sent. Times are inputs that stay the same
// (docs/chip_registers.md). The ADCs present the DN of row adc_row in the clock of convert_end, those
// of column c in bits c x BIT_DEPTH up. The chip does not wait for its stream: `fault` tells that a
// queue is full, or that the times cannot be run.
module chip_core #(
    parameter int ROWS = 16,
    parameter int COLS = 16,
    parameter int CHANNELS = 4,         // divides COLS
    parameter int COLUMNS_PER_ADC = 1,  // divides COLS
    parameter int GROUP_ROWS = 1,       // 1 x 1: each channel skips columns that are not due
    parameter int GROUP_COLS = 1,
    parameter int TILE_ROWS = 16,
    parameter int TILE_COLS = 16,
    parameter int PIXEL_BITS = 1,  // of the schedule memory
    parameter int DEPTH = 16,      // slots of the schedule memory
    parameter int BIT_DEPTH = 10,
    parameter int DARK_ROWS = 2,   // max, at least 1
    parameter int WORD_BYTES = 8,  // of the stream; 8 WORD_BYTES >= CHANNELS x BIT_DEPTH
    parameter int WORDS = 1024,    // of packets that wait
    parameter int PACKETS = 16,
    parameter int SETTLES = 16,    // settling times
    parameter int TABLE = 16,      // row times of a table
    parameter IMAGE = "",
    // Of ports:
    parameter int SLOT_BITS = $clog2(2 * DEPTH),
    parameter int TIMERS = 4,
    parameter int PLACE_BITS = $clog2(ROWS + DARK_ROWS + 1)
) (
    input  logic clk,
    input  logic rst,

    input  logic         set_memory_at,
    input  logic         write_memory,
    input  logic [31:0]  write_data,
    output logic         memory_bank,       // that is written
    output logic         is_beyond_memory,
    input  logic [2*SLOT_BITS-1:0] periods,
    input  logic [2*SLOT_BITS-1:0] offsets,
    input  logic         active,  // bank
    input  logic         swap,    // the other bank is wanted
    output logic         is_swapping,
    input  logic         stops,
    output logic         is_over,
    output logic         is_idle,

    input  logic [15:0]  rows,    // of the region
    input  logic [15:0]  cols,
    input  logic         is_sequential,  // law of the row time: neither of the two: overlapped
    input  logic         is_full_width,
    input  logic         exposes_while_reading,
    input  logic         drops,          // late rows; else slots are stretched
    input  logic [31:0]  slot_clocks,    // of a slot, at least 1
    input  logic [31:0]  budget_clocks,  // a longer slot is an overrun; 0: none is
    input  logic [31:0]  rot_clocks,
    input  logic [31:0]  skip_row_clocks,
    input  logic [32*SETTLES-1:0] settle_clocks,  // rising; unused ones equal the last
    input  logic [31:0]  settle_margin,  // two's complement
    input  logic [31:0]  adc_clocks,
    input  logic         adc_skip,
    input  logic [31:0]  blanking_clocks,
    input  logic [31:0]  clocks_per_column,  // at least 1
    input  logic [31:0]  io_clocks,
    input  logic [63:0]  link_bits,  // of a column of all channels, in units of ...
    input  logic [63:0]  link_rate,  // ... the bits that the link sends in a clock
    input  logic         has_table,
    input  logic [32*TABLE-1:0] table_cols,  // rising; unused ones equal the last
    input  logic [32*TABLE-1:0] table_clocks,
    input  logic [PLACE_BITS-1:0] dark_rows,
    input  logic [31:0]  overhead_clocks,
    input  logic [15:0]  overhead_rows,
    input  logic [31:0]  full_row_clocks,  // of an overhead row
    input  logic [31:0]  stream_crc,       // header CRC of the file

    output logic                         slot_start,
    output logic                         scan_start,
    output logic                         select,
    output logic [PLACE_BITS-1:0]        select_row,  // dark rows first, row r is DARK_ROWS + r
    output logic                         convert,
    output logic [PLACE_BITS-1:0]        convert_row,
    output logic                         convert_end,
    output logic [PLACE_BITS-1:0]        adc_row,
    input  logic [COLS*BIT_DEPTH-1:0]    adc_dn,
    output logic                         transfer,
    output logic [PLACE_BITS-1:0]        transfer_row,
    output logic [CHANNELS-1:0]          channel_valid,  // a column begins to leave
    output logic [CHANNELS*BIT_DEPTH-1:0] channel_dn,
    output logic                         transfer_end,
    output logic [TIMERS-1:0]            row_done,
    output logic [TIMERS*PLACE_BITS-1:0] row_done_row,
    output logic [4:0]                   fault,
    output logic                         packet_valid,  // is packed
    output logic [1:0]                   packet_flags,  // dropped, overrun
    output logic [31:0]                  packet_samples,

    output logic                    m_axis_tvalid,
    input  logic                    m_axis_tready,
    output logic [8*WORD_BYTES-1:0] m_axis_tdata,
    output logic [WORD_BYTES-1:0]   m_axis_tkeep,
    output logic                    m_axis_tlast
);
    localparam int DN_BITS = COLS * BIT_DEPTH;
    // Rows that wait while a row of full channels is packed, a clock for each of its columns.
    localparam int ROW_QUEUE = 2 ** $clog2(COLS / CHANNELS + 3);

`ifndef SYNTHESIS
    initial begin
        if (COLS % CHANNELS != 0) $fatal(1, "CHANNELS does not divide COLS");
        if (COLS % COLUMNS_PER_ADC != 0) $fatal(1, "COLUMNS_PER_ADC does not divide COLS");
        if (8 * WORD_BYTES < CHANNELS * BIT_DEPTH)
            $fatal(1, "WORD_BYTES is less than a column of all channels");
        if (32 % WORD_BYTES != 0 || WORD_BYTES < 4) $fatal(1, "WORD_BYTES is none of 4, 8, 16, 32");
        if (DARK_ROWS < 1) $fatal(1, "DARK_ROWS is 0");
        if (PIXEL_BITS < 1 || PIXEL_BITS > 3) $fatal(1, "PIXEL_BITS is not 1..3");
    end
`endif

    // Which rows and columns are due.
    logic is_filled, is_ready, takes;
    logic [SLOT_BITS-1:0] next_slot, scan_slot, period, other_period;
    logic [ROWS-1:0] next_rows, scan_rows, kept_rows;
    logic [15:0] scan_least;
    logic [COLS-1:0] row_due, row_columns, window_columns;
    logic [PLACE_BITS-1:0] skipped;
    logic slot_waits, is_dark, next_is_open, after_is_open;

    schedule_banks #(
        .ROWS(ROWS), .COLS(COLS), .CHANNELS(CHANNELS), .GROUP_ROWS(GROUP_ROWS),
        .GROUP_COLS(GROUP_COLS), .TILE_ROWS(TILE_ROWS), .TILE_COLS(TILE_COLS),
        .PIXEL_BITS(PIXEL_BITS), .DEPTH(DEPTH), .IMAGE(IMAGE)
    ) u_banks (
        .clk, .rst,
        .set_at(set_memory_at),
        .write(write_memory),
        .write_data,
        .write_bank(memory_bank),
        .is_beyond(is_beyond_memory),
        .periods,
        .offsets,
        .rows,
        .cols,
        .active,
        .swap,
        .slot_start,
        .is_filled,
        .takes,
        .is_swapping,
        .period,
        .other_period,
        .next_slot,
        .next_rows,
        .next_is_open,
        .after_is_open,
        .scan_slot,
        .scan_rows,
        .scan_least,
        .scan_row(16'(select_row) - 16'(DARK_ROWS)),
        .row_due,
        .row_columns
    );

    // Slots and their scans.
    logic is_reading;
    logic [15:0] ended_first_row, undecided, scan_number, sent_number, sent_end_row;
    logic slot_end, ended_has_rows, ended_overrun, slots_overflow;
    logic [ROWS-1:0] rows_done;
    logic scan_over;

    scan_scheduler #(.ROWS(ROWS), .DEPTH(DEPTH)) u_scheduler (
        .clk, .rst, .is_filled, .is_ready, .stops, .takes, .is_swapping, .period, .other_period,
        .exposes_while_reading, .drops, .slot_clocks,
        .budget_clocks, .rows, .next_slot, .next_rows, .next_is_open, .after_is_open, .scan_slot,
        .scan_rows, .kept_rows, .slot_waits, .scan_start, .is_reading, .rows_done, .scan_over,
        .slot_start, .slot_end, .ended_has_rows, .ended_overrun, .is_over, .ended_first_row, .undecided,
        .scan_number, .sent_number, .sent_end_row,
        .overflow(slots_overflow)
    );

    // The scan, and the settling time of its rows: the longest one that is not above the columns of
    // its emptiest row.
    logic [31:0] settle, held_settle, settle_columns;
    logic [47:0] first_transfer, overhead_row_clocks;
    logic may_select, may_transfer, is_last;

    assign settle_columns = 32'(scan_least) + settle_margin;
    always_comb begin
        settle = scan_start ? settle_clocks[31:0] : held_settle;
        for (int i = 1; i < SETTLES; i = i + 1)
            if (scan_start && $signed(settle_clocks[i*32+:32]) <= $signed(settle_columns))
                settle = settle_clocks[i*32+:32];
    end
    assign overhead_row_clocks = 48'(overhead_rows) * 48'(full_row_clocks);
    assign first_transfer = 48'(overhead_clocks) + overhead_row_clocks;

    row_scanner #(
        .ROWS(ROWS), .DARK_ROWS(DARK_ROWS), .WAIT_BITS(48)
    ) u_scanner (
        .clk, .rst,
        .slot_waits,
        .slot_rows(scan_rows & kept_rows),
        .dark_rows,
        .select_wait(first_transfer -
                     (overhead_rows != '0 && !is_sequential ? 48'(full_row_clocks) : '0)),
        .transfer_wait(first_transfer),
        .may_select,
        .scan_over,
        .scan_start,
        .is_reading,
        .may_transfer,
        .select,
        .place(select_row),
        .skipped,
        .is_last
    );

    // The rows of the scan.
    logic sent_valid, sent_is_last, timers_overflow;
    logic [COLS-1:0] sent_due;
    logic [DN_BITS-1:0] sent_dn;

    for (genvar c = 0; c < COLS; c = c + 1) begin : g_window
        assign window_columns[c] = cols > 16'(c);
    end
    assign is_dark = select_row < PLACE_BITS'(DARK_ROWS);

    row_readout #(
        .ROWS(ROWS), .COLS(COLS), .CHANNELS(CHANNELS), .COLUMNS_PER_ADC(COLUMNS_PER_ADC),
        .BIT_DEPTH(BIT_DEPTH), .DARK_ROWS(DARK_ROWS), .TABLE(TABLE),
        .TIMERS(TIMERS)
    ) u_readout (
        .clk, .rst, .is_sequential, .is_full_width, .rot_clocks, .skip_row_clocks,
        .settle_clocks(settle), .adc_clocks, .adc_skip, .blanking_clocks, .clocks_per_column,
        .io_clocks, .link_bits, .link_rate, .has_table, .table_cols, .table_clocks,
        .select, .select_row, .skipped, .is_last,
        .row_columns(is_dark ? window_columns : row_columns),
        .row_due(is_dark ? '0 : row_due),
        .may_transfer, .may_select,
        .convert, .convert_row, .convert_end, .adc_row, .adc_dn, .transfer,
        .transfer_row, .channel_valid, .channel_dn, .transfer_end, .row_done, .row_done_row,
        .rows_done, .scan_over,
        .sent_valid, .sent_is_last, .sent_due, .sent_dn, .timers_overflow
    );

    // Packets.
    logic packed_row_valid, packed_row_pop, packed_row_is_last, rows_overflow;
    logic [COLS-1:0] packed_row_due;
    logic [DN_BITS-1:0] packed_row_dn;
    logic [15:0] row_number, row_end, first_row;
    logic ended_valid, ended_pop, has_rows, was_overrun, ended_overflow;
    logic word_valid, sender_overflow;
    logic [15:0] switches, packet_switches;
    logic sender_idle;
    logic [15:0] packet_first_row, packet_rows;
    logic [8*WORD_BYTES-1:0] word;
    logic [52:0] packet_slot;
    logic [31:0] packet_bytes, packet_crc;

    fifo #(.WIDTH(33 + COLS + DN_BITS), .DEPTH(ROW_QUEUE)) u_row_queue (
        .clk, .rst,
        .push(sent_valid && is_ready),
        .item({sent_number, sent_end_row, sent_is_last, sent_due, sent_dn}),
        .pop(packed_row_pop),
        .valid(packed_row_valid),
        .head({row_number, row_end, packed_row_is_last, packed_row_due, packed_row_dn}),
        .overflow(rows_overflow)
    );
    fifo #(.WIDTH(34), .DEPTH(2 ** $clog2(DEPTH + 2))) u_ended_slots (
        .clk, .rst,
        .push(slot_end),
        .item({switches, ended_first_row, ended_has_rows, ended_overrun}),
        .pop(ended_pop),
        .valid(ended_valid),
        .head({packet_switches, first_row, has_rows, was_overrun}),
        .overflow(ended_overflow)
    );
    sample_packer #(
        .COLS(COLS), .BIT_DEPTH(BIT_DEPTH), .PACK(CHANNELS), .WORD_BYTES(WORD_BYTES)
    ) u_packer (
        .clk, .rst,
        .row_valid(packed_row_valid),
        .row_due(packed_row_due),
        .row_dn(packed_row_dn),
        .row_is_last(packed_row_is_last),
        .row_number,
        .row_end,
        .row_pop(packed_row_pop),
        .slot_valid(ended_valid),
        .slot_has_rows(has_rows),
        .slot_overrun(was_overrun),
        .slot_first_row(first_row),
        .undecided,
        .is_reading,
        .scan_number,
        .rows,
        .slot_pop(ended_pop),
        .word_valid,
        .word,
        .packet_valid,
        .packet_flags,
        .packet_first_row,
        .packet_rows,
        .packet_slot,
        .packet_samples,
        .packet_bytes,
        .packet_crc
    );
    packet_sender #(.WORD_BYTES(WORD_BYTES), .WORDS(WORDS), .PACKETS(PACKETS)) u_sender (
        .clk, .rst,
        .stream_crc,
        .word_valid,
        .word,
        .packet_valid,
        .packet_flags,
        .packet_switches,
        .packet_first_row,
        .packet_rows,
        .packet_slot,
        .packet_samples,
        .packet_bytes,
        .packet_crc,
        .overflow(sender_overflow),
        .is_idle(sender_idle),
        .m_axis_tvalid,
        .m_axis_tready,
        .m_axis_tdata,
        .m_axis_tkeep,
        .m_axis_tlast
    );

    logic has_no_time;  // a row takes no clock from its selection to its DN
    assign has_no_time = select && rot_clocks == '0 && settle == '0 && adc_clocks == '0;
    assign fault   = {has_no_time, slots_overflow || ended_overflow, timers_overflow, rows_overflow,
                      sender_overflow};
    assign is_idle = is_over && !ended_valid && sender_idle;

    always_ff @(posedge clk)
        if (rst) switches <= '0;
        else switches <= switches + 16'(slot_start && is_swapping);

    always_ff @(posedge clk) held_settle <= settle;
endmodule
