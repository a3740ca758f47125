/* report.c: errors, warnings, notes and exit statuses.
 * SPDX-License-Identifier: MIT */
#include "report.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

const char exit_status_help[] = "Exit status:\n"
                                "  0    success\n"
                                "  1    a check or comparison failed\n"
                                "  2    wrong usage\n"
                                "  3    an input is missing, unreadable or invalid\n"
                                "  4    the world failed: disk full, no memory, no such folder\n"
                                "  130  interrupted; what was rendered is saved, if there is a sample of each pixel\n";

int exit_status(facet_status status, origin from)
{
    if (status == FACET_OK) return 0;
    if (status == FACET_NO_MEMORY || from == FROM_OUTPUT) return EXIT_WORLD;
    return from == FROM_ARGUMENTS ? EXIT_USAGE : EXIT_INPUT;
}

/* Appends text to line, control characters made visible. */
static void append_clean(char *line, size_t size, const char *text)
{
    size_t n = strlen(line);
    for (; *text && n + 1 < size; text++) {
        const unsigned char c = (unsigned char)*text;
        line[n++] = c < 32 || c == 127 ? '?' : *text;
    }
    line[n] = 0;
}

/* Where the first error goes in a process that another one speaks for; set once, at the start. */
static char *kept_error;
static size_t kept_size;

void keep_silent(char *error, size_t size)
{
    kept_error = error;
    kept_size = size;
    if (error) error[0] = 0;
}

/* One line on stderr in one write, so that lines of several processes do not mix. */
static void say(const char *kind, const char *file, const char *place, const char *text)
{
    enum { TEXT_ROOM = 2048 }; /* for what follows the name of a file, however long that is */
    char line[8192] = "";
    if (!kept_error) snprintf(line, sizeof line, "facet: %s", kind);
    if (file && *file) {
        append_clean(line, sizeof line - TEXT_ROOM, file);
        append_clean(line, sizeof line - 1, ":");
        if (!place || !*place) append_clean(line, sizeof line - 1, " ");
    }
    if (place && *place) {
        append_clean(line, sizeof line - 1, place);
        append_clean(line, sizeof line - 1, ": ");
    }
    append_clean(line, sizeof line - 1, text);
    if (kept_error) {
        if (!kept_error[0] && strcmp(kind, "error: ") == 0) snprintf(kept_error, kept_size, "%s", line);
        return;
    }
    strcat(line, "\n");
    fputs(line, stderr);
}

int fail(int status, const char *file, const char *place, const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    say("error: ", file, place, text);
    return status;
}

int fail_with(origin from, const char *file, const facet_error *why)
{
    const char *text = why->text[0] ? why->text : facet_status_string(why->status);
    return fail(exit_status(why->status, from), file, why->place, "%s", text);
}

int fail_memory(void)
{
    return fail(EXIT_WORLD, NULL, NULL, "not enough memory");
}

void warn(const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    say("warning: ", NULL, NULL, text);
}

void note(const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    say("note: ", NULL, NULL, text);
}

void tell(const char *format, ...)
{
    char text[6000]; /* with a path of any length */
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    say("", NULL, NULL, text);
}

bool stdout_is_good(void)
{
    return !ferror(stdout);
}

int finish_stdout(int status)
{
    const bool was_bad = ferror(stdout);
    const int write_error = errno; /* of the write that failed, where nothing came between */
    if (fflush(stdout) == 0 && !was_bad) return status;
    const int error = was_bad ? write_error : errno;
    if (error == EPIPE) return EXIT_WORLD;
    return fail(EXIT_WORLD, "stdout", NULL, "%s; the output is not complete", strerror(error));
}

size_t shell_quote(char *text, size_t size, const char *argument)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,:=+@%";
    const bool needs_quotes = !*argument || argument[strspn(argument, plain)];
    size_t n = 0;
#define PUT(c) ((void)(n + 1 < size ? text[n] = (c) : 0), n++)
    if (needs_quotes) PUT('\'');
    for (; *argument; argument++) {
        if (*argument == '\'') { /* ends the quotes, adds one of its own, goes on */
            PUT('\'');
            PUT('\\');
            PUT('\'');
        }
        PUT(*argument);
    }
    if (needs_quotes) PUT('\'');
#undef PUT
    if (size) text[n < size ? n : size - 1] = 0;
    return n;
}

char *quote_command(int argc, char **argv)
{
    char nothing;
    size_t size = sizeof "facet";
    for (int i = 0; i < argc; i++) size += shell_quote(&nothing, 0, argv[i]) + 1;
    char *text = malloc(size);
    if (!text) return NULL;
    size_t n = (size_t)snprintf(text, size, "facet");
    for (int i = 0; i < argc; i++) {
        text[n++] = ' ';
        n += shell_quote(text + n, size - n, argv[i]);
    }
    return text;
}

bool has_extension(const char *path, const char *extension)
{
    const char *dot = strrchr(path, '.');
    return dot && dot != path && !strchr(dot, '/') && strcasecmp(dot + 1, extension) == 0;
}
