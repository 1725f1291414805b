// Sends packets of samples (docs/stream_format.md) through an AXI-Stream port.
//
// Words of payloads and then the size of their packet are pushed into queues of WORDS and PACKETS;
// a packet is sent once it is complete. Its header takes 32 / WORD_BYTES beats and one for its CRC,
// which has 4 bytes; its payload a beat for each word, the last one with the bytes that are left.
// tkeep tells the bytes of a beat, tlast the last beat of a packet. `overflow` is a clock in which
// a queue was full: data are lost, as the chip cannot wait.
//
// `stream_crc` is the header CRC of the file, from which the CRC of packets continue.
module packet_sender #(
    parameter int WORD_BYTES = 4,  // 4, 8, 16 or 32
    parameter int WORDS = 1024,    // a power of two
    parameter int PACKETS = 16     // a power of two
) (
    input  logic                    clk,
    input  logic                    rst,
    input  logic [31:0]             stream_crc,
    input  logic                    word_valid,
    input  logic [8*WORD_BYTES-1:0] word,
    input  logic                    packet_valid,
    input  logic [1:0]              packet_flags,  // dropped, overrun
    input  logic [15:0]             packet_switches,
    input  logic [15:0]             packet_first_row,
    input  logic [15:0]             packet_rows,
    input  logic [52:0]             packet_slot,
    input  logic [31:0]             packet_samples,
    input  logic [31:0]             packet_bytes,
    input  logic [31:0]             packet_crc,
    output logic                    overflow,
    output logic                    is_idle,  // all packets are sent
    output logic                    m_axis_tvalid,
    input  logic                    m_axis_tready,
    output logic [8*WORD_BYTES-1:0] m_axis_tdata,
    output logic [WORD_BYTES-1:0]   m_axis_tkeep,
    output logic                    m_axis_tlast
);
    localparam int HEADER_BEATS = 32 / WORD_BYTES;
    localparam int COUNT_BITS = $clog2(WORD_BYTES + 1);
    localparam logic [1:0] HEADER = 0, HEADER_CRC = 1, PAYLOAD = 2;

    logic [1:0] part;
    logic [5:0] beat;  // of the header
    logic [31:0] left;  // bytes of the payload
    logic [31:0] crc, crc_next, header_crc;
    logic [255:0] header;
    logic is_sent, is_whole_word, words_overflow, packets_overflow;

    logic [1:0] flags;
    logic [15:0] switches, first_row, rows;
    logic [52:0] slot;
    logic [31:0] samples, bytes, payload_crc;
    logic has_packet, has_word;
    logic [8*WORD_BYTES-1:0] payload;

    fifo #(.WIDTH(8 * WORD_BYTES), .DEPTH(WORDS)) u_words (
        .clk, .rst,
        .push(word_valid),
        .item(word),
        .pop(is_sent && part == PAYLOAD),
        .valid(has_word),
        .head(payload),
        .overflow(words_overflow)
    );
    fifo #(.WIDTH(199), .DEPTH(PACKETS)) u_packets (
        .clk, .rst,
        .push(packet_valid),
        .item({packet_flags, packet_switches, packet_first_row, packet_rows, packet_slot, packet_samples,
               packet_bytes, packet_crc}),
        .pop(is_sent && m_axis_tlast),
        .valid(has_packet),
        .head({flags, switches, first_row, rows, slot, samples, bytes, payload_crc}),
        .overflow(packets_overflow)
    );
    assign overflow = words_overflow || packets_overflow;
    assign is_idle  = !has_packet;

    // The first byte is the lowest.
    assign header = {payload_crc, bytes, samples, rows, first_row, 11'd0, slot, switches, 6'd0, flags,
                     8'd1, 32'h4B50_53C5};

    crc32c #(.BYTES(WORD_BYTES)) u_crc (
        .previous(crc),
        .data(m_axis_tdata),
        .count(COUNT_BITS'(WORD_BYTES)),
        .next(crc_next)
    );

    assign header_crc    = ~crc;
    assign is_whole_word = left >= 32'(WORD_BYTES);
    assign m_axis_tvalid = has_packet && (part != PAYLOAD || has_word);
    assign m_axis_tlast  = part == PAYLOAD ? left <= 32'(WORD_BYTES)
                                           : part == HEADER_CRC && bytes == '0;
    assign is_sent       = m_axis_tvalid && m_axis_tready;
    always_comb begin
        m_axis_tdata = payload;
        m_axis_tkeep = is_whole_word ? '1 : (WORD_BYTES'(1) << left[COUNT_BITS-1:0]) - 1'b1;
        if (part == HEADER) begin
            m_axis_tdata = (8 * WORD_BYTES)'(header >> (32'(beat) * 8 * WORD_BYTES));
            m_axis_tkeep = '1;
        end else if (part == HEADER_CRC) begin
            m_axis_tdata = (8 * WORD_BYTES)'(header_crc);
            m_axis_tkeep = WORD_BYTES'(4'hF);
        end
    end

    always_ff @(posedge clk)
        if (rst) begin
            part <= HEADER;
            beat <= '0;
            left <= '0;
            crc <= '0;
        end else begin
            if (part == HEADER && beat == '0 && !is_sent) crc <= ~stream_crc;
            else if (is_sent && part == HEADER) crc <= crc_next;
            else if (is_sent && m_axis_tlast) crc <= ~stream_crc;
            if (is_sent)
                case (part)
                    HEADER: begin
                        beat <= beat + 1'b1;
                        if (32'(beat) == HEADER_BEATS - 1) part <= HEADER_CRC;
                    end
                    HEADER_CRC: begin
                        beat <= '0;
                        left <= bytes;
                        part <= bytes == '0 ? HEADER : PAYLOAD;
                    end
                    default: begin
                        left <= left - 32'(WORD_BYTES);
                        if (m_axis_tlast) part <= HEADER;
                    end
                endcase
        end

`ifdef STIPPLE_ASSERT
    // The rules of AXI-Stream, and the packets by a serial CRC of the bytes that leave.
    function automatic logic [31:0] serial_crc(input logic [31:0] crc_before, input logic [8*WORD_BYTES-1:0] data,
                                               input logic [WORD_BYTES-1:0] keep);
        logic feedback;
        serial_crc = crc_before;
        for (int i = 0; i < 8 * WORD_BYTES; i = i + 1)
            if (keep[i/8]) begin
                feedback = serial_crc[31] ^ data[i];
                serial_crc = {serial_crc[30:0], 1'b0} ^ (feedback ? 32'h1EDC_6F41 : 32'd0);
            end
    endfunction
    function automatic logic [31:0] reversed(input logic [31:0] value);
        for (int i = 0; i < 32; i = i + 1) reversed[i] = value[31-i];
    endfunction

    logic waited, held_last;
    logic [8*WORD_BYTES-1:0] held_data;
    logic [WORD_BYTES-1:0] held_keep;
    logic [31:0] sent, sent_now, serial, serial_now, pushed, pushed_now;
    always_comb begin
        sent_now = sent;
        for (int i = 0; i < WORD_BYTES; i = i + 1) sent_now = sent_now + 32'(m_axis_tkeep[i]);
    end
    assign serial_now = serial_crc(serial, m_axis_tdata, m_axis_tkeep);
    assign pushed_now = pushed + 32'(word_valid);
    always_ff @(posedge clk) begin
        {held_data, held_keep, held_last} <= {m_axis_tdata, m_axis_tkeep, m_axis_tlast};
        waited <= !rst && m_axis_tvalid && !m_axis_tready;
        pushed <= rst || packet_valid ? '0 : pushed_now;
        sent   <= rst || (is_sent && m_axis_tlast) ? '0 : is_sent ? sent_now : sent;
        serial <= rst || (is_sent ? m_axis_tlast : sent == '0) ? ~reversed(stream_crc)
                : !is_sent ? serial : part == HEADER_CRC ? '1 : serial_now;
        if (!rst) begin
            if (packet_valid)
                assert (pushed_now == (packet_bytes + 32'(WORD_BYTES - 1)) / 32'(WORD_BYTES));
            if (waited)
                assert (m_axis_tvalid && held_data == m_axis_tdata && held_keep == m_axis_tkeep &&
                        held_last == m_axis_tlast);
            if (m_axis_tvalid) begin
                assert (m_axis_tkeep[0] && (m_axis_tkeep & (m_axis_tkeep + 1'b1)) == '0);
                assert (part == HEADER_CRC || m_axis_tlast || m_axis_tkeep == '1);
                assert ((sent == 32'd32) == (part == HEADER_CRC));
                assert (m_axis_tlast == (sent >= 32'd32 && sent_now == 32'd36 + bytes));
`ifndef FORMAL  // solvers do not come to an end with long CRCs
                if (sent == 32'd32) assert (m_axis_tdata[31:0] == ~reversed(serial));
                if (sent > 32'd32 && m_axis_tlast) assert (~reversed(serial_now) == payload_crc);
                if (sent == 32'd32 && m_axis_tlast) assert (payload_crc == '0);
`endif
            end
        end
    end
`endif
endmodule
