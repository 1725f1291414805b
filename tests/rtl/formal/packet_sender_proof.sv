// packet_sender: its assertions (AXI-Stream, sizes), with any words, packets and
// tready, if each packet comes with its words and no queue overflows. Payloads are at most two words.
module packet_sender_proof (
    input logic         clk,
    input logic         rst,
    input logic         word_valid,
    input logic [31:0] word,
    input logic         packet_valid,
    input logic [1:0]   packet_flags,
    input logic [52:0]  packet_slot,
    input logic [31:0]  packet_bytes,
    input logic         m_axis_tready
);
    logic overflow, m_axis_tvalid, m_axis_tlast;
    logic [31:0] m_axis_tdata;
    logic [3:0] m_axis_tkeep;
    logic [31:0] words, words_now;

    packet_sender #(.WORD_BYTES(4), .WORDS(4), .PACKETS(2)) u_sender (
        .clk, .rst, .stream_crc(32'h1234_5678), .word_valid, .word, .packet_valid, .packet_flags,
        .packet_switches('0), .packet_first_row('0), .packet_rows(16'd4), .packet_slot, .packet_samples('0),
        .packet_bytes, .packet_crc('0), .overflow, .m_axis_tvalid, .m_axis_tready, .m_axis_tdata,
        .m_axis_tkeep, .m_axis_tlast
    );
    assign words_now = words + 32'(word_valid);
    initial assume (rst);
    always_comb begin
        assume (!overflow && words_now <= 32'd2 && packet_bytes <= 32'd8);
        if (packet_valid) assume (words_now == (packet_bytes + 32'd3) >> 2);
    end
    always_ff @(posedge clk) words <= rst || packet_valid ? '0 : words_now;
endmodule
