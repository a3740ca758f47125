/* csv_reader.c: rows of numbers, streamed.
 * SPDX-License-Identifier: MIT */
#include "cli/csv_reader.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "cli/commands.h"
#include "cli/report.h"

static const size_t ABSENT = (size_t)-1;

int csv_fail(const csv_reader *reader, const char *format, ...)
{
    char text[512], place[32];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    snprintf(place, sizeof place, "line %zu", reader->line);
    return fail(EXIT_INPUT, reader->name, place, "%s", text);
}

/* The next line without its end; *is_end if there is none. */
static int read_line(csv_reader *reader, bool *is_end)
{
    size_t n = 0;
    int c;
    reader->line++;
    while ((c = getc_unlocked(reader->stream)) != EOF && c != '\n') {
        if (!c) return csv_fail(reader, "has a zero byte; it is not text");
        if (n + 2 == CSV_LINE_CAP) return csv_fail(reader, "the line is longer than %d bytes", CSV_LINE_CAP - 2);
        reader->text[n++] = (char)c;
    }
    while (n && reader->text[n - 1] == '\r') n--;
    reader->text[n] = 0;
    *is_end = c == EOF && n == 0;
    if (c != EOF || !ferror(reader->stream)) return 0;
    return fail(EXIT_INPUT, reader->name, NULL, "cannot be read: %s", strerror(errno));
}

/* The next line that is neither empty nor a comment, without its end; *is_end if there is none. */
static int next_line(csv_reader *reader, bool *is_end)
{
    for (;;) {
        const int status = read_line(reader, is_end);
        if (status || *is_end || (reader->text[0] && reader->text[0] != '#')) return status;
    }
}

/* The field at *text without blanks around it, ended by 0; *text moves to the next one, or to NULL. */
static char *next_field(char **text)
{
    char *start = *text, *end = start + strcspn(start, ",");
    *text = *end ? end + 1 : NULL;
    while (isspace((unsigned char)*start)) start++;
    while (end > start && isspace((unsigned char)end[-1])) end--;
    *end = 0;
    return start;
}

static int read_header(csv_reader *reader, size_t n_required)
{
    bool is_end;
    const int status = next_line(reader, &is_end);
    if (status) return status;
    if (is_end) return fail(EXIT_INPUT, reader->name, NULL, "is empty; it needs a header line with column names");
    char *text = reader->text;
    if (strncmp(text, "\xef\xbb\xbf", 3) == 0) text += 3; /* a byte order mark */
    char *fields[256];
    size_t n = 0;
    while (text && n < 256) fields[n++] = next_field(&text);
    if (text) return csv_fail(reader, "has more than 256 columns");
    for (size_t i = 0; i < reader->n_columns; i++) {
        const char *similar = NULL;
        reader->position[i] = ABSENT;
        for (size_t k = 0; k < n; k++) {
            if (strcasecmp(fields[k], reader->columns[i]) == 0) similar = fields[k];
            if (strcmp(fields[k], reader->columns[i]) != 0) continue;
            if (reader->position[i] != ABSENT) return csv_fail(reader, "two columns are called `%s`", fields[k]);
            reader->position[i] = k;
        }
        if (reader->position[i] != ABSENT || i >= n_required) continue;
        if (similar) return csv_fail(reader, "no column `%s`; is `%s` meant to be it?", reader->columns[i], similar);
        return csv_fail(reader, "no column `%s`; the header has to name it", reader->columns[i]);
    }
    return 0;
}

int csv_open(csv_reader *reader, const char *path, const char *const *columns, size_t n_columns, size_t n_required)
{
    const bool is_stdin = strcmp(path, "-") == 0;
    *reader = (csv_reader){.name = is_stdin ? "stdin" : path, .n_columns = n_columns, .columns = columns};
    struct stat information;
    if (!is_stdin && stat(path, &information) == 0) {
        if (S_ISDIR(information.st_mode))
            return fail(EXIT_INPUT, path, NULL, "is a folder; name a CSV file, or - for stdin");
        if (!S_ISREG(information.st_mode) && !S_ISFIFO(information.st_mode))
            return fail(EXIT_INPUT, path, NULL,
                        "is neither a regular file nor a pipe; name a CSV file, or - for stdin");
    }
    reader->stream = is_stdin ? stdin : fopen(path, "r");
    if (!reader->stream) return fail(EXIT_INPUT, path, NULL, "cannot be opened: %s", strerror(errno));
    reader->text = malloc(CSV_LINE_CAP);
    if (!reader->text) return fail_memory();
    return read_header(reader, n_required);
}

/* The field as a finite number. */
static int read_number(const csv_reader *reader, const char *column, const char *field, double *value)
{
    char *end;
    *value = strtod(field, &end);
    if (end == field || *end) return csv_fail(reader, "`%.40s` in column %s is not a number", field, column);
    if (!isfinite(*value)) return csv_fail(reader, "`%.40s` in column %s is not finite", field, column);
    return 0;
}

static int read_value(const csv_reader *reader, size_t i, const char *field, csv_row *row)
{
    const char *column = reader->columns[i];
    const int status = i < reader->n_words ? 0 : read_number(reader, column, field, &row->values[i]);
    if (status) return status;
    const size_t length = strlen(field);
    if (length >= CSV_FIELD_CAP)
        return csv_fail(reader, "a field in column %s has more than %d characters", column, CSV_FIELD_CAP - 1);
    memcpy(row->texts[i], field, length + 1);
    return 0;
}

int csv_read(csv_reader *reader, csv_row *row, bool *is_end)
{
    int status = next_line(reader, is_end);
    if (status || *is_end) return status;
    size_t missing = 0;
    for (size_t i = 0; i < reader->n_columns; i++) {
        row->values[i] = 0;
        row->texts[i][0] = 0;
        missing += reader->position[i] != ABSENT;
    }
    char *text = reader->text;
    size_t k = 0;
    for (; text; k++) {
        const char *field = next_field(&text);
        for (size_t i = 0; i < reader->n_columns; i++) {
            if (reader->position[i] != k) continue;
            if ((status = read_value(reader, i, field, row))) return status;
            missing--;
        }
    }
    return missing ? csv_fail(reader, "has only %zu fields; the header promises more", k) : 0;
}

void csv_close(csv_reader *reader)
{
    free(reader->text);
    if (reader->stream && reader->stream != stdin) fclose(reader->stream);
}

int csv_directions(const csv_reader *reader, const csv_row *row, double wi[3], double wo[3])
{
    static const char *const names[] = {"wi", "wo"};
    double *const directions[] = {wi, wo};
    for (int i = 0; i < 2; i++) {
        const char *name = names[i];
        memcpy(directions[i], row->values + 3*i, 3*sizeof *wi);
        if (!make_unit(directions[i]))
            return csv_fail(reader, "(%s_x,%s_y,%s_z) is not a unit vector; its length has to be 1 within 1e-3", name,
                            name, name);
    }
    return 0;
}
