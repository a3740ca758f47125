/* error.c: status phrases and filled-in errors.
 * SPDX-License-Identifier: MIT */
#include "error.h"

#include <stdarg.h>
#include <stdio.h>

/* A macro's value as text. */
#define TEXT_OF(number) #number
#define VERSION_TEXT(major, minor, patch) TEXT_OF(major) "." TEXT_OF(minor) "." TEXT_OF(patch)

const char *facet_version(void)
{
    return VERSION_TEXT(FACET_VERSION_MAJOR, FACET_VERSION_MINOR, FACET_VERSION_PATCH);
}

const char *facet_status_string(facet_status status)
{
    switch (status) {
    case FACET_OK: return "success";
    case FACET_BAD_ARGUMENT: return "bad argument";
    case FACET_BAD_SYNTAX: return "bad syntax";
    case FACET_UNKNOWN_NAME: return "unknown name";
    case FACET_BAD_VALUE: return "value out of range";
    case FACET_BAD_FILE: return "damaged or unknown file";
    case FACET_UNSUPPORTED: return "not supported";
    case FACET_NO_MEMORY: return "not enough memory";
    case FACET_IO: return "input/output error";
    }
    return "unknown status";
}

facet_status facet_error_set(facet_error *why, facet_status status, const char *place, const char *format, ...)
{
    if (why) {
        why->status = status;
        snprintf(why->place, sizeof why->place, "%s", place ? place : "");
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(why->text, sizeof why->text, format, arguments);
        va_end(arguments);
    }
    return status;
}
