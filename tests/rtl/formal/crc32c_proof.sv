// crc32c: for any register, bytes and count the same as a serial CRC, bit by bit, of the other bit
// order.
module crc32c_proof #(
    parameter int BYTES = 1  // more ones are a chain of these
) (
    input logic [31:0]        previous,
    input logic [8*BYTES-1:0] data,
    input logic [3:0]         count
);
    logic [31:0] next, serial, reversed;
    logic feedback;

    crc32c #(.BYTES(BYTES), .COUNT_BITS(4)) u_crc (
        .previous,
        .data,
        .count,
        .next
    );

    always_comb begin
        feedback = 1'b0;
        for (int i = 0; i < 32; i = i + 1) serial[i] = previous[31-i];
        for (int i = 0; i < 8 * BYTES; i = i + 1)
            if (i / 8 < 32'(count)) begin
                feedback = serial[31] ^ data[i];
                serial = {serial[30:0], 1'b0} ^ (feedback ? 32'h1EDC_6F41 : 32'd0);
            end
        for (int i = 0; i < 32; i = i + 1) reversed[i] = serial[31-i];
        assert (next == reversed);
    end
endmodule
