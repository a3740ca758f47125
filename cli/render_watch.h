/* render_watch.h: `facet render --serve`: the page on which people watch a render.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "cli/render_job.h"

#ifdef __cplusplus
extern "C" {
#endif

/* All functions do nothing for NULL: nobody asked for a page. */
typedef struct render_watch render_watch;

typedef enum watch_wish { WISH_GO_ON, WISH_FINISH, WISH_CANCEL } watch_wish; /* of whoever watches */

/* Starts the server of --serve and tells its address.  Returns 0 or the exit status. */
int watch_start(const render_options *o, render_watch **watch);
void watch_stop(render_watch *watch);

void watch_progress(render_watch *watch, const render_progress *progress);
watch_wish watch_asked(render_watch *watch);

/* Whether it is time for another picture: someone looks, and the last one is old enough. */
bool watch_wants_picture(render_watch *watch);
void watch_show(render_watch *watch, const film *f);

/* The end: what the page says from now on, with the last picture. */
void watch_end(render_watch *watch, const char *phase, const film *f);

/* Whether the server should run on until the program is interrupted. */
void watch_stay(render_watch *watch);

#ifdef __cplusplus
}
#endif
