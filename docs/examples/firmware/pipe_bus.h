/* The bus as text through pipes, for an emulated or simulated chip (docs/chip.md). */
#pragma once

/* Starts a program, `command` as of execvp. Ends this one with a message if that fails. */
void bus_open(char* const command[]);
/* Ends the program, and returns its exit code. */
int bus_close(void);
