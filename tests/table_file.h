/* table_file.h: reads the tables of numbers that tests compare with: a header line, then fields without quotes.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { TABLE_FILE_FIELDS = 16, TABLE_FILE_LINE = 1024 };

typedef struct table_file {
    FILE *file;
    int n_fields, line;
    char names_text[TABLE_FILE_LINE], row_text[TABLE_FILE_LINE];
    char *names[TABLE_FILE_FIELDS], *row[TABLE_FILE_FIELDS];
} table_file;

/* 0 if there is no such file; a file without a header line ends the test. */
int table_file_open(table_file *table, const char *path);

/* Reads the next row; 0 at the end, where the file is closed.  A row with another number of fields ends the test. */
int table_file_next(table_file *table);

/* The field in the column `name` of the row; an unknown column ends the test. */
const char *table_file_text(const table_file *table, const char *name);

/* ... as a number, rounded once; a field that is no number ends the test. */
double table_file_number(const table_file *table, const char *name);

#ifdef __cplusplus
}
#endif
