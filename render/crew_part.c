/* crew_part.c: units of work and the threads that render them.
 * SPDX-License-Identifier: MIT */
#include "render/crew_part.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* ---- Units --------------------------------------------------------------------------------------------------- */

/* So many units of a pass for each thread, if its samples can be divided, keep all busy to its end. */
enum { UNITS_PER_THREAD = 4 };

facet_status part_plan(crew_part *part, uint32_t n_all_threads)
{
    const job *j = part->run->job;
    const uint32_t n_parts = 1 + (UNITS_PER_THREAD*n_all_threads - 1)/j->plan.n_tiles; /* of each pass */
    uint32_t n_ranges = 0, n_most = 64;
    uint32_t *ends = malloc(n_most*sizeof *ends);
    for (uint32_t begin = 0; ends && begin < j->plan.n_share;) {
        const uint32_t length = tile_plan_pass_end(&j->plan, begin) - begin, n = n_parts < length ? n_parts : length;
        if (n_ranges + n > n_most) {
            n_most = 2*(n_ranges + n);
            uint32_t *const more = realloc(ends, n_most*sizeof *ends);
            if (!more) free(ends);
            ends = more;
        }
        for (uint32_t i = 1; ends && i <= n; i++) ends[n_ranges++] = begin + (uint32_t)((uint64_t)length*i/n);
        begin += length;
    }
    if (!ends) return FACET_NO_MEMORY;
    part->ends = ends;
    part->n_ranges = n_ranges;
    part->n_all_threads = n_all_threads;
    part->n_units = (uint64_t)n_ranges*j->plan.n_tiles;
    return FACET_OK;
}

uint64_t part_units_to(const crew_part *part, uint32_t n)
{
    uint32_t low = 0, high = part->n_ranges; /* the first range that ends beyond n lies in between */
    while (low < high) {
        const uint32_t middle = (low + high)/2;
        if (part->ends[middle] <= n) low = middle + 1;
        else high = middle;
    }
    return (uint64_t)low*part->run->job->plan.n_tiles;
}

static uint32_t tile_of(const crew_part *part, uint64_t unit)
{
    return (uint32_t)(unit%part->run->job->plan.n_tiles);
}

static void run_unit(const crew_part *part, uint64_t unit, uint32_t thread)
{
    job *j = part->run->job;
    const uint32_t range = (uint32_t)(unit/j->plan.n_tiles), i = tile_of(part, unit);
    const uint32_t begin = range ? part->ends[range - 1] : 0, had = part->positions[i];
    if (!j->plan.is_done[i]) job_run_tile(j, i, begin > had ? begin : had, part->ends[range], thread);
}

/* ---- Threads ------------------------------------------------------------------------------------------------- */

void part_push(crew_part *part, uint64_t first, uint32_t n)
{
    pthread_mutex_lock(&part->lock);
    part->spans[part->n_spans++] = (unit_span){first, n};
    part->n_queued += n;
    pthread_cond_broadcast(&part->work);
    pthread_mutex_unlock(&part->lock);
}

/* Takes a unit whose tile no other thread is at, marking that; false if there is none.  The caller holds the lock. */
static bool pop(crew_part *part, uint64_t *unit)
{
    uint32_t i = 0;
    while (i < part->n_spans && part->is_tile_busy[tile_of(part, part->spans[i].first)]) i++;
    if (i == part->n_spans) return false;
    unit_span *s = &part->spans[i];
    *unit = s->first++;
    if (--s->n == 0) memmove(s, s + 1, (--part->n_spans - i)*sizeof *s);
    part->is_tile_busy[tile_of(part, *unit)] = true;
    part->n_queued--;
    part->n_busy++;
    return true;
}

void part_work(void *user, uint32_t piece, uint32_t thread)
{
    crew_part *part = user;
    uint64_t unit;
    (void)piece;
    pthread_mutex_lock(&part->lock);
    for (;;) {
        while (!part->is_over && !pop(part, &unit)) pthread_cond_wait(&part->work, &part->lock);
        if (part->is_over) break;
        if (part->n_queued < part->n_threads) pthread_cond_signal(&part->low);
        pthread_mutex_unlock(&part->lock);
        run_unit(part, unit, thread);
        pthread_mutex_lock(&part->lock);
        part->is_tile_busy[tile_of(part, unit)] = false;
        part->n_busy--;
        if (part->n_queued > 0) pthread_cond_signal(&part->work); /* one may wait for this tile */
        else if (part->n_busy == 0) pthread_cond_signal(&part->low);
    }
    pthread_mutex_unlock(&part->lock);
}

void part_end(crew_part *part)
{
    pthread_mutex_lock(&part->lock);
    part->is_over = true;
    pthread_cond_broadcast(&part->work);
    pthread_mutex_unlock(&part->lock);
}

bool part_is_low(crew_part *part)
{
    pthread_mutex_lock(&part->lock);
    const bool is_low = part->n_queued < part->n_threads && part->n_spans < MOST_SPANS;
    pthread_mutex_unlock(&part->lock);
    return is_low;
}

bool part_is_idle(crew_part *part)
{
    pthread_mutex_lock(&part->lock);
    const bool is_idle = part->n_queued == 0 && part->n_busy == 0;
    pthread_mutex_unlock(&part->lock);
    return is_idle;
}

void part_pause(crew_part *part)
{
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_nsec += 1000000;
    if (until.tv_nsec >= 1000000000) {
        until.tv_sec++;
        until.tv_nsec -= 1000000000;
    }
    pthread_mutex_lock(&part->lock);
    pthread_cond_timedwait(&part->low, &part->lock, &until);
    pthread_mutex_unlock(&part->lock);
}
