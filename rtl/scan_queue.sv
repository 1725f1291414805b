// The slots that wait for their scan, in order. A scan that begins after its `limit` would miss the
// deadline of its first row: it is passed over, in no time.
//
// A slot with due rows is pushed when it begins, and is the head in that clock if no other one
// waits. `pop` takes the head. `undecided` is the oldest slot that may still be scanned.
module scan_queue #(
    parameter int DEPTH = 16,  // a power of two
    parameter int SLOT_BITS = 8,
    parameter int NUMBER_BITS = 16,
    parameter int TIME_BITS = 48
) (
    input  logic                   clk,
    input  logic                   rst,
    input  logic [TIME_BITS-1:0]   now,
    input  logic                   push,
    input  logic [SLOT_BITS-1:0]   push_slot,    // of the tables
    input  logic [NUMBER_BITS-1:0] push_number,  // of the slot that begins now or next
    input  logic [TIME_BITS-1:0]   push_limit,   // two's complement
    input  logic                   pop,
    output logic                   valid,
    output logic [SLOT_BITS-1:0]   slot,
    output logic [NUMBER_BITS-1:0] number,
    output logic [TIME_BITS-1:0]   begun,  // when the slot began
    output logic [NUMBER_BITS-1:0] undecided,
    output logic                   overflow
);
    localparam int BITS = $clog2(DEPTH);
    localparam int ITEM_BITS = SLOT_BITS + TIME_BITS;

    logic [ITEM_BITS-1:0] items [0:DEPTH-1];
    logic [NUMBER_BITS-1:0] numbers [0:DEPTH-1];
    logic [TIME_BITS-1:0] limits [0:DEPTH-1];
    logic [BITS:0] pushed, popped, count, late;  // late: passed over now
    logic [BITS-1:0] head;
    logic [DEPTH-1:0] is_late;
    logic is_found;

    assign count = pushed - popped;
    for (genvar i = 0; i < DEPTH; i = i + 1) begin : g_item
        logic [BITS-1:0] at;
        assign at = popped[BITS-1:0] + BITS'(i);
        assign is_late[i] = $signed(limits[at]) < $signed(now);
    end
    always_comb begin
        is_found = 1'b0;
        late = '0;
        for (int i = 0; i < DEPTH; i = i + 1)
            if (!is_found && (BITS + 1)'(i) < count) begin
                if (is_late[i]) late = late + 1'b1;
                else is_found = 1'b1;
            end
    end

    assign head      = popped[BITS-1:0] + late[BITS-1:0];
    assign valid     = is_found || (push && $signed(push_limit) >= $signed(now));
    assign number    = is_found ? numbers[head] : push_number;
    assign undecided = count == '0 ? push_number : numbers[popped[BITS-1:0]];
    assign {slot, begun} = is_found ? items[head] : {push_slot, now};
    assign overflow  = push && count == (BITS + 1)'(DEPTH) && late == '0 && !pop;

    always_ff @(posedge clk) begin
        if (push) begin
            items[pushed[BITS-1:0]] <= {push_slot, now};
            numbers[pushed[BITS-1:0]] <= push_number;
            limits[pushed[BITS-1:0]] <= push_limit;
        end
        if (rst) begin
            pushed <= '0;
            popped <= '0;
        end else begin
            pushed <= pushed + (BITS + 1)'(push);
            popped <= popped + late + (BITS + 1)'(pop);
        end
    end
endmodule
