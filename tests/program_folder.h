/* program_folder.h: the folder in which a test program runs facet, and what it expects of a run.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "tests/run_program.h"

/* Between the setup and the teardown of cmocka's group. */
extern char *folder;
int make_test_folder(void **state);
int make_scene_folder(void **state); /* ... with scene.gltf, the scene of small_scene.h */
int remove_test_folder(void **state);

/* Runs facet there with these arguments. */
#define RUN(...) run_program(folder, NULL, NULL, (const char *const[]){FACET_PROGRAM, __VA_ARGS__, NULL})

/* Fails the test unless the run ended with this status, and these texts are in what it printed. */
void program_run_check(const program_run *run, int status, const char *in_out, const char *in_err);
/* The same, with what is printed to stderr alone; frees the run. */
void expect_run(program_run run, int status, const char *in_err);
