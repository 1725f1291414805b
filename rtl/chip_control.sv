// Captures: start, stop, single shot, swap of the banks, and what is counted (docs/chip_registers.md,
// CONTROL, STATUS and the counters). While no capture runs, the core is held in reset.
module chip_control (
    input  logic        clk,
    input  logic        rst,
    input  logic        control_write,
    input  logic [2:0]  control,      // SWAP, STOP, START
    input  logic [31:0] slots,        // of a capture; 0: until STOP
    input  logic        can_run,      // the settings are within their limits
    input  logic [1:0]  can_use,      // those of a bank
    input  logic        drops,
    output logic        refused,      // a command is
    output logic        is_running,
    output logic        is_exposing,
    output logic        active_bank,
    output logic        swap_pending,
    output logic        core_rst,
    output logic        stops,

    input  logic        slot_start,
    input  logic        is_swapping,
    input  logic        is_over,
    input  logic        is_idle,
    input  logic        packet_valid,
    input  logic [1:0]  packet_flags,  // dropped, overrun
    input  logic [31:0] packet_samples,
    output logic [31:0] slot_count,
    output logic [31:0] overrun_count,
    output logic [31:0] dropped_count,
    output logic [31:0] packet_count,
    output logic [31:0] sample_count,
    output logic [31:0] swap_slot
);
    logic wants_start, wants_swap, may_start, may_swap, has_begun, stop_wanted;

    assign wants_start = control_write && control[0];
    assign wants_swap  = control_write && control[2];
    assign may_start   = !is_running && can_run && can_use[active_bank ^ wants_swap];
    assign may_swap    = !is_running || (!swap_pending && !drops && can_use[!active_bank]);
    assign refused     = (wants_start && !may_start) || (wants_swap && !may_swap);
    assign core_rst    = rst || !is_running;
    assign is_exposing = has_begun && !is_over;
    assign stops       = stop_wanted || (slots != '0 && slot_count == slots);

    always_ff @(posedge clk)
        if (rst) begin
            is_running <= 1'b0;
            has_begun <= 1'b0;
            stop_wanted <= 1'b0;
            active_bank <= 1'b0;
            swap_pending <= 1'b0;
        end else if (!is_running) begin
            is_running <= wants_start && may_start;
            has_begun <= 1'b0;
            stop_wanted <= 1'b0;
            active_bank <= active_bank ^ wants_swap;
        end else begin
            is_running <= !is_idle;
            has_begun <= has_begun || slot_start;
            stop_wanted <= stop_wanted || (control_write && control[1]);
            active_bank <= active_bank ^ (slot_start && is_swapping);
            swap_pending <= !is_idle && !(slot_start && is_swapping) &&
                            (swap_pending || (wants_swap && may_swap));
        end

    always_ff @(posedge clk)
        if (rst || (wants_start && may_start)) begin
            slot_count <= '0;
            overrun_count <= '0;
            dropped_count <= '0;
            packet_count <= '0;
            sample_count <= '0;
            swap_slot <= '0;
        end else begin
            slot_count <= slot_count + 32'(slot_start);
            if (slot_start && is_swapping) swap_slot <= slot_count;
            if (packet_valid) begin
                overrun_count <= overrun_count + 32'(packet_flags[0]);
                dropped_count <= dropped_count + 32'(packet_flags[1]);
                packet_count <= packet_count + 1'b1;
                sample_count <= sample_count + packet_samples;
            end
        end
endmodule
