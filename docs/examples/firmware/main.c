/* firmware -- COMMAND ...: runs the firmware on the chip of a command, such as stipple chip. */
#include <stdio.h>
#include <string.h>

#include "firmware.h"
#include "pipe_bus.h"

int main(int argc, char* argv[]) {
    if (argc < 3 || strcmp(argv[1], "--") != 0) {
        fprintf(stderr, "usage: firmware -- COMMAND ...\n");
        return 2;
    }
    bus_open(argv + 2);
    const int faults = run_firmware();
    const int code = bus_close();
    return faults != 0 ? 1 : code;
}
