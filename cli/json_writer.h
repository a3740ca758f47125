/* json_writer.h: one JSON value on a stream, written as it becomes known.
 *
 * Text is made valid UTF-8 (a damaged byte becomes U+FFFD); numbers that JSON cannot hold (NaN, infinite)
 * become null.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct json_writer {
    FILE *stream;
    int depth;
    bool needs_comma;
    bool is_line; /* no line ends inside */
} json_writer;

json_writer json_put_start(FILE *stream);

/* The same for a value on one line. */
json_writer json_put_line_start(FILE *stream);

/* key is NULL for the members of an array and for the value as a whole. */
void json_put_open(json_writer *j, const char *key, char bracket); /* '{' or '[' */
void json_put_close(json_writer *j, char bracket);                 /* '}' or ']' */
void json_put_text(json_writer *j, const char *key, const char *text);
void json_put_number(json_writer *j, const char *key, double number); /* 17 digits at most, fewer if they suffice */
void json_put_integer(json_writer *j, const char *key, uint64_t integer);
void json_put_bool(json_writer *j, const char *key, bool value);
void json_put_numbers(json_writer *j, const char *key, const double *numbers, size_t n);

#ifdef __cplusplus
}
#endif
