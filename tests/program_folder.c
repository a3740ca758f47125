/* program_folder.c: a folder and expectations for tests of the program.
 * SPDX-License-Identifier: MIT */
#include "tests/program_folder.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "tests/small_scene.h"

char *folder;

int make_test_folder(void **state)
{
    (void)state;
    folder = make_folder();
    return 0;
}

int make_scene_folder(void **state)
{
    make_test_folder(state);
    write_text(in_folder(folder, "scene.gltf"), small_scene);
    return 0;
}

int remove_test_folder(void **state)
{
    (void)state;
    remove_folder(folder);
    return 0;
}

void program_run_check(const program_run *run, int status, const char *in_out, const char *in_err)
{
    if (run->status != status || !strstr(run->out, in_out) || !strstr(run->err, in_err))
        fail_msg("status %d (expected %d)\nstdout, expected `%s`:\n%s\nstderr, expected `%s`:\n%s", run->status, status,
                 in_out, run->out, in_err, run->err);
}

void expect_run(program_run run, int status, const char *in_err)
{
    program_run_check(&run, status, "", in_err);
    program_run_free(&run);
}
