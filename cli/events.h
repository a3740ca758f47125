/* events.h: `facet render --events FILE`: what happens, one JSON object a line, for programs that watch a render.
 * docs/reliability.md lists the events and their members.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdio.h>

#include "cli/render_job.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Every function but events_open does nothing without a stream. */
typedef struct event_log {
    FILE *stream; /* NULL: nobody watches */
    const char *path;
    double told;  /* seconds of the render at the last progress event */
    bool is_lost; /* an event could not be written, which was warned of */
} event_log;

/* Appends to the file; "-" is stderr, NULL nothing.  Returns 0 or the exit status. */
int events_open(event_log *log, const char *path);
void events_close(event_log *log);

void events_start(event_log *log, const render_options *o, const render_settings *settings, const render_state *state);
void events_progress(event_log *log, const render_progress *progress); /* at most once a second */
void events_checkpoint(event_log *log, const char *path, const render_state *state, bool is_written);
void events_warning(event_log *log, const char *text);
void events_done(event_log *log, const render_options *o, const render_result *result, int status);

#ifdef __cplusplus
}
#endif
