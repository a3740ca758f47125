/* run_program.h: runs a program in a test and keeps what it printed.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>
#include <sys/types.h>

/* Everything that happened.  status: the exit status, or 128 + the signal that ended it. */
typedef struct program_run {
    int status;
    char *out, *err;
} program_run;

/* A fresh folder for the test's files, removed with all that lies in it by remove_folder.  Ends the test
 * program if it cannot be made. */
char *make_folder(void);
void remove_folder(char *folder);

/* "folder/name"; valid until the fourth next call. */
const char *in_folder(const char *folder, const char *name);

void write_text(const char *path, const char *text);
/* The file's bytes with a 0 behind them; NULL if there is no such file.  The caller frees. */
char *read_bytes(const char *path, size_t *size);

/* Starts argv[0] in `folder` with stdin from `input` (a path, NULL: empty) and its output in files there. */
pid_t start_program(const char *folder, const char *input, const char *out, const char *const *argv);
int wait_for_program(pid_t pid);

/* start and wait.  out: where stdout goes, NULL: it is kept. */
program_run run_program(const char *folder, const char *input, const char *out, const char *const *argv);
void program_run_free(program_run *run);
