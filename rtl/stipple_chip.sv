// The chip: its registers, the control of captures, and the core.
//
//     AXI4-Lite -> chip_registers -> chip_control -> chip_core -> AXI-Stream
//
// Sizes are parameters (docs/rtl.md), all else is set through registers (docs/chip_registers.md).
module stipple_chip #(
    parameter int ROWS = 16,
    parameter int COLS = 16,
    parameter int CHANNELS = 4,         // divides COLS
    parameter int COLUMNS_PER_ADC = 1,  // divides COLS
    parameter int GROUP_ROWS = 1,       // 1 x 1: each channel skips columns that are not due
    parameter int GROUP_COLS = 1,
    parameter int TILE_ROWS = 16,
    parameter int TILE_COLS = 16,
    parameter int PIXEL_BITS = 1,  // of the schedule memory
    parameter int DEPTH = 16,      // slots of a bank of it
    parameter int BIT_DEPTH = 10,
    parameter int DARK_ROWS = 2,   // max, at least 1
    parameter int WORD_BYTES = 8,  // of the stream; 8 WORD_BYTES >= CHANNELS x BIT_DEPTH
    parameter int WORDS = 1024,    // of packets that wait
    parameter int PACKETS = 16,
    parameter IMAGE = "",          // that presets bank 0
    // Of ports:
    parameter int TIMERS = 4,
    parameter int PLACE_BITS = $clog2(ROWS + DARK_ROWS + 1)
) (
    input  logic        clk,
    input  logic        rst,

    input  logic [11:0] s_axil_awaddr,
    input  logic        s_axil_awvalid,
    output logic        s_axil_awready,
    input  logic [31:0] s_axil_wdata,
    input  logic [3:0]  s_axil_wstrb,
    input  logic        s_axil_wvalid,
    output logic        s_axil_wready,
    output logic [1:0]  s_axil_bresp,
    output logic        s_axil_bvalid,
    input  logic        s_axil_bready,
    input  logic [11:0] s_axil_araddr,
    input  logic        s_axil_arvalid,
    output logic        s_axil_arready,
    output logic [31:0] s_axil_rdata,
    output logic [1:0]  s_axil_rresp,
    output logic        s_axil_rvalid,
    input  logic        s_axil_rready,

    input  logic [31:0] stream_crc,  // header CRC of the file

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

    output logic                    m_axis_tvalid,
    input  logic                    m_axis_tready,
    output logic [8*WORD_BYTES-1:0] m_axis_tdata,
    output logic [WORD_BYTES-1:0]   m_axis_tkeep,
    output logic                    m_axis_tlast
);
    localparam int SLOT_BITS = $clog2(2 * DEPTH);
    localparam int SETTLES = 16;
    localparam int TABLE = 16;

    logic [31:0] write_data, slots, slot_count, overrun_count, dropped_count, packet_count;
    logic [31:0] sample_count, swap_slot, slot_clocks, budget_clocks, rot_clocks, skip_row_clocks;
    logic [31:0] settle_margin, adc_clocks, blanking_clocks, clocks_per_column, io_clocks;
    logic [31:0] overhead_clocks, full_row_clocks, link_bits_low, link_bits_high, link_rate_low;
    logic [31:0] link_rate_high, bank_period, bank_offset;
    logic [32*SETTLES-1:0] settle_clocks;
    logic [32*TABLE-1:0] table_cols, table_clocks;
    logic [15:0] rows, cols, dark_rows, overhead_rows;
    logic [1:0] row_timing, locked_banks;
    logic drops, exposes_while_reading, adc_skip, has_table;
    logic control_write, memory_address_write, memory_data_write, access_error;

    logic is_running, is_exposing, active_bank, swap_pending, core_rst, stops, refused;
    logic is_swapping, is_over, is_idle, memory_bank, is_beyond_memory, refuses_memory;
    logic can_run, packet_valid;
    logic [1:0] can_use, packet_flags;
    logic [4:0] fault;
    logic [31:0] packet_samples;
    logic [2*SLOT_BITS-1:0] periods, offsets;

    // Limits.
    for (genvar b = 0; b < 2; b = b + 1) begin : g_bank
        assign can_use[b] = bank_period[16*b+:16] != '0 &&
                            bank_period[16*b+:16] <= 16'(DEPTH) &&
                            bank_offset[16*b+:16] < bank_period[16*b+:16];
        assign locked_banks[b] = is_running && (active_bank == 1'(b) || swap_pending);
        assign periods[b*SLOT_BITS+:SLOT_BITS] = SLOT_BITS'(bank_period[16*b+:16]);
        assign offsets[b*SLOT_BITS+:SLOT_BITS] = SLOT_BITS'(bank_offset[16*b+:16]);
    end
    assign can_run = rows != '0 && rows <= 16'(ROWS) && cols != '0 && cols <= 16'(COLS) &&
                     slot_clocks != '0 && clocks_per_column != '0 && row_timing != 2'd3 &&
                     dark_rows <= 16'(DARK_ROWS);
    assign refuses_memory = memory_data_write && (is_beyond_memory || locked_banks[memory_bank]);

    chip_registers u_registers (
        .clk, .rst, .s_axil_awaddr, .s_axil_awvalid, .s_axil_awready, .s_axil_wdata, .s_axil_wstrb,
        .s_axil_wvalid, .s_axil_wready, .s_axil_bresp, .s_axil_bvalid, .s_axil_bready,
        .s_axil_araddr, .s_axil_arvalid, .s_axil_arready, .s_axil_rdata, .s_axil_rresp,
        .s_axil_rvalid, .s_axil_rready,
        .is_running,
        .locked_banks,
        .write_refused(refuses_memory),
        .access_error,
        .write_data,
        .id(32'h5350_4C31),
        .array_rows(16'(ROWS)),
        .array_cols(16'(COLS)),
        .tile_rows(16'(TILE_ROWS)),
        .tile_cols(16'(TILE_COLS)),
        .depth(16'(DEPTH)),
        .pixel_bits(2'(PIXEL_BITS)),
        .channels(16'(CHANNELS)),
        .bit_depth(5'(BIT_DEPTH)),
        .dark_rows_max(16'(DARK_ROWS)),
        .control_write,
        .status({active_bank, swap_pending, is_exposing, is_running}),
        .error_set({access_error, refused, core_rst ? '0 : fault}),
        .slots, .slot_count, .overrun_count, .dropped_count, .packet_count, .sample_count,
        .swap_slot, .bank_period, .bank_offset, .memory_address_write, .memory_data_write,
        .rows, .cols, .drops, .slot_clocks, .budget_clocks, .row_timing, .exposes_while_reading,
        .rot_clocks, .skip_row_clocks, .settle_margin, .adc_clocks, .adc_skip, .blanking_clocks,
        .clocks_per_column, .io_clocks, .has_table, .dark_rows, .overhead_clocks, .overhead_rows,
        .full_row_clocks, .link_bits_low, .link_bits_high, .link_rate_low, .link_rate_high,
        .settle_clocks, .table_cols, .table_clocks
    );
    chip_control u_control (
        .clk, .rst,
        .control_write,
        .control(write_data[2:0]),
        .slots,
        .can_run,
        .can_use,
        .drops,
        .refused,
        .is_running,
        .is_exposing,
        .active_bank,
        .swap_pending,
        .core_rst,
        .stops,
        .slot_start,
        .is_swapping,
        .is_over,
        .is_idle,
        .packet_valid,
        .packet_flags,
        .packet_samples,
        .slot_count,
        .overrun_count,
        .dropped_count,
        .packet_count,
        .sample_count,
        .swap_slot
    );
    chip_core #(
        .ROWS(ROWS), .COLS(COLS), .CHANNELS(CHANNELS), .COLUMNS_PER_ADC(COLUMNS_PER_ADC),
        .GROUP_ROWS(GROUP_ROWS), .GROUP_COLS(GROUP_COLS), .TILE_ROWS(TILE_ROWS),
        .TILE_COLS(TILE_COLS), .PIXEL_BITS(PIXEL_BITS), .DEPTH(DEPTH), .BIT_DEPTH(BIT_DEPTH),
        .DARK_ROWS(DARK_ROWS), .WORD_BYTES(WORD_BYTES), .WORDS(WORDS), .PACKETS(PACKETS),
        .SETTLES(SETTLES), .TABLE(TABLE), .IMAGE(IMAGE), .TIMERS(TIMERS)
    ) u_core (
        .clk,
        .rst(core_rst),
        .set_memory_at(memory_address_write),
        .write_memory(memory_data_write && !refuses_memory),
        .write_data,
        .memory_bank,
        .is_beyond_memory,
        .periods,
        .offsets,
        .active(active_bank),
        .swap(swap_pending && is_exposing),
        .is_swapping,
        .stops,
        .is_over,
        .is_idle,
        .rows, .cols,
        .is_sequential(row_timing == 2'd1),
        .is_full_width(row_timing == 2'd2),
        .exposes_while_reading, .drops, .slot_clocks, .budget_clocks, .rot_clocks,
        .skip_row_clocks, .settle_clocks, .settle_margin, .adc_clocks, .adc_skip, .blanking_clocks,
        .clocks_per_column, .io_clocks,
        .link_bits({link_bits_high, link_bits_low}),
        .link_rate({link_rate_high, link_rate_low}),
        .has_table, .table_cols, .table_clocks,
        .dark_rows(PLACE_BITS'(dark_rows)),
        .overhead_clocks, .overhead_rows, .full_row_clocks, .stream_crc,
        .slot_start, .scan_start, .select, .select_row, .convert, .convert_row, .convert_end,
        .adc_row, .adc_dn, .transfer, .transfer_row, .channel_valid, .channel_dn, .transfer_end,
        .row_done, .row_done_row, .fault, .packet_valid, .packet_flags, .packet_samples,
        .m_axis_tvalid, .m_axis_tready, .m_axis_tdata, .m_axis_tkeep, .m_axis_tlast
    );
endmodule
