// column_scan: of any columns, each begins once, one after another in its lane, without a pause, and
// the row is over when the busiest lane is. The assertions of the module itself are proven with it.
module column_scan_proof #(
    parameter int COLS = 6,
    parameter int LANES = 2
) (
    input logic            clk,
    input logic            rst,
    input logic            start,
    input logic [COLS-1:0] columns,
    input logic [1:0]      clocks
);
    logic [COLS-1:0] begun;
    logic is_over;
    logic [2:0] steps, busiest, busiest_now, busiest_held, length;
    logic [1:0] phase, held_clocks;
    logic begins;

    assign busiest_now = start ? busiest : busiest_held;
    assign begins      = phase == '0 && (start ? '0 : steps) < busiest_now;

    column_scan #(.COLS(COLS), .LANES(LANES), .CLOCK_BITS(2)) u_scan (
        .clk, .rst, .start, .columns, .clocks, .begun, .is_over
    );

    initial assume (rst);
    always_comb begin
        assume (clocks != '0);
        if (!rst) assume (!start || is_over);
        if (!start) assume (clocks == held_clocks);
        busiest = '0;
        for (int lane = 0; lane < LANES; lane = lane + 1) begin
            length = '0;
            for (int c = lane; c < COLS; c = c + LANES) length = length + 3'(columns[c]);
            if (length > busiest) busiest = length;
        end
    end

    // `steps`: columns of the busiest lane that have begun; `phase`: clocks since the last one.
    always_ff @(posedge clk) begin
        held_clocks <= clocks;
        if (rst) begin
            steps <= '0;
            busiest_held <= '0;
            phase <= '0;
        end else begin
            assert ((begun != '0) == begins);
            assert (start || is_over == (phase == '0 && steps == busiest_held));
            steps <= (start ? '0 : steps) + 3'(begins);
            busiest_held <= busiest_now;
            phase <= begins || phase != '0 ? (phase + 1'b1 == clocks ? '0 : phase + 1'b1) : '0;
        end
    end
endmodule
