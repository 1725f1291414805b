/* The bus between firmware and chip: implement these for your hardware. */
#pragma once

#include <stdint.h>

/* An access that is an error reads as 0, and sets STIPPLE_ERROR_ACCESS. */
uint32_t reg_read(uint32_t address);
void reg_write(uint32_t address, uint32_t value);
void wait_clocks(uint32_t clocks);
