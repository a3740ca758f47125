/* ray_recorder.h: the rays of a render at the tracer's interface, and how long tracing alone takes for them.
 *
 * The linker puts the recorder between the renderer and the tracer (--wrap; see CMakeLists.txt).  Renders that are
 * recorded run on one thread.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>

#include "render/tracer.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Rays in the groups in which they were traced. */
typedef struct ray_group {
    size_t first, n;
    bool is_coherent;
} ray_group;

typedef struct ray_log {
    float *fields[8];
    uint32_t *seeds;
    ray_group *groups;
    size_t n, n_groups;
} ray_log;

/* Rays towards surfaces, and shadow rays; at most 2^21 of each. */
extern ray_log recorded_closest, recorded_shadow;

void recorder_start(void);
void recorder_stop(void);
void recorder_destroy(void);

/* Traces one of the two logs again, group by group: CPU nanoseconds per ray. */
double recorder_replay(const tracer *t, const ray_log *log);

#ifdef __cplusplus
}
#endif
