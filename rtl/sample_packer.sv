// Packs the samples of a slot into the payload of a packet (docs/stream_format.md, kind 1): the DN
// of the due pixels row by row and by column, BIT_DEPTH bits each, LSB first, with CRC-32C.
//
// Rows come by `row_valid` and leave by `row_pop`; a row takes a clock for each PACK due pixels, at
// least one. What is known of each ended slot comes by `slot_valid` and leaves by `slot_pop`: a
// packet is complete when its slot has ended, which tells whether it was an overrun, and the last
// row of its scan is packed. Words of the payload leave by `word_valid`; then, in the clock of its
// last word if it has a part of one, `packet_valid` tells the size of the packet. Rows that were
// dropped are a packet without samples.
module sample_packer #(
    parameter int COLS = 8,
    parameter int BIT_DEPTH = 10,
    parameter int PACK = 2,
    parameter int WORD_BYTES = 4  // 8 WORD_BYTES >= PACK x BIT_DEPTH
) (
    input  logic                      clk,
    input  logic                      rst,
    input  logic                      row_valid,
    input  logic [COLS-1:0]           row_due,
    input  logic [COLS*BIT_DEPTH-1:0] row_dn,
    input  logic                      row_is_last,  // of its scan
    input  logic [15:0]               row_number,   // of its slot
    input  logic [15:0]               row_end,      // rows from here on are dropped
    output logic                      row_pop,
    input  logic                      slot_valid,
    input  logic                      slot_has_rows,
    input  logic                      slot_overrun,
    input  logic [15:0]               slot_first_row,  // with due pixels
    input  logic [15:0]               undecided,    // the oldest slot that may still be scanned
    input  logic                      is_reading,   // the rows of slot scan_number
    input  logic [15:0]               scan_number,
    input  logic [15:0]               rows,
    output logic                      slot_pop,
    output logic                      word_valid,
    output logic [8*WORD_BYTES-1:0]   word,
    output logic                      packet_valid,
    output logic [1:0]                packet_flags,  // dropped, overrun
    output logic [15:0]               packet_first_row,
    output logic [15:0]               packet_rows,
    output logic [52:0]               packet_slot,
    output logic [31:0]               packet_samples,
    output logic [31:0]               packet_bytes,
    output logic [31:0]               packet_crc
);
    localparam int WORD_BITS = 8 * WORD_BYTES;
    localparam int FILL_BITS = $clog2(2 * WORD_BITS + 1);
    localparam int COUNT_BITS = $clog2(WORD_BYTES + 1);

    logic is_packed;  // the last row of the scan
    logic is_ours, is_dropped, is_cut;  // rows of this slot; all of them; the last ones
    logic drops_rest;  // the packet of the dropped last rows is next
    logic [15:0] end_row, cut_row;
    logic in_row;     // a part of it is packed
    logic [COLS-1:0] held_due, due, rest;
    logic [2*WORD_BITS-1:0] bits, filled_bits;
    logic [FILL_BITS-1:0] fill, filled;
    logic [31:0] samples, packed_samples, words, crc, crc_next, end_crc;
    logic [52:0] slot;
    logic packs, is_full, has_part;
    logic [COUNT_BITS-1:0] part_bytes;

    // Up to PACK due pixels of the row.
    assign is_ours = row_valid && row_number == slot[15:0];
    assign packs = is_ours && !is_packed;
    assign due   = in_row ? held_due : row_due;
    for (genvar i = 0; i < PACK; i = i + 1) begin : g_sample
        logic [COLS-1:0] before_it, first, after_it;
        logic [BIT_DEPTH-1:0] dn;
        logic [2*WORD_BITS-1:0] bits_before, bits_after;
        logic [FILL_BITS-1:0] fill_before, fill_after;
        logic [31:0] count_before, count_after;
        if (i == 0) begin : g_first
            assign before_it    = packs ? due : '0;
            assign bits_before  = bits;
            assign fill_before  = fill;
            assign count_before = samples;
        end else begin : g_next
            assign before_it    = g_sample[i-1].after_it;
            assign bits_before  = g_sample[i-1].bits_after;
            assign fill_before  = g_sample[i-1].fill_after;
            assign count_before = g_sample[i-1].count_after;
        end
        next_due #(.WIDTH(COLS)) u_next (
            .pending(before_it),
            .first
        );
        always_comb begin
            dn = '0;
            for (int c = 0; c < COLS; c = c + 1)
                if (first[c]) dn = dn | row_dn[c*BIT_DEPTH+:BIT_DEPTH];
        end
        assign after_it    = before_it & ~first;
        assign bits_after  = bits_before | (2 * WORD_BITS)'(dn) << fill_before;
        assign fill_after  = fill_before + (first != '0 ? FILL_BITS'(BIT_DEPTH) : '0);
        assign count_after = count_before + 32'(first != '0);
    end
    assign rest           = g_sample[PACK-1].after_it;
    assign filled_bits    = g_sample[PACK-1].bits_after;
    assign filled         = g_sample[PACK-1].fill_after;
    assign packed_samples = g_sample[PACK-1].count_after;
    assign row_pop        = packs && rest == '0;

    // The end of a packet: of a slot without rows, of one that has ended and is packed, or of one
    // that was not scanned; and of the dropped rows of the last two.
    assign is_dropped = slot_has_rows && !is_packed && !is_ours && slot[15:0] != undecided &&
                        !(is_reading && scan_number == slot[15:0]);
    assign packet_valid = slot_valid && (is_packed || !slot_has_rows || is_dropped);
    assign cut_row      = is_packed ? end_row : slot_first_row;
    assign is_cut       = (is_packed || is_dropped) && !drops_rest && cut_row != rows &&
                          cut_row != '0;
    assign slot_pop     = packet_valid && !is_cut;
    assign is_full      = filled >= FILL_BITS'(WORD_BITS);
    assign has_part     = packet_valid && fill != '0;
    assign part_bytes   = COUNT_BITS'((fill + FILL_BITS'(7)) >> 3);
    assign word_valid   = is_full || has_part;
    assign word         = filled_bits[WORD_BITS-1:0];

    crc32c #(.BYTES(WORD_BYTES)) u_crc (
        .previous(crc),
        .data(word),
        .count(has_part ? part_bytes : COUNT_BITS'(WORD_BYTES)),
        .next(crc_next)
    );
    assign end_crc        = has_part ? crc_next : crc;
    assign packet_flags     = is_cut ? 2'b00 : drops_rest || is_dropped ? 2'b10
                                                                        : {1'b0, slot_overrun};
    assign packet_first_row = drops_rest ? cut_row : '0;
    assign packet_rows      = is_cut ? cut_row : rows - packet_first_row;
    assign packet_slot    = slot;
    assign packet_samples = samples;
    assign packet_bytes   = words * WORD_BYTES + (has_part ? 32'(part_bytes) : '0);
    assign packet_crc     = ~end_crc;

    always_ff @(posedge clk)
        if (rst) begin
            is_packed <= 1'b0;
            in_row <= 1'b0;
            drops_rest <= 1'b0;
            slot <= '0;
        end else begin
            is_packed <= !slot_pop && (is_packed || (row_pop && row_is_last));
            drops_rest <= packet_valid && is_cut;
            in_row <= packs && rest != '0;
            if (slot_pop) slot <= slot + 1'b1;
        end

    always_ff @(posedge clk)
        if (rst || packet_valid) begin
            bits <= '0;
            fill <= '0;
            samples <= '0;
            words <= '0;
            crc <= '1;
        end else begin
            bits <= is_full ? filled_bits >> WORD_BITS : filled_bits;
            fill <= is_full ? filled - FILL_BITS'(WORD_BITS) : filled;
            samples <= packed_samples;
            words <= words + 32'(is_full);
            if (is_full) crc <= crc_next;
        end

    always_ff @(posedge clk) begin
        held_due <= rest;
        if (row_pop) end_row <= row_end;
    end
endmodule
