/* test_documents.c: what the documents show is what happens.
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

#include "io/json.h"
#include "plot/canvas.h"
#include "tests/document_blocks.h"
#include "tests/run_program.h"

/* At most so many blocks cannot be run here: they install, take hours, or need another machine. */
enum { MARKS = 16 };

/* Runs one line of a shell in the folder; what it prints on stdout is `shown`. */
static void check_command(const char *folder, const char *file, const char *line, const char *shown, size_t length)
{
    char command[2048];
    snprintf(command, sizeof command, "PATH=\"$(dirname '%s'):$PATH\"; %s", FACET_PROGRAM, line);
    program_run run = run_program(folder, NULL, NULL, (const char *const[]){"/bin/sh", "-c", command, NULL});
    if (run.status != 0 || *run.err || strlen(run.out) != length || memcmp(run.out, shown, length) != 0)
        fail_msg("%s: $ %s\nprints (status %d)\n%s%s", file, line, run.status, run.out, run.err);
    program_run_free(&run);
}

/* False in a build without Cairo. */
static int can_draw(void)
{
    canvas *page;
    if (canvas_create(CANVAS_SVG, 100, 100, 10, &page, NULL)) return 0;
    canvas_destroy(page);
    return 1;
}

/* Each line `$ command`; what follows, up to the next one, is its whole stdout.  The commands of a block share a
 * folder, in which `include` and `examples` are, as in a checkout. */
static void check_console(const char *file, char *block)
{
    char *folder = make_folder(), *p = block;
    check_command(folder, file, "ln -s '" FACET_SOURCE_DIR "/include' '" FACET_SOURCE_DIR "/examples' .", "", 0);
    do {
        if (strncmp(p, "$ ", 2) != 0) fail_msg("%s: no command: %s", file, p);
        char *output = strchr(p, '\n');
        assert_non_null(output);
        *output++ = 0;
        const char *next = strncmp(output, "$ ", 2) == 0 ? output : strstr(output, "\n$ ");
        const size_t length = !next ? strlen(output) : (size_t)(next - output) + (*next == '\n');
        if (can_draw() || strncmp(p, "$ facet plot ", 13) != 0) check_command(folder, file, p + 2, output, length);
        p = output + length;
    } while (*p);
    remove_folder(folder);
}

static void check_json(const char *file, char *block)
{
    json_place root;
    facet_error why = {0};
    if (!json_parse((const unsigned char *)block, strlen(block), &root, &why))
        fail_msg("%s: %s: %s\n%s", file, why.place, why.text, block);
    json_destroy(&root);
}

static void commands_print_what_is_shown(void **state)
{
    (void)state;
    assert_true(each_document_block("console", check_console) >= 10);
}

static void json_is_json(void **state)
{
    (void)state;
    assert_true(each_document_block("json", check_json) >= 2);
}

static size_t n_marks;

/* A block of another language would be shown unchecked.  test_document_code.c runs sh, c, js and glsl,
 * tests/packaging/check_consumers.py CMake, python/tests/test_python_documents.py Python; text is no code. */
static void look_at_fence(const char *file, const char *language, const char *mark)
{
    static const char *const languages[] = {"console", "json", "sh", "c", "js", "glsl", "cmake", "python", "text"};
    int is_known = 0;
    for (size_t i = 0; i < sizeof languages/sizeof *languages; i++) is_known |= strcmp(language, languages[i]) == 0;
    if (!is_known) fail_msg("%s: no test knows blocks of \"%s\"", file, language);
    if (mark) {
        print_message("not run: %s: %s\n", strrchr(file, '/') + 1, mark);
        n_marks++;
    }
}

static void all_blocks_are_checked_but_a_few(void **state)
{
    (void)state;
    n_marks = 0;
    each_document_fence(look_at_fence);
    assert_in_range(n_marks, 1, MARKS);
}

/* Blocks that are only indented are formulas; commands and code would hide among them. */
static void look_at_line(const char *file, const char *line)
{
    static const char *const code[] = {"facet ", "make ", "cc ",  "mpirun ",  "build/",  "tools/", "$ ",
                                       "pip ",   "cmake", "sudo", "#include", "import ", "const "};
    if (strncmp(line, "    ", 4) != 0) return;
    for (size_t i = 0; i < sizeof code/sizeof *code; i++)
        if (strncmp(line + 4, code[i], strlen(code[i])) == 0)
            fail_msg("%s: code outside of a block that names its language: %s", file, line);
}

static void indented_blocks_are_formulas(void **state)
{
    (void)state;
    each_document_line(look_at_line);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(commands_print_what_is_shown),
        cmocka_unit_test(json_is_json),
        cmocka_unit_test(all_blocks_are_checked_but_a_few),
        cmocka_unit_test(indented_blocks_are_formulas),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
