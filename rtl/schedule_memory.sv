// The memory of the sequencer: two banks, each with a program as `stipple schedule compile` writes it
// (docs/sequencer_program.md): the word of slot and tile row at address slot x TILE_ROWS + tile row; in
// it the bits of column c begin at bit c x PIXEL_BITS.
//
// Bank 0 may be preset from the file IMAGE; in a simulation +schedule=FILE names another one. A word is
// written in parts of 32 bits, the lowest first: `at` says where, after the last part follows the next
// word. `is_beyond` tells that there is no such word. A word is read without a clock.
module schedule_memory #(
    parameter int TILE_ROWS = 1,
    parameter int TILE_COLS = 1,
    parameter int PIXEL_BITS = 1,
    parameter int DEPTH = 1,  // slots
    parameter IMAGE = "",
    parameter int ADDRESS_BITS = $clog2(DEPTH * TILE_ROWS)
) (
    input  logic                            clk,
    input  logic                            set_at,
    input  logic                            at_bank,
    input  logic [30:0]                     at,
    input  logic                            write,
    input  logic [31:0]                     part,
    output logic                            write_bank,
    output logic                            is_beyond,
    input  logic                            bank,
    input  logic [ADDRESS_BITS-1:0]         address,
    output logic [TILE_COLS*PIXEL_BITS-1:0] word
);
    localparam int WORDS = DEPTH * TILE_ROWS;
    localparam int WORD_BITS = TILE_COLS * PIXEL_BITS;
    localparam int PARTS = (WORD_BITS + 31) / 32;

    logic [WORD_BITS-1:0] words [0:2*WORDS-1];  // bank 0, then bank 1
    logic [30:0] write_at;
    logic [15:0] parts;  // of the word so far
    logic [32*PARTS-1:0] held, written;

    assign word      = words[bank ? (ADDRESS_BITS + 1)'(address) + (ADDRESS_BITS + 1)'(WORDS)
                                  : (ADDRESS_BITS + 1)'(address)];
    assign is_beyond = write_at >= 31'(WORDS);
    assign written   = (32 * PARTS)'({part, held} >> 32);

    always_ff @(posedge clk)
        if (set_at) begin
            write_bank <= at_bank;
            write_at <= at;
            parts <= '0;
        end else if (write) begin
            held <= written;
            parts <= parts + 1'b1;
            if (parts == 16'(PARTS - 1)) begin
                parts <= '0;
                write_at <= write_at + 1'b1;
                words[write_bank ? (ADDRESS_BITS + 1)'(write_at) + (ADDRESS_BITS + 1)'(WORDS)
                                 : (ADDRESS_BITS + 1)'(write_at)] <= written[WORD_BITS-1:0];
            end
        end

`ifdef SYNTHESIS
    initial if (IMAGE != "") $readmemh(IMAGE, words);
`else
    string file;
    initial begin
        for (int i = 0; i < 2 * WORDS; i = i + 1) words[i] = '0;
        if ($value$plusargs("schedule=%s", file) != 0) $readmemh(file, words);
        else if (IMAGE != "") $readmemh(IMAGE, words);
    end
`endif
endmodule
