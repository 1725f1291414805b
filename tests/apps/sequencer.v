// Loads a memory image of `stipple schedule compile` and prints, slot by slot and row by row of the
// tile, the columns that are read: "slot row: col col ...". The figures come from the command line
// (-P sequencer.ROWS=...), the file as +image=FILE.
module sequencer;
    parameter ROWS = 1, COLS = 1, PERIOD = 1, BITS = 1;
    reg [COLS * BITS - 1:0] words [0:PERIOD * ROWS - 1];
    reg [8 * 1024 - 1:0] image;
    integer slot, row, col;
    initial begin
        if (!$value$plusargs("image=%s", image)) $fatal(1, "no +image=FILE");
        $readmemh(image, words);
        for (slot = 0; slot < PERIOD; slot = slot + 1)
            for (row = 0; row < ROWS; row = row + 1) begin
                $write("%0d %0d:", slot, row);
                for (col = 0; col < COLS; col = col + 1)
                    if (words[slot * ROWS + row][col * BITS]) $write(" %0d", col);
                $write("\n");
            end
    end
endmodule
