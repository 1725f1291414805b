// The chip in gates with fixed times, late rows that stretch their slot and no registers: what coded
// exposure costs beside conventional.sv.
module coded #(
    parameter int ROWS = 16,
    parameter int COLS = 16,
    parameter int CHANNELS = 2,
    parameter int BIT_DEPTH = 10,
    parameter int TILE = 16,   // rows and columns
    parameter int DEPTH = 16,  // slots of a bank; the period is one less
    parameter int WORDS = 64,  // of packets that wait
    parameter int WORD_BYTES = 4
) (
    input  logic                        clk,
    input  logic                        rst,
    input  logic [31:0]                 write_data,
    input  logic                        set_memory_at,
    input  logic                        write_memory,
    input  logic                        swap,
    input  logic                        active,
    input  logic [COLS*BIT_DEPTH-1:0]   adc_dn,
    output logic                        select,
    output logic [$clog2(ROWS+2)-1:0]   select_row,
    output logic                        convert,
    output logic                        convert_end,
    output logic                        is_swapping,
    output logic                        m_axis_tvalid,
    output logic [8*WORD_BYTES-1:0]     m_axis_tdata,
    output logic [WORD_BYTES-1:0]       m_axis_tkeep,
    output logic                        m_axis_tlast
);
    localparam int SLOT_BITS = $clog2(2 * DEPTH);
    chip_core #(
        .ROWS(ROWS), .COLS(COLS), .CHANNELS(CHANNELS), .BIT_DEPTH(BIT_DEPTH), .DARK_ROWS(1),
        .TILE_ROWS(TILE), .TILE_COLS(TILE), .DEPTH(DEPTH),
        .WORD_BYTES(WORD_BYTES), .WORDS(WORDS), .PACKETS(4), .SETTLES(1), .TABLE(1)
    ) u_core (
        .clk, .rst, .set_memory_at, .write_memory, .write_data,
        .memory_bank(), .is_beyond_memory(),
        .periods({2{SLOT_BITS'(DEPTH - 1)}}),
        .offsets('0),
        .active, .swap, .is_swapping,
        .stops(1'b0), .is_over(), .is_idle(),
        .rows(16'(ROWS)), .cols(16'(COLS)),
        .is_sequential(1'b0), .is_full_width(1'b0), .exposes_while_reading(1'b1), .drops(1'b0),
        .slot_clocks(32'd4000), .budget_clocks(32'd4000), .rot_clocks(32'd6),
        .skip_row_clocks('0), .settle_clocks('0), .settle_margin('0), .adc_clocks(32'd20),
        .adc_skip(1'b0), .blanking_clocks('0), .clocks_per_column(32'd1), .io_clocks(32'd2),
        .link_bits('0), .link_rate('0), .has_table(1'b0), .table_cols('0), .table_clocks('0),
        .dark_rows('0), .overhead_clocks('0), .overhead_rows('0), .full_row_clocks('0),
        .stream_crc(32'h12345678),
        .slot_start(), .scan_start(), .select, .select_row, .convert, .convert_row(), .convert_end,
        .adc_row(), .adc_dn, .transfer(), .transfer_row(), .channel_valid(), .channel_dn(),
        .transfer_end(), .row_done(), .row_done_row(), .fault(), .packet_valid(), .packet_flags(),
        .packet_samples(),
        .m_axis_tvalid, .m_axis_tready(1'b1), .m_axis_tdata, .m_axis_tkeep, .m_axis_tlast
    );
endmodule
