/* harness.h: what the fuzzing programs share: files to read from, commands run in place, checks that abort.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The entry point that libFuzzer, or replay.c, calls. */
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

/* Ends the program, as a failure that is kept, unless it is true. */
void require(bool is_true);
void require_finite(const void *floats, size_t n); /* NULL: there are none */

/* The path of a file in the program's own folder, which is removed at its end; in memory where there is /dev/shm. */
const char *own_path(const char *name);
/* Writes the file, and returns its path. */
const char *write_input(const char *name, const uint8_t *bytes, size_t size);

/* Counts inputs that are taken where most are refused; replay.c fails if a whole corpus is. */
void count_taken(bool is_taken);
extern int n_taken; /* -1 where nobody counts */

/* A copy of exactly so many bytes, so that reading past their end is seen; free it. */
uint8_t *copy_bytes(const uint8_t *bytes, size_t size);

/* Calls a command with its messages and results caught, and checks the contract of all commands: an exit status that
 * is documented; with 2, 3 and 4 one line `facet: error: ...` among whole lines that begin with `facet: `. */
int run_command(int (*run)(int argc, char **argv), int argc, char **argv);
