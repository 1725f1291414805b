/* Speaks the protocol of docs/chip.md with a program that it starts: stipple chip, or a simulation.
 */
#include "pipe_bus.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bus.h"

static FILE* requests;
static FILE* answers;
static pid_t chip;

static void fail(const char* what) {
    fprintf(stderr, "bus: %s\n", what);
    exit(3);
}

void bus_open(char* const command[]) {
    int to_chip[2], from_chip[2];
    if (pipe(to_chip) != 0 || pipe(from_chip) != 0) fail("no pipe");
    chip = fork();
    if (chip < 0) fail("no process");
    if (chip == 0) {
        dup2(to_chip[0], STDIN_FILENO);
        dup2(from_chip[1], STDOUT_FILENO);
        close(to_chip[0]);
        close(to_chip[1]);
        close(from_chip[0]);
        close(from_chip[1]);
        execvp(command[0], command);
        perror(command[0]);
        _exit(127);
    }
    close(to_chip[0]);
    close(from_chip[1]);
    requests = fdopen(to_chip[1], "w");
    answers = fdopen(from_chip[0], "r");
    if (requests == NULL || answers == NULL) fail("no stream");
}

int bus_close(void) {
    int status = 0;
    fclose(requests);
    fclose(answers);
    if (waitpid(chip, &status, 0) < 0 || !WIFEXITED(status)) return 3;
    return WEXITSTATUS(status);
}

/* The answer to the request that was printed. */
static const char* answer(void) {
    static char line[256];
    if (fflush(requests) != 0 || fgets(line, sizeof line, answers) == NULL)
        fail("the chip does not answer");
    if (strncmp(line, "error", 5) == 0) fprintf(stderr, "bus: %s", line);
    return line;
}

uint32_t reg_read(uint32_t address) {
    fprintf(requests, "r 0x%03" PRIX32 "\n", address);
    return (uint32_t)strtoul(answer(), NULL, 16);
}

void reg_write(uint32_t address, uint32_t value) {
    fprintf(requests, "w 0x%03" PRIX32 " 0x%08" PRIX32 "\n", address, value);
    answer();
}

void wait_clocks(uint32_t clocks) {
    fprintf(requests, "t %" PRIu32 "\n", clocks);
    answer();
}
