/* crew.h: processes that share a render.
 *
 * Each has the whole scene and renders units of work, some samples of each pixel of a tile, into a film of its own.
 * Rank 0, the leader, hands the units out to whoever asks, so that fast ranks do more; now and then, before it saves
 * and at the end, all films are added to its own, which then is that of one process, bit for bit: sums are exact, and
 * what has been handed out when it calls the films in is finished, so that a tile's samples are the first ones of its
 * sequence.  How messages travel is the caller's.  docs/scaling.md tells how far this goes.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "facet/facet.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { CREW_WORDS = 4, CREW_NAME_SIZE = 64 };
#define CREW_NOBODY UINT32_MAX

/* All functions are called from the thread that renders (render_continue), and do not return from a failure. */
typedef struct crew {
    uint32_t rank, n_ranks;
    char name[CREW_NAME_SIZE]; /* of this process's machine, for messages to people */
    void *user;
    /* A short message to a rank; returns before it has arrived.  Messages of one rank to another stay in order. */
    void (*send)(void *user, uint32_t to, const uint64_t words[CREW_WORDS]);
    /* The next short message; false if there is none yet. */
    bool (*receive)(void *user, uint32_t *from, uint64_t words[CREW_WORDS]);
    /* Sends bytes to a rank and waits for bytes from one, at most `most`; either may be CREW_NOBODY.  The other
     * side does the same.  Returns how many came. */
    size_t (*exchange)(void *user, uint32_t to, const void *bytes, size_t n, uint32_t from, void *buffer, size_t most);
} crew;

/* Bytes from the leader to all, who all call this. */
void crew_share(const crew *c, void *bytes, size_t n);

/* The rest is for render.c.  crew_prepare comes first and crew_unprepare last. */
struct run;
struct thread_pool;
typedef struct crew_part crew_part; /* what a process needs for its part */
facet_status crew_prepare(const crew *c, struct run *u, struct thread_pool *pool, crew_part **part);
void crew_unprepare(crew_part *part);

/* Every rank calls it once, whether it is ready (status FACET_OK) or not; the leader fails with a reason for people
 * if some rank is not ready or renders something else, and all others fail with it. */
facet_status crew_agree(const crew *c, crew_part *part, facet_status status, uint64_t identity, const char *isa,
                        facet_error *why);

/* Renders, as the leader or following it, until an end is reached. */
void crew_run(crew_part *part);

#ifdef __cplusplus
}
#endif
