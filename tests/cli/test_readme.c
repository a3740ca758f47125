/* test_readme.c: what README.md shows is what happens.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "tests/run_program.h"

static char *read_readme(void)
{
    char *text = read_bytes(FACET_SOURCE_DIR "/README.md", NULL);
    assert_non_null(text);
    return text;
}

/* Runs each `$ command` of the console block; what follows, up to the next one, is its whole stdout. */
static void commands_print_what_the_readme_shows(void **state)
{
    (void)state;
    static const char opening[] = "```console\n";
    char *folder = make_folder(), *readme = read_readme();
    char *p = strstr(readme, opening);
    assert_non_null(p);
    p += sizeof opening - 1;
    char *end = strstr(p, "```");
    assert_non_null(end);
    *end = 0;
    size_t n = 0;
    while (*p) {
        assert_int_equal(strncmp(p, "$ ", 2), 0);
        char *output = strchr(p, '\n'), command[2048];
        *output++ = 0;
        snprintf(command, sizeof command, "PATH=\"$(dirname '%s'):$PATH\"; %s", FACET_PROGRAM, p + 2);
        char *next = strncmp(output, "$ ", 2) == 0 ? output - 1 : strstr(output, "\n$ ");
        char *stop = next ? next + 1 : end;
        program_run run = run_program(folder, NULL, NULL, (const char *const[]){"/bin/sh", "-c", command, NULL});
        const size_t length = (size_t)(stop - output);
        if (run.status != 0 || strlen(run.out) != length || memcmp(run.out, output, length) != 0)
            fail_msg("%s\nprints (status %d)\n%s%s", p, run.status, run.out, run.err);
        program_run_free(&run);
        p = stop;
        n++;
    }
    assert_true(n >= 5);
    free(readme);
    remove_folder(folder);
}

/* The block of C is the example that is built and run, without its opening comment. */
static void code_is_that_of_the_example(void **state)
{
    (void)state;
    char *readme = read_readme(), *example = read_bytes(FACET_SOURCE_DIR "/examples/first_material.c", NULL);
    assert_non_null(example);
    const char *code = strstr(example, "#include"), *block = strstr(readme, "```c\n");
    assert_non_null(code);
    assert_non_null(block);
    block += strlen("```c\n");
    assert_int_equal(strncmp(block, code, strlen(code)), 0);
    assert_int_equal(strncmp(block + strlen(code), "```", 3), 0);
    free(readme);
    free(example);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(commands_print_what_the_readme_shows),
        cmocka_unit_test(code_is_that_of_the_example),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
