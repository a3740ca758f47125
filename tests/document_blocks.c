/* document_blocks.c: see document_blocks.h.
 * SPDX-License-Identifier: MIT */
#include "document_blocks.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
/* cmocka needs the headers above */
#include <cmocka.h>
#include <glob.h>

#include "run_program.h"

static const char *const documents[] = {"/*.md",          "/docs/*.md",    "/docs/*/*.md",
                                        "/examples/*.md", "/tests/*/*.md", "/tests/*/*/*.md"};

static const char fence[] = "```", mark_begin[] = "<!-- not run: ", mark_end[] = " -->";

/* What a walk over the documents is for; any of them may be NULL. */
typedef struct visitor {
    const char *language; /* of the blocks that `check` gets */
    void (*check)(const char *file, char *text);
    void (*look)(const char *file, const char *language, const char *mark);
    void (*line)(const char *file, const char *line);
    size_t n_checked;
} visitor;

/* Cuts the line that begins at p off, and returns the next one. */
static char *cut_line(char *p)
{
    char *end = strchr(p, '\n');
    if (!end) return p + strlen(p);
    *end = 0;
    return end + 1;
}

/* The reason of a mark, cut out of its line; NULL if the line is none. */
static const char *reason_of(char *line)
{
    const size_t n = sizeof mark_begin - 1;
    char *end = strstr(line, mark_end);
    if (!end || strncmp(line, mark_begin, n) != 0) return NULL;
    *end = 0;
    return line + n;
}

static void visit_block(visitor *v, const char *file, const char *language, const char *mark, char *text)
{
    if (v->look) v->look(file, language, mark);
    if (v->check && !mark && strcmp(language, v->language) == 0) {
        v->check(file, text);
        v->n_checked++;
    }
}

/* The text of a block from p on; its closing fence is cut out, and *rest is what follows. */
static void end_block(const char *file, char *p, char **rest)
{
    char *end = p;
    while (strncmp(end, fence, 3) != 0) {
        end = strchr(end, '\n');
        if (!end) fail_msg("%s: a block has no end", file);
        end++;
    }
    *rest = cut_line(end);
    *end = 0;
}

static void visit_file(visitor *v, const char *file)
{
    char *text = read_bytes(file, NULL);
    assert_non_null(text);
    const char *mark = NULL;
    for (char *line = text, *rest; *line; line = rest) {
        rest = cut_line(line);
        if (strncmp(line, fence, 3) == 0) {
            char *block = rest;
            end_block(file, block, &rest);
            visit_block(v, file, line + 3, mark, block);
            mark = NULL;
            continue;
        }
        if (mark) fail_msg("%s: no block follows the mark \"%s\"", file, mark);
        if (v->line) v->line(file, line);
        mark = reason_of(line);
    }
    free(text);
}

static size_t visit_documents(visitor v)
{
    glob_t found = {0};
    for (size_t i = 0; i < sizeof documents/sizeof *documents; i++) {
        char pattern[1024];
        snprintf(pattern, sizeof pattern, "%s%s", FACET_SOURCE_DIR, documents[i]);
        assert_int_equal(glob(pattern, i ? GLOB_APPEND : 0, NULL, &found), 0);
    }
    for (size_t i = 0; i < found.gl_pathc; i++) visit_file(&v, found.gl_pathv[i]);
    globfree(&found);
    return v.n_checked;
}

size_t each_document_block(const char *language, void (*check)(const char *file, char *text))
{
    return visit_documents((visitor){.language = language, .check = check});
}

void each_document_fence(void (*look)(const char *file, const char *language, const char *mark))
{
    visit_documents((visitor){.look = look});
}

void each_document_line(void (*look)(const char *file, const char *line))
{
    visit_documents((visitor){.line = look});
}
