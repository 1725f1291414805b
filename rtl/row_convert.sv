// The column side of a row: selection, settling, conversion, rest.
//
//     select       the row is on the column lines, after `select_clocks` its columns settle
//     convert      settling begins
//     convert_end  the ADCs are done, in this clock they present the DN of the row
//     row_ready    `rest_clocks` later: the row may be transferred, the next one selected
//
// Each of them is a strobe of one clock. Without clocks between them they coincide, except that a
// row takes at least a clock from `select` to `convert_end`, even without skipped rows.
// Precondition of `select`: is_free.
// ADC c mod (COLS / COLUMNS_PER_ADC) converts column c, its columns one after another.
module row_convert #(
    parameter int COLS = 8,
    parameter int COLUMNS_PER_ADC = 1,
    parameter int CLOCK_BITS = 32
) (
    input  logic                  clk,
    input  logic                  rst,
    input  logic                  select,
    input  logic [CLOCK_BITS-1:0] select_clocks,   // of the row selected now
    input  logic [CLOCK_BITS-1:0] settle_clocks,   // of the row selected now
    input  logic [COLS-1:0]       columns,         // that the ADCs convert of it
    input  logic [CLOCK_BITS-1:0] adc_clocks,
    input  logic [CLOCK_BITS-1:0] rest_clocks,
    output logic                  is_free,
    output logic                  convert,
    output logic                  converts_selected,  // of the row selected now
    output logic                  convert_end,
    output logic [CLOCK_BITS-1:0] convert_clocks,  // settling and conversion, at convert_end
    output logic                  row_ready
);
    logic is_busy, is_resting, adc_began;
    logic [CLOCK_BITS-1:0] age, held_age;  // clocks since the selection
    logic [CLOCK_BITS-1:0] to_convert, held_to_convert, to_adc, held_to_adc, rested;
    logic [COLS-1:0] held_columns;
    logic [COLS-1:0] unused_begun;
    logic converts_held, adc_start, adc_starts_later, adc_is_over;

    assign age        = select ? '0 : held_age;
    assign to_convert = select ? select_clocks : held_to_convert;
    assign to_adc     = select ? select_clocks + settle_clocks : held_to_adc;

    assign converts_selected = select && select_clocks == '0;
    assign converts_held     = is_busy && held_age == held_to_convert;

    assign convert          = converts_selected || converts_held;
    assign adc_start        = select ? to_adc == '0 : adc_starts_later;
    assign adc_starts_later = is_busy && held_age == held_to_adc;  // than the selection
    assign convert_end      = adc_clocks == '0 ? adc_starts_later : adc_began && adc_is_over;
    assign convert_clocks   = held_age - held_to_convert;
    assign row_ready        = rest_clocks == '0 ? convert_end : is_resting && rested == rest_clocks;
    assign is_free          = (!is_busy && !is_resting) || row_ready;

    column_scan #(.COLS(COLS), .LANES(COLS / COLUMNS_PER_ADC), .CLOCK_BITS(CLOCK_BITS)) u_adcs (
        .clk, .rst,
        .start(adc_start && adc_clocks != '0),
        .columns(select ? columns : held_columns),
        .clocks(adc_clocks),
        .begun(unused_begun),
        .is_over(adc_is_over)
    );

    always_ff @(posedge clk)
        if (rst) begin
            is_busy <= 1'b0;
            is_resting <= 1'b0;
            adc_began <= 1'b0;
        end else begin
            is_busy <= select || (is_busy && !convert_end);
            is_resting <= rest_clocks != '0 && (convert_end || (is_resting && !row_ready));
            adc_began <= adc_start || (adc_began && !convert_end);
        end

    always_ff @(posedge clk) begin
        held_age <= age + 1'b1;
        held_to_convert <= to_convert;
        held_to_adc <= to_adc;
        rested <= convert_end ? CLOCK_BITS'(1) : rested + 1'b1;
        if (select) held_columns <= columns;
    end

`ifdef STIPPLE_ASSERT
    logic has_row;  // that is selected and not ready yet
    always_ff @(posedge clk)
        if (rst) begin
            has_row <= 1'b0;
        end else begin
            has_row <= select || (has_row && !row_ready);
            assert (!select || !has_row || row_ready);
            assert (!convert_end || is_busy);
            assert (!row_ready || has_row);
        end
`endif
endmodule
