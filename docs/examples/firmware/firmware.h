#pragma once

/* Takes a single shot and a capture with a swap; prints what the chip says. Returns 0 if all was
   well. */
int run_firmware(void);
