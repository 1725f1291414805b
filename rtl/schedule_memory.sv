// The memory of the sequencer, as `stipple schedule compile` fills it (docs/sequencer_program.md):
// the word of slot and tile row at address slot x TILE_ROWS + tile row; in it the bits of column c
// begin at bit c x PIXEL_BITS.
//
// The file is IMAGE; in a simulation +schedule=FILE names another one. A word is read without a
// clock.
module schedule_memory #(
    parameter int TILE_ROWS = 1,
    parameter int TILE_COLS = 1,
    parameter int PIXEL_BITS = 1,
    parameter int DEPTH = 1,  // slots
    parameter IMAGE = "",
    parameter int ADDRESS_BITS = $clog2(DEPTH * TILE_ROWS)
) (
    input  logic [ADDRESS_BITS-1:0]         address,
    output logic [TILE_COLS*PIXEL_BITS-1:0] word
);
    logic [TILE_COLS*PIXEL_BITS-1:0] words [0:DEPTH*TILE_ROWS-1];

    assign word = words[address];

`ifdef SYNTHESIS
    initial if (IMAGE != "") $readmemh(IMAGE, words);
`else
    string file;
    initial begin
        for (int i = 0; i < DEPTH * TILE_ROWS; i = i + 1) words[i] = '0;
        if ($value$plusargs("schedule=%s", file) != 0) $readmemh(file, words);
        else if (IMAGE != "") $readmemh(IMAGE, words);
        else $fatal(1, "no schedule: give the parameter IMAGE or +schedule=FILE");
    end
`endif
endmodule
