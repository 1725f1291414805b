// The scan of a slot: finds its rows one after another, each within a clock, and selects them as
// early as columns and latches allow. Dark rows come before the others.
//
// A scan begins (`scan_start`) in the clock in which a slot with due rows waits and the scan before
// is over. Rows are selected from select_wait clocks after that on, and transferred from
// transfer_wait on. A row is selected if `may_select`; with it come its place (dark rows are below
// DARK_ROWS, row r is DARK_ROWS + r), the rows skipped since the selection before, and whether it
// is the last one of the scan.
module row_scanner #(
    parameter int ROWS = 8,
    parameter int DARK_ROWS = 2,  // max
    parameter int WAIT_BITS = 40,
    parameter int PLACES = ROWS + DARK_ROWS,
    parameter int PLACE_BITS = $clog2(PLACES + 1)
) (
    input  logic                  clk,
    input  logic                  rst,
    input  logic                  slot_waits,
    input  logic [ROWS-1:0]       slot_rows,
    input  logic [PLACE_BITS-1:0] dark_rows,
    input  logic [WAIT_BITS-1:0]  select_wait,
    input  logic [WAIT_BITS-1:0]  transfer_wait,
    input  logic                  may_select,
    input  logic                  scan_over,
    output logic                  scan_start,
    output logic                  is_reading,  // a scan is under way
    output logic                  may_transfer,
    output logic                  select,
    output logic [PLACE_BITS-1:0] place,
    output logic [PLACE_BITS-1:0] skipped,
    output logic                  is_last
);
    logic is_scanning;
    logic [WAIT_BITS-1:0] age, held_age;  // clocks since the beginning, at most all ones
    logic [PLACES-1:0] pending, held_pending, first, dark;
    logic [PLACE_BITS-1:0] next_place, held_next_place;

    for (genvar i = 0; i < DARK_ROWS; i = i + 1) begin : g_dark
        assign dark[i] = dark_rows >= PLACE_BITS'(DARK_ROWS - i);
    end
    assign dark[PLACES-1:DARK_ROWS] = '0;

    assign scan_start   = slot_waits && (!is_scanning || scan_over);
    assign age          = scan_start ? '0 : held_age;
    assign pending      = scan_start ? (PLACES'(slot_rows) << DARK_ROWS) | dark : held_pending;
    assign next_place   = scan_start ? PLACE_BITS'(DARK_ROWS) - dark_rows : held_next_place;
    assign may_transfer = is_scanning && held_age >= transfer_wait;  // never with scan_start

    next_due #(.WIDTH(PLACES)) u_next (
        .pending,
        .first
    );
    always_comb begin
        place = '0;
        for (int i = 0; i < PLACES; i = i + 1)
            if (first[i]) place = place | PLACE_BITS'(i);
    end

    assign is_reading = scan_start || (is_scanning && !scan_over);
    assign select  = (scan_start || is_scanning) && may_select && pending != '0 &&
                     age >= select_wait;
    assign skipped = place - next_place;
    assign is_last = (pending & ~first) == '0;

    always_ff @(posedge clk)
        if (rst) begin
            is_scanning <= 1'b0;
            held_pending <= '0;
        end else begin
            is_scanning <= is_reading;
            held_pending <= select ? pending & ~first : pending;
        end

    always_ff @(posedge clk) begin
        held_age <= age + WAIT_BITS'(age != '1);
        held_next_place <= select ? place + 1'b1 : next_place;
    end

`ifdef STIPPLE_ASSERT
    // Each row of a slot is selected once, in order, before the scan is over.
    logic [PLACES-1:0] wanted, held_wanted, had, held_had, selected;
    logic [PLACE_BITS-1:0] last;
    assign wanted   = scan_start ? {slot_rows, dark[DARK_ROWS-1:0]} : held_wanted;
    assign had      = scan_start ? '0 : held_had;
    assign selected = select ? PLACES'(1) << place : '0;
    always_ff @(posedge clk)
        if (rst) begin
            held_wanted <= '0;
            held_had <= '0;
        end else begin
            held_wanted <= wanted;
            held_had <= had | selected;
            if (select) begin
                last <= place;
                assert ((selected & wanted) != '0);
                assert ((selected & had) == '0);
                assert (had == '0 || place > last);
                assert (skipped == place - (had == '0 ? PLACE_BITS'(DARK_ROWS) - dark_rows
                                                      : last + 1'b1));
                assert (is_last == ((had | selected) == wanted));
            end
            if (scan_start || (is_scanning && scan_over)) assert (held_had == held_wanted);
        end
`endif
endmodule
