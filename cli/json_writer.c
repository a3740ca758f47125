/* json_writer.c: JSON, as RFC 8259 has it.
 * SPDX-License-Identifier: MIT */
#include "json_writer.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

json_writer json_put_start(FILE *stream)
{
    return (json_writer){.stream = stream};
}

json_writer json_put_line_start(FILE *stream)
{
    return (json_writer){.stream = stream, .is_line = true};
}

/* Bytes of the valid UTF-8 sequence at text, 0 if there is none (RFC 3629: no surrogates, no overlong
 * forms, nothing beyond U+10FFFF). */
static int utf8_length(const unsigned char *text)
{
    const unsigned c = text[0];
    if (c < 0x80) return 1;
    const int n = c >= 0xc2 && c < 0xe0 ? 2 : c >= 0xe0 && c < 0xf0 ? 3 : c >= 0xf0 && c < 0xf5 ? 4 : 0;
    for (int i = 1; i < n; i++)
        if ((text[i] & 0xc0) != 0x80) return 0; /* also at the closing 0 */
    if ((c == 0xe0 && text[1] < 0xa0) || (c == 0xed && text[1] >= 0xa0)) return 0;
    if ((c == 0xf0 && text[1] < 0x90) || (c == 0xf4 && text[1] >= 0x90)) return 0;
    return n;
}

static void put_string(json_writer *j, const char *text)
{
    fputc('"', j->stream);
    for (const unsigned char *p = (const unsigned char *)text; *p;) {
        const int n = utf8_length(p);
        if (n == 0) {
            fputs("\xef\xbf\xbd", j->stream);
            p++;
        } else if (*p == '"' || *p == '\\') {
            fprintf(j->stream, "\\%c", *p++);
        } else if (*p < 32 || *p == 127) {
            fprintf(j->stream, "\\u%04x", *p++);
        } else {
            fwrite(p, 1, (size_t)n, j->stream);
            p += n;
        }
    }
    fputc('"', j->stream);
}

/* What stands before a value: comma, new line, key. */
static void begin(json_writer *j, const char *key)
{
    if (j->needs_comma) fputc(',', j->stream);
    if (j->is_line && j->needs_comma) fputc(' ', j->stream);
    if (j->depth > 0 && !j->is_line) fprintf(j->stream, "\n%*s", 2*j->depth, "");
    if (key) {
        put_string(j, key);
        fputs(": ", j->stream);
    }
    j->needs_comma = true;
}

void json_put_open(json_writer *j, const char *key, char bracket)
{
    begin(j, key);
    fputc(bracket, j->stream);
    j->depth++;
    j->needs_comma = false;
}

void json_put_close(json_writer *j, char bracket)
{
    j->depth--;
    if (j->needs_comma && !j->is_line) fprintf(j->stream, "\n%*s", 2*j->depth, "");
    fputc(bracket, j->stream);
    if (j->depth == 0) fputc('\n', j->stream);
    j->needs_comma = true;
}

void json_put_text(json_writer *j, const char *key, const char *text)
{
    begin(j, key);
    put_string(j, text);
}

static void put_number(json_writer *j, double number)
{
    char text[40];
    if (!isfinite(number)) {
        fputs("null", j->stream);
        return;
    }
    for (int digits = 6; digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, number);
        if (strtod(text, NULL) == number) break;
    }
    fputs(text, j->stream);
}

void json_put_number(json_writer *j, const char *key, double number)
{
    begin(j, key);
    put_number(j, number);
}

void json_put_integer(json_writer *j, const char *key, uint64_t integer)
{
    begin(j, key);
    fprintf(j->stream, "%" PRIu64, integer);
}

void json_put_bool(json_writer *j, const char *key, bool value)
{
    begin(j, key);
    fputs(value ? "true" : "false", j->stream);
}

void json_put_numbers(json_writer *j, const char *key, const double *numbers, size_t n)
{
    begin(j, key);
    fputc('[', j->stream);
    for (size_t i = 0; i < n; i++) {
        if (i) fputs(", ", j->stream);
        put_number(j, numbers[i]);
    }
    fputc(']', j->stream);
}
