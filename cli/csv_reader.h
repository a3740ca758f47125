/* csv_reader.h: numbers from a CSV file with a header line, a row at a time.
 *
 * Columns are found by name and may come in any order, with others beside them; fields are numbers as C
 * writes them, blanks around them do not count, quotes are not understood.  Lines end in LF or CR LF; empty
 * lines and lines that begin with # are skipped.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { CSV_LINE_CAP = 65536, CSV_MAX_COLUMNS = 16, CSV_FIELD_CAP = 64 };

typedef struct csv_reader {
    FILE *stream;
    const char *name;                 /* for messages; "stdin" for `-` */
    size_t line;                      /* of the row last read, from 1 */
    size_t n_columns;                 /* wanted */
    const char *const *columns;       /* their names, borrowed */
    size_t n_words;                   /* of them, the first: may hold words, whose value is 0; set it after csv_open */
    size_t position[CSV_MAX_COLUMNS]; /* of each in the file; (size_t)-1: absent */
    char *text;                       /* the line, CSV_LINE_CAP bytes */
} csv_reader;

/* A row's wanted columns: value, and the text it was written as.  Those of absent columns are 0 and "". */
typedef struct csv_row {
    double values[CSV_MAX_COLUMNS];
    char texts[CSV_MAX_COLUMNS][CSV_FIELD_CAP];
} csv_row;

/* Opens the file, or stdin for "-", and reads the header; the first n_required columns must be there.
 * Returns 0 or the exit status of the error that it printed; close in both cases. */
int csv_open(csv_reader *reader, const char *path, const char *const *columns, size_t n_columns, size_t n_required);
/* *is_end tells that there are no more rows. */
int csv_read(csv_reader *reader, csv_row *row, bool *is_end);
void csv_close(csv_reader *reader);

/* The directions in a row's first six columns, wi_x to wo_z, brought to unit length; an error if one is not within 1e-3
 * of it. */
int csv_directions(const csv_reader *reader, const csv_row *row, double wi[3], double wo[3]);

/* An error at the current line, `FILE:line N: text`; returns EXIT_INPUT. */
int csv_fail(const csv_reader *reader, const char *format, ...) __attribute__((format(printf, 2, 3)));

#ifdef __cplusplus
}
#endif
