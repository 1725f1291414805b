// The link side of a row: converted rows wait in latches, then their columns leave through the
// channels.
//
//     row_ready     a converted row comes
//     transfer      a row begins to leave, if `may_transfer` and the link is free; with an idle
//                   link in the clock of row_ready
//     transfer_end  its last column has left, io_clocks after it
//     link_free     `blanking_clocks` later: the next row may leave, the latch of this one is free
//
// Channel c mod CHANNELS transfers column c, its columns one after another, each in
// `clocks_per_column`: `begun` has the columns that begin in this clock. A transfer lasts until
// the busiest channel is done, at full width until it could have sent all columns, and no shorter
// than the lanes of the link need: link_bits a column of all channels at link_rate a clock (0:
// no limit). With `has_table` the time is table_clocks[i] with the first table_cols[i] that is
// not less than the columns of the busiest channel x CHANNELS.
module row_transfer #(
    parameter int COLS = 8,
    parameter int CHANNELS = 2,
    parameter int ROW_BITS = 8,  // what else belongs to a row
    parameter int CLOCK_BITS = 32,
    parameter int TABLE = 4
) (
    input  logic                        clk,
    input  logic                        rst,
    input  logic                        full_width,
    input  logic [CLOCK_BITS-1:0]       clocks_per_column,
    input  logic [CLOCK_BITS-1:0]       io_clocks,
    input  logic [CLOCK_BITS-1:0]       blanking_clocks,
    input  logic [63:0]                 link_bits,
    input  logic [63:0]                 link_rate,
    input  logic                        has_table,
    input  logic [TABLE*CLOCK_BITS-1:0] table_cols,
    input  logic [TABLE*CLOCK_BITS-1:0] table_clocks,
    input  logic                        row_ready,
    input  logic [COLS-1:0]             ready_columns,
    input  logic [ROW_BITS-1:0]         ready_row,
    input  logic                        may_transfer,
    output logic                        transfer,
    output logic [COLS-1:0]             columns,   // of the row at `transfer`
    output logic [ROW_BITS-1:0]         row,       // that leaves, from `transfer` on
    output logic [ROW_BITS-1:0]         sent_row,  // the same a clock later: valid at transfer_end
    output logic [COLS-1:0]             begun,
    output logic                        transfer_end,
    output logic                        link_free
);
    localparam int ALL = COLS / CHANNELS;

    logic unused_overflow;  // the scanner selects no row without a latch
    logic waits, is_sending, is_resting, channels_are_over, is_sent;
    logic [ROW_BITS-1:0] waiting_row;
    logic [CLOCK_BITS-1:0] age, held_age, sent_io, rested, count, held_count, table_time;
    logic [63:0] sent_bits, held_bits, rate, held_rate;

    fifo #(.WIDTH(COLS + ROW_BITS), .DEPTH(2)) u_latches (
        .clk, .rst,
        .push(row_ready),
        .item({ready_columns, ready_row}),
        .pop(transfer),
        .valid(waits),
        .head({columns, waiting_row}),
        .overflow(unused_overflow)
    );
    column_scan #(.COLS(COLS), .LANES(CHANNELS), .CLOCK_BITS(CLOCK_BITS)) u_channels (
        .clk, .rst,
        .start(transfer),
        .columns,
        .clocks(clocks_per_column),
        .begun,
        .is_over(channels_are_over)
    );

    assign transfer = waits && may_transfer && ((!is_sending && !is_resting) || link_free);
    assign row      = transfer ? waiting_row : sent_row;

    // Columns of the busiest channel that have begun, or all of them; the bits that they have.
    assign count     = (transfer ? (full_width ? CLOCK_BITS'(ALL) : '0) : held_count) +
                       CLOCK_BITS'(!full_width && begun != '0);
    assign sent_bits = (transfer ? '0 : held_bits) +
                       (full_width ? (transfer ? link_bits * 64'(ALL) : '0)
                                   : (begun != '0 ? link_bits : '0));
    assign age       = transfer ? '0 : held_age;
    assign rate      = transfer ? '0 : held_rate;

    always_comb begin
        table_time = '0;
        for (int i = TABLE - 1; i >= 0; i = i - 1)
            if (table_cols[i*CLOCK_BITS+:CLOCK_BITS] >= held_count * CLOCK_BITS'(CHANNELS))
                table_time = table_clocks[i*CLOCK_BITS+:CLOCK_BITS];
    end

    assign is_sent = is_sending && channels_are_over &&
                     (has_table ? held_age >= table_time
                                : held_rate >= held_bits &&
                                  (!full_width ||
                                   held_age >= CLOCK_BITS'(ALL) * clocks_per_column));
    assign transfer_end = is_sent && sent_io == (has_table ? '0 : io_clocks);
    assign link_free    = blanking_clocks == '0 ? transfer_end
                                                : is_resting && rested == blanking_clocks;

    always_ff @(posedge clk)
        if (rst) begin
            is_sending <= 1'b0;
            is_resting <= 1'b0;
        end else begin
            is_sending <= transfer || (is_sending && !transfer_end);
            is_resting <= blanking_clocks != '0 && (transfer_end || (is_resting && !link_free));
        end

    always_ff @(posedge clk) begin
        sent_row <= row;
        held_age <= age + 1'b1;
        held_rate <= rate + link_rate;
        held_count <= count;
        held_bits <= sent_bits;
        sent_io <= transfer ? '0 : sent_io + CLOCK_BITS'(is_sent);
        rested <= transfer_end ? CLOCK_BITS'(1) : rested + 1'b1;
    end

`ifdef STIPPLE_ASSERT
    // Rows that are ready and have not left: no more than two latches. None is lost.
    logic [2:0] in_latches;
    always_ff @(posedge clk)
        if (rst) begin
            in_latches <= '0;
        end else begin
            in_latches <= in_latches + 3'(row_ready) - 3'(link_free);
            assert (in_latches + 3'(row_ready) - 3'(link_free) <= 3'd2);
            assert (!link_free || in_latches != '0);
            assert (!transfer || channels_are_over);
            assert (!unused_overflow);
        end
`endif
endmodule
