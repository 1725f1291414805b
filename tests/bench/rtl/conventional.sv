// The control of a conventional sensor of the same size, channels and times: each frame reads all rows
// one after another, converts one while the one before leaves through the channels, and sends a column
// of all channels in each clock, with a CRC for each frame.
module conventional #(
    parameter int ROWS = 16,
    parameter int COLS = 16,
    parameter int CHANNELS = 2,
    parameter int BIT_DEPTH = 10,
    parameter int WORD_BYTES = 4
) (
    input  logic                      clk,
    input  logic                      rst,
    input  logic [COLS*BIT_DEPTH-1:0] adc_dn,
    output logic                      select,
    output logic [$clog2(ROWS)-1:0]   select_row,
    output logic                      convert,
    output logic                      convert_end,
    output logic                      m_axis_tvalid,
    output logic [8*WORD_BYTES-1:0]   m_axis_tdata,
    output logic                      m_axis_tlast
);
    localparam int SETS = COLS / CHANNELS;  // columns of all channels
    localparam logic [11:0] FRAME_CLOCKS = 4000, ROT_CLOCKS = 6, ADC_CLOCKS = 20;
    localparam int SET_BITS = CHANNELS * BIT_DEPTH;

    logic [11:0] frame_clock, row_clock;
    logic is_reading, is_converting, is_latched, sends, is_last_set;
    logic [$clog2(SETS+1)-1:0] set;
    logic [COLS*BIT_DEPTH-1:0] latch, sent;
    logic [$clog2(ROWS)-1:0] row;
    logic [31:0] crc, crc_next;

    assign select      = is_reading && !is_converting && !is_latched;
    assign select_row  = row;
    assign convert     = is_converting && row_clock == ROT_CLOCKS;
    assign convert_end = is_converting && row_clock == ROT_CLOCKS + ADC_CLOCKS;
    assign is_last_set = 32'(set) == SETS - 1;

    always_ff @(posedge clk)
        if (rst) begin
            frame_clock <= '0;
            row_clock <= '0;
            row <= '0;
            is_reading <= 1'b0;
            is_converting <= 1'b0;
            is_latched <= 1'b0;
            sends <= 1'b0;
            set <= '0;
            crc <= '1;
        end else begin
            frame_clock <= frame_clock == FRAME_CLOCKS - 1 ? '0 : frame_clock + 1'b1;
            if (frame_clock == '0) is_reading <= 1'b1;
            row_clock <= select ? 12'd1 : row_clock + 1'b1;
            is_converting <= select || (is_converting && !convert_end);
            if (convert_end) begin
                is_latched <= 1'b1;
                row <= 32'(row) == ROWS - 1 ? '0 : row + 1'b1;
                if (32'(row) == ROWS - 1) is_reading <= 1'b0;
            end
            if (is_latched && (!sends || is_last_set)) begin
                is_latched <= convert_end;
                sends <= 1'b1;
                set <= '0;
            end else if (sends) begin
                sends <= !is_last_set;
                set <= set + 1'b1;
            end
            crc <= m_axis_tlast ? '1 : sends ? crc_next : crc;
        end

    always_ff @(posedge clk) begin
        if (convert_end) latch <= adc_dn;
        if (is_latched && (!sends || is_last_set)) sent <= latch;
        else if (sends) sent <= sent >> SET_BITS;
    end

    crc32c #(.BYTES(WORD_BYTES)) u_crc (
        .previous(crc),
        .data(m_axis_tdata),
        .count(($clog2(WORD_BYTES + 1))'(WORD_BYTES)),
        .next(crc_next)
    );
    assign m_axis_tvalid = sends || m_axis_tlast;
    assign m_axis_tlast  = !sends && !is_reading && !is_converting && !is_latched && crc != '1;
    assign m_axis_tdata  = m_axis_tlast ? (8 * WORD_BYTES)'(~crc)
                                        : (8 * WORD_BYTES)'(sent[SET_BITS-1:0]);
endmodule
