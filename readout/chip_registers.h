// Registers of the chip (docs/chip_registers.md), in C and C++. scripts/registers writes it from
// rtl/registers.toml.
#pragma once

enum {
    STIPPLE_ID = 0x000,
    STIPPLE_ARRAY_ROWS = 0x004,
    STIPPLE_ARRAY_COLS = 0x008,
    STIPPLE_TILE_ROWS = 0x00C,
    STIPPLE_TILE_COLS = 0x010,
    STIPPLE_DEPTH = 0x014,
    STIPPLE_PIXEL_BITS = 0x018,
    STIPPLE_CHANNELS = 0x01C,
    STIPPLE_BIT_DEPTH = 0x020,
    STIPPLE_DARK_ROWS_MAX = 0x024,
    STIPPLE_CONTROL = 0x040,
    STIPPLE_CONTROL_START = 1 << 0,
    STIPPLE_CONTROL_STOP = 1 << 1,
    STIPPLE_CONTROL_SWAP = 1 << 2,
    STIPPLE_STATUS = 0x044,
    STIPPLE_STATUS_RUNNING = 1 << 0,
    STIPPLE_STATUS_EXPOSING = 1 << 1,
    STIPPLE_STATUS_SWAP_PENDING = 1 << 2,
    STIPPLE_STATUS_BANK = 1 << 3,
    STIPPLE_ERROR = 0x048,
    STIPPLE_ERROR_STREAM = 1 << 0,
    STIPPLE_ERROR_PACKER = 1 << 1,
    STIPPLE_ERROR_TIMERS = 1 << 2,
    STIPPLE_ERROR_SLOTS = 1 << 3,
    STIPPLE_ERROR_NO_TIME = 1 << 4,
    STIPPLE_ERROR_SETUP = 1 << 5,
    STIPPLE_ERROR_ACCESS = 1 << 6,
    STIPPLE_SLOTS = 0x04C,
    STIPPLE_SLOT_COUNT = 0x060,
    STIPPLE_OVERRUN_COUNT = 0x064,
    STIPPLE_DROPPED_COUNT = 0x068,
    STIPPLE_PACKET_COUNT = 0x06C,
    STIPPLE_SAMPLE_COUNT = 0x070,
    STIPPLE_SWAP_SLOT = 0x074,
    STIPPLE_BANK_PERIOD = 0x080,
    STIPPLE_BANK_OFFSET = 0x088,
    STIPPLE_MEMORY_ADDRESS = 0x090,
    STIPPLE_MEMORY_DATA = 0x094,
    STIPPLE_ROWS = 0x0A0,
    STIPPLE_COLS = 0x0A4,
    STIPPLE_DROPS = 0x0A8,
    STIPPLE_SLOT_CLOCKS = 0x0AC,
    STIPPLE_BUDGET_CLOCKS = 0x0B0,
    STIPPLE_ROW_TIMING = 0x0C0,
    STIPPLE_EXPOSES_WHILE_READING = 0x0C4,
    STIPPLE_ROT_CLOCKS = 0x0C8,
    STIPPLE_SKIP_ROW_CLOCKS = 0x0CC,
    STIPPLE_SETTLE_MARGIN = 0x0D0,
    STIPPLE_ADC_CLOCKS = 0x0D4,
    STIPPLE_ADC_SKIP = 0x0D8,
    STIPPLE_BLANKING_CLOCKS = 0x0DC,
    STIPPLE_CLOCKS_PER_COLUMN = 0x0E0,
    STIPPLE_IO_CLOCKS = 0x0E4,
    STIPPLE_HAS_TABLE = 0x0E8,
    STIPPLE_DARK_ROWS = 0x0EC,
    STIPPLE_OVERHEAD_CLOCKS = 0x0F0,
    STIPPLE_OVERHEAD_ROWS = 0x0F4,
    STIPPLE_FULL_ROW_CLOCKS = 0x0F8,
    STIPPLE_LINK_BITS_LOW = 0x100,
    STIPPLE_LINK_BITS_HIGH = 0x104,
    STIPPLE_LINK_RATE_LOW = 0x108,
    STIPPLE_LINK_RATE_HIGH = 0x10C,
    STIPPLE_SETTLE_CLOCKS = 0x140,
    STIPPLE_TABLE_COLS = 0x180,
    STIPPLE_TABLE_CLOCKS = 0x1C0,
};

