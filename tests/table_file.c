/* table_file.c: see table_file.h.
 * SPDX-License-Identifier: MIT */
#include "tests/table_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static int split(char *text, char *fields[TABLE_FILE_FIELDS])
{
    text[strcspn(text, "\r\n")] = 0;
    int n = 0;
    for (char *field = text; field;) {
        if (n == TABLE_FILE_FIELDS) fail_msg("more than %d columns", TABLE_FILE_FIELDS);
        fields[n++] = field;
        field = strchr(field, ',');
        if (field) *field++ = 0;
    }
    return n;
}

int table_file_open(table_file *table, const char *path)
{
    memset(table, 0, sizeof *table);
    table->file = fopen(path, "r");
    if (!table->file) return 0;
    if (!fgets(table->names_text, TABLE_FILE_LINE, table->file)) fail_msg("%s is empty", path);
    table->n_fields = split(table->names_text, table->names);
    table->line = 1;
    return 1;
}

int table_file_next(table_file *table)
{
    if (!fgets(table->row_text, TABLE_FILE_LINE, table->file)) {
        fclose(table->file);
        table->file = NULL;
        return 0;
    }
    table->line++;
    if (split(table->row_text, table->row) != table->n_fields)
        fail_msg("line %d: not %d fields", table->line, table->n_fields);
    return 1;
}

const char *table_file_text(const table_file *table, const char *name)
{
    for (int i = 0; i < table->n_fields; i++)
        if (strcmp(table->names[i], name) == 0) return table->row[i];
    fail_msg("no column is called %s", name);
    return NULL;
}

double table_file_number(const table_file *table, const char *name)
{
    const char *text = table_file_text(table, name);
    char *end;
    const double value = strtod(text, &end);
    if (end == text || *end) fail_msg("line %d: %s is not a number: '%s'", table->line, name, text);
    return value;
}
