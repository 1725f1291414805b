// The chip with the sizes of chip.vh. Its registers are set as registers.txt says; schedule.mem presets
// bank 0 of the schedule memory.
`include "chip.vh"

module chip (
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

    output logic                        slot_start,
    output logic                        scan_start,
    output logic                        select,
    output logic [`CHIP_PLACE_BITS-1:0] select_row,  // dark rows first, row r is DARK_ROWS + r
    output logic                        convert,
    output logic [`CHIP_PLACE_BITS-1:0] convert_row,
    output logic                        convert_end,
    output logic [`CHIP_PLACE_BITS-1:0] adc_row,
    input  logic [`CHIP_COLS*`CHIP_BIT_DEPTH-1:0] adc_dn,  // in the clock of convert_end
    output logic                        transfer,
    output logic [`CHIP_PLACE_BITS-1:0] transfer_row,
    output logic [`CHIP_CHANNELS-1:0]   channel_valid,  // a column begins to leave
    output logic [`CHIP_CHANNELS*`CHIP_BIT_DEPTH-1:0] channel_dn,
    output logic                        transfer_end,
    output logic [3:0]                  row_done,
    output logic [4*`CHIP_PLACE_BITS-1:0] row_done_row,

    output logic                          m_axis_tvalid,
    input  logic                          m_axis_tready,
    output logic [8*`CHIP_WORD_BYTES-1:0] m_axis_tdata,
    output logic [`CHIP_WORD_BYTES-1:0]   m_axis_tkeep,
    output logic                          m_axis_tlast
);
    stipple_chip #(
        .ROWS(`CHIP_ROWS), .COLS(`CHIP_COLS), .CHANNELS(`CHIP_CHANNELS),
        .COLUMNS_PER_ADC(`CHIP_COLUMNS_PER_ADC), .GROUP_ROWS(`CHIP_GROUP_ROWS),
        .GROUP_COLS(`CHIP_GROUP_COLS), .TILE_ROWS(`CHIP_TILE_ROWS), .TILE_COLS(`CHIP_TILE_COLS),
        .PIXEL_BITS(`CHIP_PIXEL_BITS), .DEPTH(`CHIP_DEPTH), .BIT_DEPTH(`CHIP_BIT_DEPTH),
        .DARK_ROWS(`CHIP_DARK_ROWS), .WORD_BYTES(`CHIP_WORD_BYTES), .WORDS(`CHIP_WORDS),
        .IMAGE("schedule.mem")
    ) u_chip (
        .clk, .rst, .s_axil_awaddr, .s_axil_awvalid, .s_axil_awready, .s_axil_wdata, .s_axil_wstrb,
        .s_axil_wvalid, .s_axil_wready, .s_axil_bresp, .s_axil_bvalid, .s_axil_bready,
        .s_axil_araddr, .s_axil_arvalid, .s_axil_arready, .s_axil_rdata, .s_axil_rresp,
        .s_axil_rvalid, .s_axil_rready, .stream_crc, .slot_start, .scan_start, .select, .select_row,
        .convert, .convert_row, .convert_end, .adc_row, .adc_dn, .transfer, .transfer_row,
        .channel_valid, .channel_dn, .transfer_end, .row_done, .row_done_row, .m_axis_tvalid,
        .m_axis_tready, .m_axis_tdata, .m_axis_tkeep, .m_axis_tlast
    );
endmodule
