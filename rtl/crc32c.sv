// CRC-32C (Castagnoli) of up to BYTES bytes, without a clock: the register after the first `count`
// bytes of `data`, the lowest byte first. The CRC is the inverse of the register.
module crc32c #(
    parameter int BYTES = 4,
    parameter int COUNT_BITS = $clog2(BYTES + 1)
) (
    input  logic [31:0]           previous,
    input  logic [8*BYTES-1:0]    data,
    input  logic [COUNT_BITS-1:0] count,
    output logic [31:0]           next
);
    localparam logic [31:0] POLYNOMIAL = 32'h82F6_3B78;  // reflected

    function automatic logic [31:0] add_byte(input logic [31:0] crc, input logic [7:0] value);
        logic [31:0] sum;
        sum = crc ^ {24'd0, value};
        for (int i = 0; i < 8; i = i + 1) sum = {1'b0, sum[31:1]} ^ (sum[0] ? POLYNOMIAL : 32'd0);
        add_byte = sum;
    endfunction

    always_comb begin
        next = previous;
        for (int i = 0; i < BYTES; i = i + 1)
            if (COUNT_BITS'(i) < count) next = add_byte(next, data[8*i+:8]);
    end
endmodule
