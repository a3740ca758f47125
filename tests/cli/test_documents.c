/* test_documents.c: what README.md and docs/ show is what happens.
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
#include <glob.h>

#include "io/json.h"
#include "plot/canvas.h"
#include "tests/run_program.h"

static const char *const documents[] = {"/README.md", "/docs/*.md", "/docs/models/*.md"};

/* All files of these patterns. */
static glob_t files_of(const char *const *patterns, size_t n)
{
    glob_t found = {0};
    for (size_t i = 0; i < n; i++) {
        char pattern[1024];
        snprintf(pattern, sizeof pattern, "%s%s", FACET_SOURCE_DIR, patterns[i]);
        assert_int_equal(glob(pattern, i ? GLOB_APPEND : 0, NULL, &found), 0);
    }
    return found;
}

/* The next block between ```language and ``` lines; a 0 takes the place of the closing line.  *rest is what follows.
 * NULL if there is none. */
static char *next_block(char **rest, const char *language)
{
    char opening[32];
    snprintf(opening, sizeof opening, "\n```%s\n", language);
    char *block = strstr(*rest, opening);
    if (!block) return NULL;
    block += strlen(opening);
    char *end = strncmp(block, "```", 3) == 0 ? block : strstr(block, "\n```");
    assert_non_null(end);
    end += *end == '\n';
    *end = 0;
    *rest = end + 1;
    return block;
}

typedef void block_check(const char *file, char *block);

/* Checks all blocks of a language in all documents; gives their number. */
static size_t each_block(const char *language, block_check *check)
{
    glob_t files = files_of(documents, sizeof documents/sizeof *documents);
    size_t n = 0;
    for (size_t i = 0; i < files.gl_pathc; i++) {
        char *text = read_bytes(files.gl_pathv[i], NULL), *rest = text;
        assert_non_null(text);
        for (char *block; (block = next_block(&rest, language)) != NULL; n++) check(files.gl_pathv[i], block);
        free(text);
    }
    globfree(&files);
    return n;
}

/* Runs one line of a shell in an empty folder; what it prints on stdout is `shown`. */
static void check_command(const char *file, const char *line, const char *shown, size_t length)
{
    char *folder = make_folder(), command[2048];
    snprintf(command, sizeof command, "PATH=\"$(dirname '%s'):$PATH\"; %s", FACET_PROGRAM, line);
    program_run run = run_program(folder, NULL, NULL, (const char *const[]){"/bin/sh", "-c", command, NULL});
    if (run.status != 0 || *run.err || strlen(run.out) != length || memcmp(run.out, shown, length) != 0)
        fail_msg("%s: $ %s\nprints (status %d)\n%s%s", file, line, run.status, run.out, run.err);
    program_run_free(&run);
    remove_folder(folder);
}

/* False in a build without Cairo. */
static int can_draw(void)
{
    canvas *page;
    if (canvas_create(CANVAS_SVG, 100, 100, 10, &page, NULL)) return 0;
    canvas_destroy(page);
    return 1;
}

/* Each line `$ command`; what follows, up to the next one, is its whole stdout. */
static void check_console(const char *file, char *block)
{
    char *p = block;
    do {
        if (strncmp(p, "$ ", 2) != 0) fail_msg("%s: no command: %s", file, p);
        char *output = strchr(p, '\n');
        assert_non_null(output);
        *output++ = 0;
        const char *next = strncmp(output, "$ ", 2) == 0 ? output : strstr(output, "\n$ ");
        const size_t length = !next ? strlen(output) : (size_t)(next - output) + (*next == '\n');
        if (can_draw() || strncmp(p, "$ facet plot ", 13) != 0) check_command(file, p + 2, output, length);
        p = output + length;
    } while (*p);
}

/* Code is that of an example, which is built and run, without its opening comment. */
static void check_code(const char *file, char *block)
{
    static const char *const examples[] = {"/examples/*.c"};
    glob_t files = files_of(examples, 1);
    int is_found = 0;
    for (size_t i = 0; i < files.gl_pathc; i++) {
        char *example = read_bytes(files.gl_pathv[i], NULL);
        assert_non_null(example);
        const char *code = strstr(example, "#include");
        is_found |= code && strcmp(code, block) == 0;
        free(example);
    }
    globfree(&files);
    if (!is_found) fail_msg("%s: this is not the code of any example:\n%s", file, block);
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
    assert_true(each_block("console", check_console) >= 10);
}

static void code_is_that_of_an_example(void **state)
{
    (void)state;
    assert_true(each_block("c", check_code) >= 1);
}

static void json_is_json(void **state)
{
    (void)state;
    assert_true(each_block("json", check_json) >= 2);
}

/* A block of another language would be shown unchecked.  python/tests/test_python_documents.py runs those of Python. */
static void no_block_is_left_out(void **state)
{
    (void)state;
    static const char *const languages[] = {"console", "c", "json", "sh", "text", "python"};
    glob_t files = files_of(documents, sizeof documents/sizeof *documents);
    for (size_t i = 0; i < files.gl_pathc; i++) {
        char *text = read_bytes(files.gl_pathv[i], NULL);
        assert_non_null(text);
        size_t n_fences = 0, n_known = 0;
        for (const char *p = text; (p = strstr(p, "\n```")) != NULL; p += 4) n_fences++;
        for (size_t k = 0; k < sizeof languages/sizeof *languages; k++) {
            char *copy = strdup(text), *rest = copy;
            while (next_block(&rest, languages[k])) n_known++;
            free(copy);
        }
        if (n_fences != 2*n_known) fail_msg("%s: a block in none of the languages", files.gl_pathv[i]);
        free(text);
    }
    globfree(&files);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(commands_print_what_is_shown),
        cmocka_unit_test(code_is_that_of_an_example),
        cmocka_unit_test(json_is_json),
        cmocka_unit_test(no_block_is_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
