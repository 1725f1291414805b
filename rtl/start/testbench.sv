// Runs the chip once: writes registers.txt through its AXI4-Lite port, starts a capture, presents the
// columns of dn.mem, a line for each row that is converted, and writes its stream to packets.bin.
// +waves=FILE writes the waveforms to FILE.
`timescale 1ps / 1ps
`include "chip.vh"

module testbench;
    localparam logic [11:0] CONTROL = 12'h040, STATUS = 12'h044, ERROR = 12'h048;
    localparam int PLACE_BITS = `CHIP_PLACE_BITS;

    logic clk = 1'b0, rst = 1'b1;
    logic [11:0] s_axil_awaddr = '0, s_axil_araddr = '0;
    logic s_axil_awvalid = 1'b0, s_axil_wvalid = 1'b0, s_axil_arvalid = 1'b0;
    logic s_axil_awready, s_axil_wready, s_axil_bvalid, s_axil_arready, s_axil_rvalid;
    logic [31:0] s_axil_wdata = '0, s_axil_rdata;
    logic [1:0] s_axil_bresp, s_axil_rresp;
    logic slot_start, scan_start, select, convert, convert_end, transfer, transfer_end;
    logic [PLACE_BITS-1:0] select_row, convert_row, adc_row, transfer_row;
    logic [`CHIP_COLS*`CHIP_BIT_DEPTH-1:0] adc_dn = '0;
    logic [`CHIP_CHANNELS-1:0] channel_valid;
    logic [`CHIP_CHANNELS*`CHIP_BIT_DEPTH-1:0] channel_dn;
    logic [3:0] row_done;
    logic [4*PLACE_BITS-1:0] row_done_row;
    logic m_axis_tvalid, m_axis_tlast;
    logic [8*`CHIP_WORD_BYTES-1:0] m_axis_tdata;
    logic [`CHIP_WORD_BYTES-1:0] m_axis_tkeep;

    chip u_chip (
        .clk, .rst, .s_axil_awaddr, .s_axil_awvalid, .s_axil_awready, .s_axil_wdata,
        .s_axil_wstrb(4'hF), .s_axil_wvalid, .s_axil_wready, .s_axil_bresp, .s_axil_bvalid,
        .s_axil_bready(1'b1), .s_axil_araddr, .s_axil_arvalid, .s_axil_arready, .s_axil_rdata,
        .s_axil_rresp, .s_axil_rvalid, .s_axil_rready(1'b1), .stream_crc(`CHIP_STREAM_CRC),
        .slot_start, .scan_start, .select, .select_row, .convert, .convert_row, .convert_end,
        .adc_row, .adc_dn, .transfer, .transfer_row, .channel_valid, .channel_dn, .transfer_end,
        .row_done, .row_done_row, .m_axis_tvalid, .m_axis_tready(1'b1), .m_axis_tdata,
        .m_axis_tkeep, .m_axis_tlast
    );

    always #(`CHIP_HALF_CLOCK_PS) clk = !clk;

    // The columns: the next row is there when the last one has been taken.
    integer dn_file, packets_file, registers_file, code;
    logic [`CHIP_COLS*`CHIP_BIT_DEPTH-1:0] next_dn;
    logic has_begun = 1'b0;
    initial begin
        dn_file = $fopen("dn.mem", "r");
        if (dn_file == 0) $fatal(1, "there is no dn.mem");
        if ($fscanf(dn_file, "%h", next_dn) == 1) adc_dn = next_dn;
    end
    always @(posedge clk) begin
        if (slot_start) has_begun <= 1'b1;
        if (convert_end && has_begun && adc_row >= PLACE_BITS'(`CHIP_DARK_ROWS)) begin
            code = $fscanf(dn_file, "%h", next_dn);
            if (code == 1) adc_dn <= next_dn;
        end
    end

    // The stream.
    integer i;
    initial packets_file = $fopen("packets.bin", "wb");
    always @(posedge clk)
        if (m_axis_tvalid)
            for (i = 0; i < `CHIP_WORD_BYTES; i = i + 1)
                if (m_axis_tkeep[i]) $fwrite(packets_file, "%c", m_axis_tdata[8*i+:8]);

    // The host, whose signals change at falling edges.
    task write(input logic [11:0] address, input logic [31:0] value);
        begin
            s_axil_awaddr = address;
            s_axil_wdata = value;
            s_axil_awvalid = 1'b1;
            s_axil_wvalid = 1'b1;
            @(negedge clk);
            s_axil_awvalid = 1'b0;
            s_axil_wvalid = 1'b0;
            if (!s_axil_bvalid || s_axil_bresp != 2'b00)
                $fatal(1, "register %h does not take %h", address, value);
            @(negedge clk);
        end
    endtask
    task read(input logic [11:0] address, output logic [31:0] value);
        begin
            s_axil_araddr = address;
            s_axil_arvalid = 1'b1;
            @(negedge clk);
            s_axil_arvalid = 1'b0;
            value = s_axil_rdata;
            @(negedge clk);
        end
    endtask

    string name, waves;
    logic [11:0] address;
    logic [31:0] value;
    initial begin
        if ($value$plusargs("waves=%s", waves) != 0) begin
            $dumpfile(waves);
            $dumpvars(0, testbench);
        end
        repeat (3) @(negedge clk);
        rst = 1'b0;
        registers_file = $fopen("registers.txt", "r");
        if (registers_file == 0) $fatal(1, "there is no registers.txt");
        while ($fscanf(registers_file, "%h %h %s", address, value, name) == 3) write(address, value);
        write(CONTROL, 32'd1);
        value = 32'd1;
        while (value[0]) begin  // RUNNING
            repeat (16) @(negedge clk);
            read(STATUS, value);
        end
        read(ERROR, value);
        if (value != 0) $fatal(1, "ERROR is %h (registers in stipple_chip.h)", value);
        $fclose(packets_file);
        $finish;
    end
endmodule
