/* report.h: what the program says and how it ends: one kind line per error, one table of exit statuses.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>

#include "facet/facet.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    EXIT_DIFFERS = 1,      /* a check or comparison failed */
    EXIT_USAGE = 2,        /* the command line is wrong */
    EXIT_INPUT = 3,        /* an input is missing, unreadable or invalid */
    EXIT_WORLD = 4,        /* disk full, no memory, no such folder */
    EXIT_INTERRUPTED = 130 /* SIGINT or SIGTERM; what was rendered is saved */
};

/* The statuses above as a paragraph of help. */
extern const char exit_status_help[];

/* What an operation that failed was dealing with: the same facet_status means different things. */
typedef enum origin { FROM_ARGUMENTS, FROM_INPUT, FROM_OUTPUT } origin;

int exit_status(facet_status status, origin from);

/* Prints `facet: error: FILE:PLACE: text` on stderr (file and place may be NULL or empty) and returns
 * status.  Control characters in any part become '?', so that a message stays one line. */
int fail(int status, const char *file, const char *place, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* The same for an error that a library function filled in. */
int fail_with(origin from, const char *file, const facet_error *why);

/* From now on nothing is printed, and the first error's text, without `facet: error: `, is kept in `error`; for a
 * process that another one speaks for.  NULL: prints again. */
void keep_silent(char *error, size_t size);

/* Out of memory, in the program itself. */
int fail_memory(void);

/* `facet: warning: ...` and `facet: note: ...` on stderr. */
void warn(const char *format, ...) __attribute__((format(printf, 1, 2)));
void note(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* `facet: ...` on stderr, of what has been done. */
void tell(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* False once stdout refuses what is written to it: a reason for a long listing to stop. */
bool stdout_is_good(void);

/* Flushes stdout.  Returns status, or EXIT_WORLD if something could not be written; a reader that has
 * gone away (EPIPE) is no cause for a message. */
int finish_stdout(int status);

/* The argument between quotes for a POSIX shell if it needs them.  Returns the length that the whole text
 * has; writes at most size bytes, the closing 0 included. */
size_t shell_quote(char *text, size_t size, const char *argument);

/* "facet" and the arguments, as a shell takes them; the caller frees.  NULL without memory. */
char *quote_command(int argc, char **argv);

/* True if text is NAME.EXTENSION, in any case; extension without the dot. */
bool has_extension(const char *path, const char *extension);

#ifdef __cplusplus
}
#endif
