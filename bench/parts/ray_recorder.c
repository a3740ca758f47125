/* ray_recorder.c: see ray_recorder.h.
 * SPDX-License-Identifier: MIT */
#include "bench/parts/ray_recorder.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bench/parts/build_scene.h"

enum { MOST_RECORDED = 1 << 21, LARGEST_GROUP = 1 << 12 };

ray_log recorded_closest, recorded_shadow;
static bool is_recording;

void __real_tracer_nearest(const tracer *t, size_t n, rays r, bool is_coherent, hits h);
void __real_tracer_blocked(const tracer *t, size_t n, rays r, uint32_t *is_blocked);
void __wrap_tracer_nearest(const tracer *t, size_t n, rays r, bool is_coherent, hits h);
void __wrap_tracer_blocked(const tracer *t, size_t n, rays r, uint32_t *is_blocked);

static rays logged_rays(const ray_log *log, size_t first)
{
    float *const *f = log->fields;
    return (rays){.origin = {f[0] + first, f[1] + first, f[2] + first},
                  .direction = {f[3] + first, f[4] + first, f[5] + first},
                  .t_min = f[6] + first,
                  .t_max = f[7] + first,
                  .seed = log->seeds + first};
}

static void record(ray_log *log, size_t n, rays r, bool is_coherent)
{
    const size_t room = (n + TRACER_LANES - 1)/TRACER_LANES*TRACER_LANES;
    if (n == 0 || log->n + room > MOST_RECORDED) return;
    const float *const from[8] = {r.origin.x,    r.origin.y,    r.origin.z, r.direction.x,
                                  r.direction.y, r.direction.z, r.t_min,    r.t_max};
    for (int k = 0; k < 8; k++) memcpy(log->fields[k] + log->n, from[k], n*sizeof(float));
    memcpy(log->seeds + log->n, r.seed, n*sizeof *r.seed);
    log->groups[log->n_groups++] = (ray_group){log->n, n, is_coherent};
    log->n += room;
}

void __wrap_tracer_nearest(const tracer *t, size_t n, rays r, bool is_coherent, hits h)
{
    if (is_recording) record(&recorded_closest, n, r, is_coherent);
    __real_tracer_nearest(t, n, r, is_coherent, h);
}

void __wrap_tracer_blocked(const tracer *t, size_t n, rays r, uint32_t *is_blocked)
{
    if (is_recording) record(&recorded_shadow, n, r, false);
    __real_tracer_blocked(t, n, r, is_blocked);
}

static void log_create(ray_log *log)
{
    *log = (ray_log){0};
    for (int k = 0; k < 8; k++) log->fields[k] = allocate(MOST_RECORDED, sizeof(float));
    log->seeds = allocate(MOST_RECORDED, sizeof *log->seeds);
    log->groups = allocate(MOST_RECORDED, sizeof *log->groups);
}

static void log_destroy(ray_log *log)
{
    for (int k = 0; k < 8; k++) free(log->fields[k]);
    free(log->seeds);
    free(log->groups);
}

void recorder_start(void)
{
    log_create(&recorded_closest);
    log_create(&recorded_shadow);
    is_recording = true;
}

void recorder_stop(void)
{
    is_recording = false;
}

void recorder_destroy(void)
{
    log_destroy(&recorded_closest);
    log_destroy(&recorded_shadow);
}

double recorder_replay(const tracer *t, const ray_log *log)
{
    static float numbers[3][LARGEST_GROUP];
    static uint32_t words[2][LARGEST_GROUP];
    struct timespec start, end;
    size_t n = 0;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &start);
    for (size_t k = 0; k < log->n_groups; k++) {
        const ray_group g = log->groups[k];
        const rays r = logged_rays(log, g.first);
        n += g.n;
        if (log == &recorded_shadow) __real_tracer_blocked(t, g.n, r, words[0]);
        else
            __real_tracer_nearest(t, g.n, r, g.is_coherent,
                                  (hits){numbers[0], numbers[1], numbers[2], words[0], words[1]});
    }
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &end);
    const double seconds = (double)(end.tv_sec - start.tv_sec) + 1e-9*(double)(end.tv_nsec - start.tv_nsec);
    return n ? 1e9*seconds/(double)n : 0;
}
