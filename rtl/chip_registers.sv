// The registers of the chip (docs/chip_registers.md) behind an AXI4-Lite port. scripts/registers writes
// this file from rtl/registers.toml.
//
// A write is taken in the clock that has its address and its data, a read in that of its address; the
// answer comes in the next clock. NAME_write tells that a register that acts is written now, to
// `write_data`; `write_refused` makes it an error. NAME_set sets flags. Registers of count n are side by
// side, the first one lowest.
module chip_registers (
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

    input  logic        is_running,
    input  logic [1:0]  locked_banks,
    input  logic        write_refused,
    output logic        access_error,
    output logic [31:0] write_data,

    input  logic [31:0]   id,
    input  logic [15:0]   array_rows,
    input  logic [15:0]   array_cols,
    input  logic [15:0]   tile_rows,
    input  logic [15:0]   tile_cols,
    input  logic [15:0]   depth,
    input  logic [1:0]    pixel_bits,
    input  logic [15:0]   channels,
    input  logic [4:0]    bit_depth,
    input  logic [15:0]   dark_rows_max,
    output logic          control_write,
    input  logic [3:0]    status,
    input  logic [6:0]    error_set,
    output logic [31:0]   slots,
    input  logic [31:0]   slot_count,
    input  logic [31:0]   overrun_count,
    input  logic [31:0]   dropped_count,
    input  logic [31:0]   packet_count,
    input  logic [31:0]   sample_count,
    input  logic [31:0]   swap_slot,
    output logic [31:0]   bank_period,
    output logic [31:0]   bank_offset,
    output logic          memory_address_write,
    output logic          memory_data_write,
    output logic [15:0]   rows,
    output logic [15:0]   cols,
    output logic          drops,
    output logic [31:0]   slot_clocks,
    output logic [31:0]   budget_clocks,
    output logic [1:0]    row_timing,
    output logic          exposes_while_reading,
    output logic [31:0]   rot_clocks,
    output logic [31:0]   skip_row_clocks,
    output logic [31:0]   settle_margin,
    output logic [31:0]   adc_clocks,
    output logic          adc_skip,
    output logic [31:0]   blanking_clocks,
    output logic [31:0]   clocks_per_column,
    output logic [31:0]   io_clocks,
    output logic          has_table,
    output logic [15:0]   dark_rows,
    output logic [31:0]   overhead_clocks,
    output logic [15:0]   overhead_rows,
    output logic [31:0]   full_row_clocks,
    output logic [31:0]   link_bits_low,
    output logic [31:0]   link_bits_high,
    output logic [31:0]   link_rate_low,
    output logic [31:0]   link_rate_high,
    output logic [511:0]  settle_clocks,
    output logic [511:0]  table_cols,
    output logic [511:0]  table_clocks
);
    localparam logic [1:0] OKAY = 2'b00, SLVERR = 2'b10;

    logic takes_write, takes_read, writes, is_bad_write, is_bad_read;
    logic [31:0] value;

    assign takes_write    = s_axil_awvalid && s_axil_wvalid && (!s_axil_bvalid || s_axil_bready);
    assign takes_read     = s_axil_arvalid && (!s_axil_rvalid || s_axil_rready);
    assign s_axil_awready = takes_write;
    assign s_axil_wready  = takes_write;
    assign s_axil_arready = takes_read;
    assign writes         = takes_write && !is_bad_write;
    assign write_data     = s_axil_wdata;
    assign access_error   = (takes_write && (is_bad_write || write_refused)) || (takes_read && is_bad_read);

    always_ff @(posedge clk)
        if (rst) begin
            s_axil_bvalid <= 1'b0;
            s_axil_rvalid <= 1'b0;
        end else begin
            s_axil_bvalid <= takes_write || (s_axil_bvalid && !s_axil_bready);
            s_axil_rvalid <= takes_read || (s_axil_rvalid && !s_axil_rready);
        end

    always_ff @(posedge clk) begin
        if (takes_write) s_axil_bresp <= is_bad_write || write_refused ? SLVERR : OKAY;
        if (takes_read) s_axil_rresp <= is_bad_read ? SLVERR : OKAY;
        if (takes_read) s_axil_rdata <= value;
    end

    // A value that is too large, a lock, or no such register.
    always_comb begin
        case (s_axil_awaddr)
            12'h040: is_bad_write = s_axil_wdata[31:3] != '0;  // CONTROL
            12'h048: is_bad_write = s_axil_wdata[31:7] != '0;  // ERROR
            12'h04C: is_bad_write = is_running;  // SLOTS
            12'h080: is_bad_write = s_axil_wdata[31:16] != '0 || locked_banks[0];  // BANK_PERIOD
            12'h084: is_bad_write = s_axil_wdata[31:16] != '0 || locked_banks[1];  // BANK_PERIOD
            12'h088: is_bad_write = s_axil_wdata[31:16] != '0 || locked_banks[0];  // BANK_OFFSET
            12'h08C: is_bad_write = s_axil_wdata[31:16] != '0 || locked_banks[1];  // BANK_OFFSET
            12'h090: is_bad_write = 1'b0;  // MEMORY_ADDRESS
            12'h094: is_bad_write = 1'b0;  // MEMORY_DATA
            12'h0A0: is_bad_write = s_axil_wdata[31:16] != '0 || is_running;  // ROWS
            12'h0A4: is_bad_write = s_axil_wdata[31:16] != '0 || is_running;  // COLS
            12'h0A8: is_bad_write = s_axil_wdata[31:1] != '0 || is_running;  // DROPS
            12'h0AC: is_bad_write = is_running;  // SLOT_CLOCKS
            12'h0B0: is_bad_write = is_running;  // BUDGET_CLOCKS
            12'h0C0: is_bad_write = s_axil_wdata[31:2] != '0 || is_running;  // ROW_TIMING
            12'h0C4: is_bad_write = s_axil_wdata[31:1] != '0 || is_running;  // EXPOSES_WHILE_READING
            12'h0C8: is_bad_write = is_running;  // ROT_CLOCKS
            12'h0CC: is_bad_write = is_running;  // SKIP_ROW_CLOCKS
            12'h0D0: is_bad_write = is_running;  // SETTLE_MARGIN
            12'h0D4: is_bad_write = is_running;  // ADC_CLOCKS
            12'h0D8: is_bad_write = s_axil_wdata[31:1] != '0 || is_running;  // ADC_SKIP
            12'h0DC: is_bad_write = is_running;  // BLANKING_CLOCKS
            12'h0E0: is_bad_write = is_running;  // CLOCKS_PER_COLUMN
            12'h0E4: is_bad_write = is_running;  // IO_CLOCKS
            12'h0E8: is_bad_write = s_axil_wdata[31:1] != '0 || is_running;  // HAS_TABLE
            12'h0EC: is_bad_write = s_axil_wdata[31:16] != '0 || is_running;  // DARK_ROWS
            12'h0F0: is_bad_write = is_running;  // OVERHEAD_CLOCKS
            12'h0F4: is_bad_write = s_axil_wdata[31:16] != '0 || is_running;  // OVERHEAD_ROWS
            12'h0F8: is_bad_write = is_running;  // FULL_ROW_CLOCKS
            12'h100: is_bad_write = is_running;  // LINK_BITS_LOW
            12'h104: is_bad_write = is_running;  // LINK_BITS_HIGH
            12'h108: is_bad_write = is_running;  // LINK_RATE_LOW
            12'h10C: is_bad_write = is_running;  // LINK_RATE_HIGH
            12'h140: is_bad_write = is_running;  // SETTLE_CLOCKS
            12'h144: is_bad_write = is_running;  // SETTLE_CLOCKS
            12'h148: is_bad_write = is_running;  // SETTLE_CLOCKS
            12'h14C: is_bad_write = is_running;  // SETTLE_CLOCKS
            12'h150: is_bad_write = is_running;  // SETTLE_CLOCKS
            12'h154: is_bad_write = is_running;  // SETTLE_CLOCKS
            12'h158: is_bad_write = is_running;  // SETTLE_CLOCKS
            12'h15C: is_bad_write = is_running;  // SETTLE_CLOCKS
            12'h160: is_bad_write = is_running;  // SETTLE_CLOCKS
            12'h164: is_bad_write = is_running;  // SETTLE_CLOCKS
            12'h168: is_bad_write = is_running;  // SETTLE_CLOCKS
            12'h16C: is_bad_write = is_running;  // SETTLE_CLOCKS
            12'h170: is_bad_write = is_running;  // SETTLE_CLOCKS
            12'h174: is_bad_write = is_running;  // SETTLE_CLOCKS
            12'h178: is_bad_write = is_running;  // SETTLE_CLOCKS
            12'h17C: is_bad_write = is_running;  // SETTLE_CLOCKS
            12'h180: is_bad_write = is_running;  // TABLE_COLS
            12'h184: is_bad_write = is_running;  // TABLE_COLS
            12'h188: is_bad_write = is_running;  // TABLE_COLS
            12'h18C: is_bad_write = is_running;  // TABLE_COLS
            12'h190: is_bad_write = is_running;  // TABLE_COLS
            12'h194: is_bad_write = is_running;  // TABLE_COLS
            12'h198: is_bad_write = is_running;  // TABLE_COLS
            12'h19C: is_bad_write = is_running;  // TABLE_COLS
            12'h1A0: is_bad_write = is_running;  // TABLE_COLS
            12'h1A4: is_bad_write = is_running;  // TABLE_COLS
            12'h1A8: is_bad_write = is_running;  // TABLE_COLS
            12'h1AC: is_bad_write = is_running;  // TABLE_COLS
            12'h1B0: is_bad_write = is_running;  // TABLE_COLS
            12'h1B4: is_bad_write = is_running;  // TABLE_COLS
            12'h1B8: is_bad_write = is_running;  // TABLE_COLS
            12'h1BC: is_bad_write = is_running;  // TABLE_COLS
            12'h1C0: is_bad_write = is_running;  // TABLE_CLOCKS
            12'h1C4: is_bad_write = is_running;  // TABLE_CLOCKS
            12'h1C8: is_bad_write = is_running;  // TABLE_CLOCKS
            12'h1CC: is_bad_write = is_running;  // TABLE_CLOCKS
            12'h1D0: is_bad_write = is_running;  // TABLE_CLOCKS
            12'h1D4: is_bad_write = is_running;  // TABLE_CLOCKS
            12'h1D8: is_bad_write = is_running;  // TABLE_CLOCKS
            12'h1DC: is_bad_write = is_running;  // TABLE_CLOCKS
            12'h1E0: is_bad_write = is_running;  // TABLE_CLOCKS
            12'h1E4: is_bad_write = is_running;  // TABLE_CLOCKS
            12'h1E8: is_bad_write = is_running;  // TABLE_CLOCKS
            12'h1EC: is_bad_write = is_running;  // TABLE_CLOCKS
            12'h1F0: is_bad_write = is_running;  // TABLE_CLOCKS
            12'h1F4: is_bad_write = is_running;  // TABLE_CLOCKS
            12'h1F8: is_bad_write = is_running;  // TABLE_CLOCKS
            12'h1FC: is_bad_write = is_running;  // TABLE_CLOCKS
            default: is_bad_write = 1'b1;
        endcase
        if (s_axil_wstrb != '1) is_bad_write = 1'b1;
    end

    assign control_write = writes && s_axil_awaddr == 12'h040;
    assign memory_address_write = writes && s_axil_awaddr == 12'h090;
    assign memory_data_write = writes && s_axil_awaddr == 12'h094;

    logic [6:0] error;

    always_ff @(posedge clk)
        if (rst) begin
            error <= 7'd0;
            slots <= 32'd0;
            bank_period[0+:16] <= 16'd0;
            bank_period[16+:16] <= 16'd0;
            bank_offset[0+:16] <= 16'd0;
            bank_offset[16+:16] <= 16'd0;
            rows <= 16'd0;
            cols <= 16'd0;
            drops <= 1'd0;
            slot_clocks <= 32'd0;
            budget_clocks <= 32'd0;
            row_timing <= 2'd0;
            exposes_while_reading <= 1'd1;
            rot_clocks <= 32'd0;
            skip_row_clocks <= 32'd0;
            settle_margin <= 32'd0;
            adc_clocks <= 32'd0;
            adc_skip <= 1'd0;
            blanking_clocks <= 32'd0;
            clocks_per_column <= 32'd1;
            io_clocks <= 32'd0;
            has_table <= 1'd0;
            dark_rows <= 16'd0;
            overhead_clocks <= 32'd0;
            overhead_rows <= 16'd0;
            full_row_clocks <= 32'd0;
            link_bits_low <= 32'd0;
            link_bits_high <= 32'd0;
            link_rate_low <= 32'd0;
            link_rate_high <= 32'd0;
            settle_clocks[0+:32] <= 32'd0;
            settle_clocks[32+:32] <= 32'd0;
            settle_clocks[64+:32] <= 32'd0;
            settle_clocks[96+:32] <= 32'd0;
            settle_clocks[128+:32] <= 32'd0;
            settle_clocks[160+:32] <= 32'd0;
            settle_clocks[192+:32] <= 32'd0;
            settle_clocks[224+:32] <= 32'd0;
            settle_clocks[256+:32] <= 32'd0;
            settle_clocks[288+:32] <= 32'd0;
            settle_clocks[320+:32] <= 32'd0;
            settle_clocks[352+:32] <= 32'd0;
            settle_clocks[384+:32] <= 32'd0;
            settle_clocks[416+:32] <= 32'd0;
            settle_clocks[448+:32] <= 32'd0;
            settle_clocks[480+:32] <= 32'd0;
            table_cols[0+:32] <= 32'd0;
            table_cols[32+:32] <= 32'd0;
            table_cols[64+:32] <= 32'd0;
            table_cols[96+:32] <= 32'd0;
            table_cols[128+:32] <= 32'd0;
            table_cols[160+:32] <= 32'd0;
            table_cols[192+:32] <= 32'd0;
            table_cols[224+:32] <= 32'd0;
            table_cols[256+:32] <= 32'd0;
            table_cols[288+:32] <= 32'd0;
            table_cols[320+:32] <= 32'd0;
            table_cols[352+:32] <= 32'd0;
            table_cols[384+:32] <= 32'd0;
            table_cols[416+:32] <= 32'd0;
            table_cols[448+:32] <= 32'd0;
            table_cols[480+:32] <= 32'd0;
            table_clocks[0+:32] <= 32'd0;
            table_clocks[32+:32] <= 32'd0;
            table_clocks[64+:32] <= 32'd0;
            table_clocks[96+:32] <= 32'd0;
            table_clocks[128+:32] <= 32'd0;
            table_clocks[160+:32] <= 32'd0;
            table_clocks[192+:32] <= 32'd0;
            table_clocks[224+:32] <= 32'd0;
            table_clocks[256+:32] <= 32'd0;
            table_clocks[288+:32] <= 32'd0;
            table_clocks[320+:32] <= 32'd0;
            table_clocks[352+:32] <= 32'd0;
            table_clocks[384+:32] <= 32'd0;
            table_clocks[416+:32] <= 32'd0;
            table_clocks[448+:32] <= 32'd0;
            table_clocks[480+:32] <= 32'd0;
        end else begin
            if (writes)
                case (s_axil_awaddr)
                    12'h04C: slots <= s_axil_wdata[31:0];
                    12'h080: bank_period[0+:16] <= s_axil_wdata[15:0];
                    12'h084: bank_period[16+:16] <= s_axil_wdata[15:0];
                    12'h088: bank_offset[0+:16] <= s_axil_wdata[15:0];
                    12'h08C: bank_offset[16+:16] <= s_axil_wdata[15:0];
                    12'h0A0: rows <= s_axil_wdata[15:0];
                    12'h0A4: cols <= s_axil_wdata[15:0];
                    12'h0A8: drops <= s_axil_wdata[0:0];
                    12'h0AC: slot_clocks <= s_axil_wdata[31:0];
                    12'h0B0: budget_clocks <= s_axil_wdata[31:0];
                    12'h0C0: row_timing <= s_axil_wdata[1:0];
                    12'h0C4: exposes_while_reading <= s_axil_wdata[0:0];
                    12'h0C8: rot_clocks <= s_axil_wdata[31:0];
                    12'h0CC: skip_row_clocks <= s_axil_wdata[31:0];
                    12'h0D0: settle_margin <= s_axil_wdata[31:0];
                    12'h0D4: adc_clocks <= s_axil_wdata[31:0];
                    12'h0D8: adc_skip <= s_axil_wdata[0:0];
                    12'h0DC: blanking_clocks <= s_axil_wdata[31:0];
                    12'h0E0: clocks_per_column <= s_axil_wdata[31:0];
                    12'h0E4: io_clocks <= s_axil_wdata[31:0];
                    12'h0E8: has_table <= s_axil_wdata[0:0];
                    12'h0EC: dark_rows <= s_axil_wdata[15:0];
                    12'h0F0: overhead_clocks <= s_axil_wdata[31:0];
                    12'h0F4: overhead_rows <= s_axil_wdata[15:0];
                    12'h0F8: full_row_clocks <= s_axil_wdata[31:0];
                    12'h100: link_bits_low <= s_axil_wdata[31:0];
                    12'h104: link_bits_high <= s_axil_wdata[31:0];
                    12'h108: link_rate_low <= s_axil_wdata[31:0];
                    12'h10C: link_rate_high <= s_axil_wdata[31:0];
                    12'h140: settle_clocks[0+:32] <= s_axil_wdata[31:0];
                    12'h144: settle_clocks[32+:32] <= s_axil_wdata[31:0];
                    12'h148: settle_clocks[64+:32] <= s_axil_wdata[31:0];
                    12'h14C: settle_clocks[96+:32] <= s_axil_wdata[31:0];
                    12'h150: settle_clocks[128+:32] <= s_axil_wdata[31:0];
                    12'h154: settle_clocks[160+:32] <= s_axil_wdata[31:0];
                    12'h158: settle_clocks[192+:32] <= s_axil_wdata[31:0];
                    12'h15C: settle_clocks[224+:32] <= s_axil_wdata[31:0];
                    12'h160: settle_clocks[256+:32] <= s_axil_wdata[31:0];
                    12'h164: settle_clocks[288+:32] <= s_axil_wdata[31:0];
                    12'h168: settle_clocks[320+:32] <= s_axil_wdata[31:0];
                    12'h16C: settle_clocks[352+:32] <= s_axil_wdata[31:0];
                    12'h170: settle_clocks[384+:32] <= s_axil_wdata[31:0];
                    12'h174: settle_clocks[416+:32] <= s_axil_wdata[31:0];
                    12'h178: settle_clocks[448+:32] <= s_axil_wdata[31:0];
                    12'h17C: settle_clocks[480+:32] <= s_axil_wdata[31:0];
                    12'h180: table_cols[0+:32] <= s_axil_wdata[31:0];
                    12'h184: table_cols[32+:32] <= s_axil_wdata[31:0];
                    12'h188: table_cols[64+:32] <= s_axil_wdata[31:0];
                    12'h18C: table_cols[96+:32] <= s_axil_wdata[31:0];
                    12'h190: table_cols[128+:32] <= s_axil_wdata[31:0];
                    12'h194: table_cols[160+:32] <= s_axil_wdata[31:0];
                    12'h198: table_cols[192+:32] <= s_axil_wdata[31:0];
                    12'h19C: table_cols[224+:32] <= s_axil_wdata[31:0];
                    12'h1A0: table_cols[256+:32] <= s_axil_wdata[31:0];
                    12'h1A4: table_cols[288+:32] <= s_axil_wdata[31:0];
                    12'h1A8: table_cols[320+:32] <= s_axil_wdata[31:0];
                    12'h1AC: table_cols[352+:32] <= s_axil_wdata[31:0];
                    12'h1B0: table_cols[384+:32] <= s_axil_wdata[31:0];
                    12'h1B4: table_cols[416+:32] <= s_axil_wdata[31:0];
                    12'h1B8: table_cols[448+:32] <= s_axil_wdata[31:0];
                    12'h1BC: table_cols[480+:32] <= s_axil_wdata[31:0];
                    12'h1C0: table_clocks[0+:32] <= s_axil_wdata[31:0];
                    12'h1C4: table_clocks[32+:32] <= s_axil_wdata[31:0];
                    12'h1C8: table_clocks[64+:32] <= s_axil_wdata[31:0];
                    12'h1CC: table_clocks[96+:32] <= s_axil_wdata[31:0];
                    12'h1D0: table_clocks[128+:32] <= s_axil_wdata[31:0];
                    12'h1D4: table_clocks[160+:32] <= s_axil_wdata[31:0];
                    12'h1D8: table_clocks[192+:32] <= s_axil_wdata[31:0];
                    12'h1DC: table_clocks[224+:32] <= s_axil_wdata[31:0];
                    12'h1E0: table_clocks[256+:32] <= s_axil_wdata[31:0];
                    12'h1E4: table_clocks[288+:32] <= s_axil_wdata[31:0];
                    12'h1E8: table_clocks[320+:32] <= s_axil_wdata[31:0];
                    12'h1EC: table_clocks[352+:32] <= s_axil_wdata[31:0];
                    12'h1F0: table_clocks[384+:32] <= s_axil_wdata[31:0];
                    12'h1F4: table_clocks[416+:32] <= s_axil_wdata[31:0];
                    12'h1F8: table_clocks[448+:32] <= s_axil_wdata[31:0];
                    12'h1FC: table_clocks[480+:32] <= s_axil_wdata[31:0];
                    default: ;
                endcase
            error <= (writes && s_axil_awaddr == 12'h048
                ? error & ~s_axil_wdata[6:0] : error) | error_set;
        end

    always_comb begin
        is_bad_read = 1'b0;
        value = '0;
        case (s_axil_araddr)
            12'h000: value = 32'(id);
            12'h004: value = 32'(array_rows);
            12'h008: value = 32'(array_cols);
            12'h00C: value = 32'(tile_rows);
            12'h010: value = 32'(tile_cols);
            12'h014: value = 32'(depth);
            12'h018: value = 32'(pixel_bits);
            12'h01C: value = 32'(channels);
            12'h020: value = 32'(bit_depth);
            12'h024: value = 32'(dark_rows_max);
            12'h040: ;
            12'h044: value = 32'(status);
            12'h048: value = 32'(error);
            12'h04C: value = 32'(slots);
            12'h060: value = 32'(slot_count);
            12'h064: value = 32'(overrun_count);
            12'h068: value = 32'(dropped_count);
            12'h06C: value = 32'(packet_count);
            12'h070: value = 32'(sample_count);
            12'h074: value = 32'(swap_slot);
            12'h080: value = 32'(bank_period[0+:16]);
            12'h084: value = 32'(bank_period[16+:16]);
            12'h088: value = 32'(bank_offset[0+:16]);
            12'h08C: value = 32'(bank_offset[16+:16]);
            12'h090: ;
            12'h094: ;
            12'h0A0: value = 32'(rows);
            12'h0A4: value = 32'(cols);
            12'h0A8: value = 32'(drops);
            12'h0AC: value = 32'(slot_clocks);
            12'h0B0: value = 32'(budget_clocks);
            12'h0C0: value = 32'(row_timing);
            12'h0C4: value = 32'(exposes_while_reading);
            12'h0C8: value = 32'(rot_clocks);
            12'h0CC: value = 32'(skip_row_clocks);
            12'h0D0: value = 32'(settle_margin);
            12'h0D4: value = 32'(adc_clocks);
            12'h0D8: value = 32'(adc_skip);
            12'h0DC: value = 32'(blanking_clocks);
            12'h0E0: value = 32'(clocks_per_column);
            12'h0E4: value = 32'(io_clocks);
            12'h0E8: value = 32'(has_table);
            12'h0EC: value = 32'(dark_rows);
            12'h0F0: value = 32'(overhead_clocks);
            12'h0F4: value = 32'(overhead_rows);
            12'h0F8: value = 32'(full_row_clocks);
            12'h100: value = 32'(link_bits_low);
            12'h104: value = 32'(link_bits_high);
            12'h108: value = 32'(link_rate_low);
            12'h10C: value = 32'(link_rate_high);
            12'h140: value = 32'(settle_clocks[0+:32]);
            12'h144: value = 32'(settle_clocks[32+:32]);
            12'h148: value = 32'(settle_clocks[64+:32]);
            12'h14C: value = 32'(settle_clocks[96+:32]);
            12'h150: value = 32'(settle_clocks[128+:32]);
            12'h154: value = 32'(settle_clocks[160+:32]);
            12'h158: value = 32'(settle_clocks[192+:32]);
            12'h15C: value = 32'(settle_clocks[224+:32]);
            12'h160: value = 32'(settle_clocks[256+:32]);
            12'h164: value = 32'(settle_clocks[288+:32]);
            12'h168: value = 32'(settle_clocks[320+:32]);
            12'h16C: value = 32'(settle_clocks[352+:32]);
            12'h170: value = 32'(settle_clocks[384+:32]);
            12'h174: value = 32'(settle_clocks[416+:32]);
            12'h178: value = 32'(settle_clocks[448+:32]);
            12'h17C: value = 32'(settle_clocks[480+:32]);
            12'h180: value = 32'(table_cols[0+:32]);
            12'h184: value = 32'(table_cols[32+:32]);
            12'h188: value = 32'(table_cols[64+:32]);
            12'h18C: value = 32'(table_cols[96+:32]);
            12'h190: value = 32'(table_cols[128+:32]);
            12'h194: value = 32'(table_cols[160+:32]);
            12'h198: value = 32'(table_cols[192+:32]);
            12'h19C: value = 32'(table_cols[224+:32]);
            12'h1A0: value = 32'(table_cols[256+:32]);
            12'h1A4: value = 32'(table_cols[288+:32]);
            12'h1A8: value = 32'(table_cols[320+:32]);
            12'h1AC: value = 32'(table_cols[352+:32]);
            12'h1B0: value = 32'(table_cols[384+:32]);
            12'h1B4: value = 32'(table_cols[416+:32]);
            12'h1B8: value = 32'(table_cols[448+:32]);
            12'h1BC: value = 32'(table_cols[480+:32]);
            12'h1C0: value = 32'(table_clocks[0+:32]);
            12'h1C4: value = 32'(table_clocks[32+:32]);
            12'h1C8: value = 32'(table_clocks[64+:32]);
            12'h1CC: value = 32'(table_clocks[96+:32]);
            12'h1D0: value = 32'(table_clocks[128+:32]);
            12'h1D4: value = 32'(table_clocks[160+:32]);
            12'h1D8: value = 32'(table_clocks[192+:32]);
            12'h1DC: value = 32'(table_clocks[224+:32]);
            12'h1E0: value = 32'(table_clocks[256+:32]);
            12'h1E4: value = 32'(table_clocks[288+:32]);
            12'h1E8: value = 32'(table_clocks[320+:32]);
            12'h1EC: value = 32'(table_clocks[352+:32]);
            12'h1F0: value = 32'(table_clocks[384+:32]);
            12'h1F4: value = 32'(table_clocks[416+:32]);
            12'h1F8: value = 32'(table_clocks[448+:32]);
            12'h1FC: value = 32'(table_clocks[480+:32]);
            default: is_bad_read = 1'b1;
        endcase
    end
endmodule
