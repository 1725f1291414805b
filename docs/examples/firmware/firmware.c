/* Firmware of a small chip: sets its timing, fills both banks of the schedule memory, takes a
   single shot, then a capture that goes over from one bank to the other. It knows the chip by its
   registers alone, so it runs on the emulated chip and on the chip in gates. */
#include "firmware.h"

#include <stdint.h>
#include <stdio.h>

#include "bus.h"
#include "chip_registers.h"

enum {
    ID = 0x53504C31,
    POLLS = 1000, /* at most, before the chip counts as stuck */
    POLL_CLOCKS = 100,
    SLOT_CLOCKS = 60,
};

static uint32_t at(uint32_t address, uint32_t place) {
    return address + 4 * place;
}

/* A word of the schedule memory, in parts of 32 bits: bit 0 of a pixel reads it at the end of the
   slot, bit 1, where there is one, opens it. */
static void write_word(uint32_t period, uint32_t slot, uint32_t row) {
    const uint32_t cols = reg_read(STIPPLE_TILE_COLS);
    const uint32_t bits = reg_read(STIPPLE_PIXEL_BITS);
    uint32_t part = 0, used = 0;
    for (uint32_t col = 0; col < cols; ++col) {
        const uint32_t read = (slot + row + col) % period == period - 1;
        const uint32_t pixel = bits == 1 ? read : read | 2;
        for (uint32_t bit = 0; bit < bits; ++bit) {
            part |= (pixel >> bit & 1) << used;
            if (++used < 32) continue;
            reg_write(STIPPLE_MEMORY_DATA, part);
            part = used = 0;
        }
    }
    if (used > 0) reg_write(STIPPLE_MEMORY_DATA, part);
}

/* Exposures of `period` slots, which end one slot later from pixel to pixel. */
static void load_bank(uint32_t bank, uint32_t period) {
    const uint32_t rows = reg_read(STIPPLE_TILE_ROWS);
    reg_write(STIPPLE_MEMORY_ADDRESS, bank << 31);
    for (uint32_t slot = 0; slot < period; ++slot)
        for (uint32_t row = 0; row < rows; ++row) write_word(period, slot, row);
    reg_write(at(STIPPLE_BANK_PERIOD, bank), period);
    reg_write(at(STIPPLE_BANK_OFFSET, bank), 0);
}

static void set_timing(void) {
    reg_write(STIPPLE_ROWS, reg_read(STIPPLE_ARRAY_ROWS));
    reg_write(STIPPLE_COLS, reg_read(STIPPLE_ARRAY_COLS));
    reg_write(STIPPLE_SLOT_CLOCKS, SLOT_CLOCKS);
    reg_write(STIPPLE_BUDGET_CLOCKS, SLOT_CLOCKS);
    reg_write(STIPPLE_ROT_CLOCKS, 3);
    reg_write(STIPPLE_ADC_CLOCKS, 5);
    reg_write(STIPPLE_IO_CLOCKS, 1);
}

/* Waits until these bits of STATUS have this value. 0 if they do not. */
static int wait_for(uint32_t bits, uint32_t value) {
    for (int i = 0; i < POLLS; ++i) {
        if ((reg_read(STIPPLE_STATUS) & bits) == value) return 1;
        wait_clocks(POLL_CLOCKS);
    }
    printf("STATUS is stuck\n");
    return 0;
}

static void print_counters(const char* title) {
    printf("%s: %u slots, %u packets, %u samples, %u overruns, swap at slot %u\n", title,
           (unsigned)reg_read(STIPPLE_SLOT_COUNT), (unsigned)reg_read(STIPPLE_PACKET_COUNT),
           (unsigned)reg_read(STIPPLE_SAMPLE_COUNT), (unsigned)reg_read(STIPPLE_OVERRUN_COUNT),
           (unsigned)reg_read(STIPPLE_SWAP_SLOT));
}

static int single_shot(void) {
    reg_write(STIPPLE_SLOTS, 1);
    reg_write(STIPPLE_CONTROL, STIPPLE_CONTROL_START);
    if (!wait_for(STIPPLE_STATUS_RUNNING, 0)) return 0;
    print_counters("single shot");
    return 1;
}

static int capture_with_swap(void) {
    reg_write(STIPPLE_SLOTS, 0);
    reg_write(STIPPLE_CONTROL, STIPPLE_CONTROL_START);
    if (!wait_for(STIPPLE_STATUS_EXPOSING, STIPPLE_STATUS_EXPOSING)) return 0;
    reg_write(STIPPLE_CONTROL, STIPPLE_CONTROL_SWAP);
    if (!wait_for(STIPPLE_STATUS_SWAP_PENDING, 0)) return 0;
    wait_clocks(10 * SLOT_CLOCKS);
    reg_write(STIPPLE_CONTROL, STIPPLE_CONTROL_STOP);
    if (!wait_for(STIPPLE_STATUS_RUNNING, 0)) return 0;
    print_counters("capture");
    return 1;
}

int run_firmware(void) {
    const uint32_t id = reg_read(STIPPLE_ID);
    if (id != ID) {
        printf("ID is 0x%08X, not 0x%08X\n", (unsigned)id, (unsigned)ID);
        return 1;
    }
    printf("chip: %u x %u pixels, %u channels, %u bits\n", (unsigned)reg_read(STIPPLE_ARRAY_COLS),
           (unsigned)reg_read(STIPPLE_ARRAY_ROWS), (unsigned)reg_read(STIPPLE_CHANNELS),
           (unsigned)reg_read(STIPPLE_BIT_DEPTH));
    if (reg_read(STIPPLE_DEPTH) < 4 || reg_read(STIPPLE_PIXEL_BITS) > 2) {
        printf("this firmware needs 4 slots a bank, and pixels with one store\n");
        return 1;
    }
    set_timing();
    load_bank(0, 4);
    load_bank(1, 2);
    if (!single_shot() || !capture_with_swap()) return 1;
    const uint32_t errors = reg_read(STIPPLE_ERROR);
    printf("bank %u, errors 0x%02X\n",
           (reg_read(STIPPLE_STATUS) & STIPPLE_STATUS_BANK) != 0 ? 1U : 0U, (unsigned)errors);
    return errors != 0;
}
