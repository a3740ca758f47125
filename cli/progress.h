/* progress.h: how far a render is, on stderr: a bar that is redrawn on a terminal, lines elsewhere.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>

#include "render/render.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct progress {
    bool is_quiet, is_terminal;
    bool is_drawn;   /* a bar stands on the last line */
    double fraction; /* shown so far; it never goes back */
    int next_line;   /* the percentage from which the next plain line is due */
} progress;

progress progress_start(bool is_quiet);
void progress_show(progress *p, const render_progress *state);

/* Ends the bar's line, if there is one, so that messages start on their own. */
void progress_end(progress *p);

/* Of work in steps: a line on a terminal's stderr, which the next one replaces; n_done of n are behind it, and `what`
 * is under way.  Nothing elsewhere, or for a single step. */
void progress_show_step(size_t n_done, size_t n, const char *what);
void progress_end_steps(size_t n);

/* A time as people write it: "0.8 s", "42 s", "3:05", "2:03:05". */
void format_duration(double seconds, char *text, size_t size);

#ifdef __cplusplus
}
#endif
