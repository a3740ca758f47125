/* error.h: filling a facet_error.  For facet's own folders; not installed.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "facet/facet.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Fills *why (which may be NULL); `place` and the printf-style text are truncated to fit.  Returns status,
 * so that a failing function ends in `return facet_error_set(...)`. */
facet_status facet_error_set(facet_error *why, facet_status status, const char *place, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

#ifdef __cplusplus
}
#endif
