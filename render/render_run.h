/* render_run.h: one render under way: what render.c's passes and crew.c's shared ones have in common.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "render/path.h"
#include "render/thread_pool.h"
#include "render/tile_plan.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What a thread has to itself; padded so that two threads' counts do not share a cache line. */
typedef struct worker {
    path_batch *batch;
    path_counts counts;
    char padding[64];
} worker;

typedef struct job {
    path_context context;
    tile_plan plan;
    uint32_t target; /* this pass ends when each pixel has so many */
    worker *workers;
    uint32_t n_workers;
    uint64_t n_samples; /* of all pixels; atomic */
} job;

/* One call's way through the passes. */
typedef struct run {
    job *job;
    const render_settings *settings;
    double start, start_cpu;     /* of this call [s] */
    double seconds, cpu_seconds; /* of the calls before */
    uint64_t n_samples;          /* of the calls before */
    double told, saved;          /* when progress was last reported and the state last saved */
    uint64_t n_left;             /* samples that noise target and limit still ask for, when n_samples_then were done */
    uint64_t n_samples_then;
    bool is_wanted; /* nobody has asked for the end */
} run;

/* Between two reports of progress [s]. */
#define PROGRESS_INTERVAL 0.1

double run_now(void); /* [s] */

/* Samples [begin, end) of each pixel of a tile, counted from the first of the share. */
void job_run_tile(job *j, uint32_t piece, uint32_t begin, uint32_t end, uint32_t thread);

/* What the film tells, when all there is has been added to it: passes behind it, noise, what is left to do. */
void run_look(run *u);

/* Reports progress; takes a request for the end. */
void run_tell(run *u);

/* Brings the state's figures up to date; no thread may be at work. */
void run_collect(const run *u);

bool run_is_save_due(const run *u);

/* Whether an end is reached between passes. */
bool run_is_over(const run *u);

#ifdef __cplusplus
}
#endif
