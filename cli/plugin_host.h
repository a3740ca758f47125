/* plugin_host.h: reflection models from shared libraries (include/facet/plugin.h), and the watch over their calls.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "facet/plugin.h"
#include "verify/verify.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { PLUGIN_PARAMETERS = 32 };

/* What a plugin is doing, in memory that the process which watches it shares. */
typedef struct plugin_watch {
    volatile uint64_t calls;       /* so far; grows while the plugin returns from its functions */
    const char *volatile path;     /* of the plugin that is at work: a text from before plugin_supervise */
    const char *volatile function; /* "eval", ... while one runs; NULL between them */
    const char *volatile check;    /* that the call is for */
    volatile bool has_finished;    /* the work returned, whatever its status */
} plugin_watch;

typedef struct plugin {
    const char *path;
    const facet_plugin *model;
    plugin_watch *watch;
    double values[PLUGIN_PARAMETERS];
    bool is_fixed[PLUGIN_PARAMETERS]; /* by the user */
} plugin;

/* Loads the library, checks what it describes and sets the parameters named in texts[n], each NAME=VALUE; refers to
 * path.  Returns 0, or the exit status of the error that it printed. */
int plugin_open(const char *path, const char *const *texts, size_t n, plugin_watch *watch, plugin *p);

/* The model at p->values, which is referred to. */
verify_subject plugin_subject(const plugin *p);

/* Runs work(context, watch) in a process of its own and returns its exit status; if the process dies, a plugin ends
 * it, or a function of a plugin does not return for `patience` seconds, prints why and returns EXIT_INPUT.
 * path: of the (first) plugin. */
int plugin_supervise(const char *path, double patience, int (*work)(void *context, plugin_watch *watch), void *context);

#ifdef __cplusplus
}
#endif