// X(name, address, count, bits, reset, access, lock) for each register.
// clang-format off
#define STIPPLE_REGISTERS(X) \
    X(ID, 0x000, 1, 32, 0, read, none) \
    X(ARRAY_ROWS, 0x004, 1, 16, 0, read, none) \
    X(ARRAY_COLS, 0x008, 1, 16, 0, read, none) \
    X(TILE_ROWS, 0x00C, 1, 16, 0, read, none) \
    X(TILE_COLS, 0x010, 1, 16, 0, read, none) \
    X(DEPTH, 0x014, 1, 16, 0, read, none) \
    X(PIXEL_BITS, 0x018, 1, 2, 0, read, none) \
    X(CHANNELS, 0x01C, 1, 16, 0, read, none) \
    X(BIT_DEPTH, 0x020, 1, 5, 0, read, none) \
    X(DARK_ROWS_MAX, 0x024, 1, 16, 0, read, none) \
    X(CONTROL, 0x040, 1, 3, 0, write, none) \
    X(STATUS, 0x044, 1, 4, 0, read, none) \
    X(ERROR, 0x048, 1, 7, 0, flags, none) \
    X(SLOTS, 0x04C, 1, 32, 0, both, run) \
    X(SLOT_COUNT, 0x060, 1, 32, 0, read, none) \
    X(OVERRUN_COUNT, 0x064, 1, 32, 0, read, none) \
    X(DROPPED_COUNT, 0x068, 1, 32, 0, read, none) \
    X(PACKET_COUNT, 0x06C, 1, 32, 0, read, none) \
    X(SAMPLE_COUNT, 0x070, 1, 32, 0, read, none) \
    X(SWAP_SLOT, 0x074, 1, 32, 0, read, none) \
    X(BANK_PERIOD, 0x080, 2, 16, 0, both, bank) \
    X(BANK_OFFSET, 0x088, 2, 16, 0, both, bank) \
    X(MEMORY_ADDRESS, 0x090, 1, 32, 0, write, none) \
    X(MEMORY_DATA, 0x094, 1, 32, 0, write, bank) \
    X(ROWS, 0x0A0, 1, 16, 0, both, run) \
    X(COLS, 0x0A4, 1, 16, 0, both, run) \
    X(DROPS, 0x0A8, 1, 1, 0, both, run) \
    X(SLOT_CLOCKS, 0x0AC, 1, 32, 0, both, run) \
    X(BUDGET_CLOCKS, 0x0B0, 1, 32, 0, both, run) \
    X(ROW_TIMING, 0x0C0, 1, 2, 0, both, run) \
    X(EXPOSES_WHILE_READING, 0x0C4, 1, 1, 1, both, run) \
    X(ROT_CLOCKS, 0x0C8, 1, 32, 0, both, run) \
    X(SKIP_ROW_CLOCKS, 0x0CC, 1, 32, 0, both, run) \
    X(SETTLE_MARGIN, 0x0D0, 1, 32, 0, both, run) \
    X(ADC_CLOCKS, 0x0D4, 1, 32, 0, both, run) \
    X(ADC_SKIP, 0x0D8, 1, 1, 0, both, run) \
    X(BLANKING_CLOCKS, 0x0DC, 1, 32, 0, both, run) \
    X(CLOCKS_PER_COLUMN, 0x0E0, 1, 32, 1, both, run) \
    X(IO_CLOCKS, 0x0E4, 1, 32, 0, both, run) \
    X(HAS_TABLE, 0x0E8, 1, 1, 0, both, run) \
    X(DARK_ROWS, 0x0EC, 1, 16, 0, both, run) \
    X(OVERHEAD_CLOCKS, 0x0F0, 1, 32, 0, both, run) \
    X(OVERHEAD_ROWS, 0x0F4, 1, 16, 0, both, run) \
    X(FULL_ROW_CLOCKS, 0x0F8, 1, 32, 0, both, run) \
    X(LINK_BITS_LOW, 0x100, 1, 32, 0, both, run) \
    X(LINK_BITS_HIGH, 0x104, 1, 32, 0, both, run) \
    X(LINK_RATE_LOW, 0x108, 1, 32, 0, both, run) \
    X(LINK_RATE_HIGH, 0x10C, 1, 32, 0, both, run) \
    X(SETTLE_CLOCKS, 0x140, 16, 32, 0, both, run) \
    X(TABLE_COLS, 0x180, 16, 32, 0, both, run) \
    X(TABLE_CLOCKS, 0x1C0, 16, 32, 0, both, run)
// clang-format on
