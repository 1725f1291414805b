// row_scanner: the assertions of the module, with any rows, waits and pauses. A scan is over when the
// row that was its last one is done.
module row_scanner_proof #(
    parameter int ROWS = 4,
    parameter int DARK_ROWS = 2,
    parameter int PLACE_BITS = 3
) (
    input logic                  clk,
    input logic                  rst,
    input logic                  slot_waits,
    input logic [ROWS-1:0]       slot_rows,
    input logic [PLACE_BITS-1:0] dark_rows,
    input logic [1:0]            select_wait,
    input logic                  may_select,
    input logic                  scan_over
);
    logic scan_start, is_reading, may_transfer, select, is_last, has_ended;
    logic [PLACE_BITS-1:0] place, skipped, held_dark_rows;

    row_scanner #(.ROWS(ROWS), .DARK_ROWS(DARK_ROWS), .WAIT_BITS(2)) u_scanner (
        .clk, .rst, .slot_waits, .slot_rows, .dark_rows, .select_wait, .transfer_wait(select_wait),
        .may_select, .scan_over, .scan_start, .is_reading, .may_transfer, .select, .place, .skipped,
        .is_last
    );

    initial assume (rst);
    always_comb begin
        assume (dark_rows <= PLACE_BITS'(DARK_ROWS) && dark_rows == held_dark_rows);
        assume (!slot_waits || slot_rows != '0);
        assume (!scan_over || has_ended);
    end
    always_ff @(posedge clk) begin
        held_dark_rows <= dark_rows;
        has_ended <= !rst && ((has_ended && !scan_over) || (select && is_last));
    end
endmodule
