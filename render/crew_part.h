/* crew_part.h: one process's part of a shared render: its units of work, its threads, its film's way to the leader.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <pthread.h>

#include "render/crew.h"
#include "render/render_run.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { MOST_SPANS = 16 };

/* Units first .. first + n - 1. */
typedef struct unit_span {
    uint64_t first;
    uint32_t n;
} unit_span;

/* What the leader knows of a rank. */
typedef struct crew_peer {
    uint64_t n_samples; /* rendered since the start */
    uint32_t n_threads;
    bool is_waiting; /* for work */
} crew_peer;

/* Unit number i is tile i mod n_tiles, in the range of samples number i div n_tiles, so that all tiles get their first
 * samples before any gets more. */
struct crew_part {
    const crew *crew;
    run *run;
    struct thread_pool *pool;
    uint32_t *ends;      /* [n_ranges] where each range of samples ends; a pass ends with one, too */
    uint32_t *positions; /* [n_tiles] the samples that each tile had at the start */
    uint32_t n_ranges, n_threads, n_all_threads;
    film_pixel *buffer;            /* [n_buffer] one rank's sums of a block of pixels */
    film_features *feature_buffer; /* likewise; NULL if the film has none */
    size_t n_buffer;
    /* shared with the threads */
    pthread_mutex_t lock;
    pthread_cond_t work, low; /* there are units; there are few */
    unit_span spans[MOST_SPANS];
    uint32_t n_spans, n_queued, n_busy;
    bool *is_tile_busy; /* [n_tiles] a thread adds to it */
    bool is_over;       /* nothing is queued or under way any more */
    /* the leader's */
    uint64_t next, limit, n_units; /* units handed out; that may be; in all */
    crew_peer *peers;              /* [n_ranks] */
    uint32_t n_ready, n_left;      /* ranks with nothing under way; that have ended */
    double looked;                 /* when all films were last added up [s] */
    double looking;                /* how long that took [s] */
};

/* The ranges of samples for so many threads in all.  Memory: FACET_NO_MEMORY. */
facet_status part_plan(crew_part *part, uint32_t n_all_threads);

/* The unit after all of those that render the first n samples. */
uint64_t part_units_to(const crew_part *part, uint32_t n);

/* Puts units into the queue; there is room. */
void part_push(crew_part *part, uint64_t first, uint32_t n);

/* The job of each thread: units from the queue until it is over. */
void part_work(void *user, uint32_t piece, uint32_t thread);
void part_end(crew_part *part);

/* Whether the queue has less than a unit for each thread; whether nothing is queued or under way. */
bool part_is_low(crew_part *part);
bool part_is_idle(crew_part *part);

/* Waits a millisecond, or less until the queue gets low or empty. */
void part_pause(crew_part *part);

/* All ranks together: the films and figures of all others are added to the leader's state, and theirs are empty
 * then.  No thread may be at work. */
void part_add_states(crew_part *part);

#ifdef __cplusplus
}
#endif
