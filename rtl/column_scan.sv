// The columns of a row through parallel lanes, each of which finds its next due column within a
// clock. Column c belongs to lane c mod LANES. The channels of the link are lanes, and the ADCs.
//
// In the clock of `start` and then every `clocks` clocks (>= 1) each lane begins its next one of
// `columns`: its bit of `begun` is set for that clock. `is_over` holds from the clock in which the
// time of the last column has ended, at least a clock after `start`, until the next start.
module column_scan #(
    parameter int COLS = 8,
    parameter int LANES = 2,
    parameter int CLOCK_BITS = 16
) (
    input  logic                  clk,
    input  logic                  rst,
    input  logic                  start,
    input  logic [COLS-1:0]       columns,
    input  logic [CLOCK_BITS-1:0] clocks,
    output logic [COLS-1:0]       begun,
    output logic                  is_over
);
    localparam int PER_LANE = COLS / LANES;

    logic [COLS-1:0] waiting, pending, first;
    logic [CLOCK_BITS-1:0] left;  // clocks of the columns under way
    logic begins;

    assign pending = start ? columns : waiting;
    assign begins  = (start || left == '0) && pending != '0;
    assign begun   = begins ? first : '0;
    assign is_over = waiting == '0 && left == '0;

    for (genvar lane = 0; lane < LANES; lane = lane + 1) begin : g_lane
        logic [PER_LANE-1:0] lane_pending, lane_first;
        for (genvar i = 0; i < PER_LANE; i = i + 1) begin : g_column
            assign lane_pending[i] = pending[i*LANES+lane];
            assign first[i*LANES+lane] = lane_first[i];
        end
        next_due #(.WIDTH(PER_LANE)) u_next (
            .pending(lane_pending),
            .first(lane_first)
        );
    end

    always_ff @(posedge clk)
        if (rst) begin
            waiting <= '0;
            left <= '0;
        end else begin
            waiting <= pending & ~begun;
            if (begins) left <= clocks - 1'b1;
            else if (left != '0) left <= left - 1'b1;
        end

`ifdef STIPPLE_ASSERT
    // Each column of a row begins once, columns of a lane one after another.
    logic [COLS-1:0] wanted, had;
    logic has_row;
    always_ff @(posedge clk)
        if (rst) begin
            wanted <= '0;
            had <= '0;
            has_row <= 1'b0;
        end else begin
            wanted <= start ? columns : wanted;
            had <= (start ? '0 : had) | begun;
            has_row <= has_row || start;
            assert (!start || is_over);
            assert ((begun & ~(start ? columns : wanted)) == '0);
            assert (start || (begun & had) == '0);
            assert (!is_over || had == wanted);
            for (int i = 0; i < PER_LANE; i = i + 1)
                for (int j = 0; j < i; j = j + 1) 
                    assert ((begun[i*LANES+:LANES] & begun[j*LANES+:LANES]) == '0);
        end
`endif
endmodule
