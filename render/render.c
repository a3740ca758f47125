/* render.c: passes over the picture, by tiles over threads, until enough samples, time or precision.
 * SPDX-License-Identifier: MIT */
#include "render/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/error.h"
#include "render/path.h"
#include "render/surface.h"
#include "render/thread_pool.h"

/* What a thread has to itself; padded so that two threads' counts do not share a cache line. */
typedef struct worker {
    path_batch *batch;
    path_counts counts;
    char padding[64];
} worker;

typedef struct job {
    path_context context;
    film film;
    uint32_t n_tiles_x;
    uint32_t first_sample, n_samples; /* of this pass */
    worker *workers;
    uint32_t n_workers;
    uint32_t n_tiles_done; /* of this pass; atomic */
} job;

void render_settings_defaults(render_settings *settings)
{
    *settings = (render_settings){.width = 960, .height = 540, .spp = 64, .depth = 8};
}

static double read_clock(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9*(double)t.tv_nsec;
}

static double now(void)
{
    return read_clock(CLOCK_MONOTONIC);
}

/* A thread_pool_job: all samples of this pass in one tile. */
static void run_tile(void *user, uint32_t piece, uint32_t thread)
{
    job *j = user;
    const uint32_t x0 = piece%j->n_tiles_x*TILE_SIZE, y0 = piece/j->n_tiles_x*TILE_SIZE;
    const uint32_t w = (uint32_t)j->film.width, h = (uint32_t)j->film.height;
    const tile where = {x0, y0, x0 + TILE_SIZE < w ? x0 + TILE_SIZE : w, y0 + TILE_SIZE < h ? y0 + TILE_SIZE : h};
    worker *own = &j->workers[thread];
    for (uint32_t s = 0; s < j->n_samples; s++)
        path_batch_run(own->batch, &j->context, where, j->first_sample + s, &j->film, &own->counts);
    __atomic_fetch_add(&j->n_tiles_done, 1, __ATOMIC_RELAXED);
}

static facet_status check_settings(const scene *s, const render_settings *r, facet_error *why)
{
    if (r->width == 0 || r->height == 0 || r->width > 65536 || r->height > 65536)
        return facet_error_set(why, FACET_BAD_VALUE, "size", "%zux%zu; give 1 to 65536 pixels a side", r->width,
                               r->height);
    if (r->crop_w == 0 || r->crop_h == 0 || r->crop_x > r->width || r->crop_w > r->width - r->crop_x ||
        r->crop_y > r->height || r->crop_h > r->height - r->crop_y)
        return facet_error_set(why, FACET_BAD_VALUE, "crop", "%zu,%zu,%zu,%zu does not lie inside %zux%zu", r->crop_x,
                               r->crop_y, r->crop_w, r->crop_h, r->width, r->height);
    if (r->spp == 0 || r->spp > 1u << 24)
        return facet_error_set(why, FACET_BAD_VALUE, "spp", "%u; give 1 to 16777216 samples per pixel", r->spp);
    if (r->depth > 4096) return facet_error_set(why, FACET_BAD_VALUE, "depth", "%u; give 0 to 4096 events", r->depth);
    if (r->n_threads > 1024)
        return facet_error_set(why, FACET_BAD_VALUE, "threads", "%u; give 1 to 1024", r->n_threads);
    if (r->camera >= s->n_cameras)
        return facet_error_set(why, FACET_BAD_VALUE, "camera", "the scene has %zu cameras", s->n_cameras);
    return FACET_OK;
}

static void job_destroy(job *j)
{
    if (j->workers)
        for (uint32_t i = 0; i < j->n_workers; i++) path_batch_destroy(j->workers[i].batch);
    free(j->workers);
    film_destroy(&j->film);
    light_set_destroy((light_set *)j->context.lights);
    surface_set_destroy((surface_set *)j->context.surfaces);
    tracer_destroy((tracer *)j->context.tracer);
}

/* Acceleration structure, light tables, film and workspaces. */
static facet_status job_create(const scene *s, const render_settings *r, uint32_t n_threads, job *j, facet_error *why)
{
    *j = (job){.context = {.scene = s, .camera = &s->cameras[r->camera], .settings = r}};
    j->context.sampler = sampler_create(r->sampler, r->seed, r->spp);
    for (size_t i = 0; i < s->n_materials; i++)
        if (s->materials[i].transmission > 0) j->context.has_mixed_surfaces = true;
    light_set *lights = NULL;
    tracer *built = NULL;
    facet_status status = light_set_create(s, &lights, why);
    if (status == FACET_OK) status = tracer_create(s, r->isa, n_threads, surface_opacity, s, &built, why);
    j->context.lights = lights;
    surface_set *surfaces = NULL;
    if (status == FACET_OK && (status = surface_set_create(s, &surfaces)) != FACET_OK)
        facet_error_set(why, status, "", "no memory for the scene's surfaces");
    j->context.surfaces = surfaces;
    j->context.tracer = built;
    if (status == FACET_OK) {
        status = film_create(r->crop_w, r->crop_h, &j->film);
        j->workers = calloc(n_threads, sizeof *j->workers);
        if (!j->workers) status = FACET_NO_MEMORY;
        for (; status == FACET_OK && j->n_workers < n_threads; j->n_workers++)
            if (!(j->workers[j->n_workers].batch = path_batch_create(s))) status = FACET_NO_MEMORY;
        if (status) facet_error_set(why, status, "size", "no memory for a picture of %zux%zu", r->crop_w, r->crop_h);
        j->n_tiles_x = (uint32_t)((r->crop_w + TILE_SIZE - 1)/TILE_SIZE);
    }
    if (status) job_destroy(j);
    return status;
}

/* Passes grow, so that the first pictures come soon and later ones waste no time on waiting for the last tile. */
static uint32_t pass_length(uint32_t n_done, uint32_t spp)
{
    const uint32_t length = n_done < 4 ? 1 : n_done/4 < 16 ? n_done/4 : 16;
    return length < spp - n_done ? length : spp - n_done;
}

/* What the progress callback is told. */
static render_progress describe(const job *j, const render_settings *r, uint32_t n_tiles, uint32_t n_done,
                                double elapsed, double noise)
{
    const uint64_t n_pixels = (uint64_t)r->crop_w*r->crop_h;
    const uint32_t n_tiles_done = __atomic_load_n(&j->n_tiles_done, __ATOMIC_RELAXED);
    render_progress p = {.samples_total = n_pixels*r->spp, .seconds = elapsed, .noise = noise, .time_left = -1};
    p.samples_done = n_pixels*n_done + n_pixels*j->n_samples*n_tiles_done/n_tiles;
    if (p.samples_done && elapsed > 0) {
        p.samples_per_second = (double)p.samples_done/elapsed;
        p.time_left = (double)(p.samples_total - p.samples_done)/p.samples_per_second;
        if (r->time_limit > 0) p.time_left = fmin(p.time_left, fmax(r->time_limit - elapsed, 0));
        if (r->noise_target > 0 && noise > 0) {
            const double factor = noise/r->noise_target; /* the error falls with the square root of samples */
            p.time_left = fmin(p.time_left, fmax(factor*factor - 1, 0)*elapsed);
        }
    }
    return p;
}

/* Between two reports of progress [s]. */
static const double PROGRESS_INTERVAL = 0.1;

/* Runs passes until an end is reached; returns the samples per pixel of whole passes. */
static uint32_t run_passes(job *j, thread_pool *pool, const render_settings *r, double start, double *noise)
{
    const uint32_t n_tiles = j->n_tiles_x*(uint32_t)((r->crop_h + TILE_SIZE - 1)/TILE_SIZE);
    uint32_t n_done = 0;
    bool is_wanted = true;
    double told = 0; /* when progress was last reported */
    *noise = -1;
    while (is_wanted && n_done < r->spp) {
        j->first_sample = n_done;
        j->n_samples = pass_length(n_done, r->spp);
        j->n_tiles_done = 0;
        thread_pool_start(pool, run_tile, j, n_tiles);
        while (!thread_pool_wait(pool, PROGRESS_INTERVAL))
            if (r->progress) {
                told = now() - start;
                const render_progress p = describe(j, r, n_tiles, n_done, told, *noise);
                if (is_wanted && !r->progress(r->user, &p)) {
                    is_wanted = false;
                    /* The first pass is finished, so that there is a whole picture; later ones need not be. */
                    if (n_done > 0) thread_pool_cancel(pool);
                }
            }
        if (j->n_tiles_done < n_tiles) break; /* a pass cut short: its tiles hold more samples than others */
        n_done += j->n_samples;
        *noise = film_noise(&j->film);
        const double elapsed = now() - start;
        if (r->progress && elapsed - told >= PROGRESS_INTERVAL) { /* short passes end before the wait does */
            told = elapsed;
            j->n_samples = 0;
            const render_progress p = describe(j, r, n_tiles, n_done, elapsed, *noise);
            if (!r->progress(r->user, &p)) is_wanted = false;
        }
        if (r->time_limit > 0 && elapsed >= r->time_limit) is_wanted = false;
        if (r->noise_target > 0 && *noise >= 0 && n_done >= 16 && *noise <= r->noise_target) is_wanted = false;
    }
    if (r->progress) {
        j->n_samples = 0;
        const render_progress p = describe(j, r, n_tiles, n_done, now() - start, *noise);
        r->progress(r->user, &p);
    }
    return n_done;
}

static void collect_counts(const job *j, render_result *result)
{
    for (uint32_t i = 0; i < j->n_workers; i++) {
        const path_counts *c = &j->workers[i].counts;
        result->n_paths += c->n_paths;
        result->n_rays += c->n_rays;
        result->n_shadow_rays += c->n_shadow_rays;
        for (uint32_t k = 0; k < c->n_reported && result->n_bad + k < RENDER_MAX_REPORTED; k++)
            result->bad[result->n_bad + k] = c->bad[k];
        result->n_bad += c->n_bad;
    }
}

facet_status render(const scene *s, const render_settings *settings, render_result *result, facet_error *why)
{
    render_settings r = *settings;
    if (r.crop_w == 0 && r.crop_h == 0) {
        r.crop_w = r.width;
        r.crop_h = r.height;
    }
    facet_status status = check_settings(s, &r, why);
    if (status) return status;
    const uint32_t n_threads = r.n_threads ? r.n_threads : thread_pool_default_size();
    const double begin = now();
    job j;
    status = job_create(s, &r, n_threads, &j, why);
    if (status) return status;
    thread_pool *pool = NULL;
    status = thread_pool_create(n_threads, tracer_prepare_thread, &pool);
    if (status) {
        job_destroy(&j);
        return facet_error_set(why, status, "threads", "cannot start %u threads", n_threads);
    }
    const double start = now(), start_cpu = read_clock(CLOCK_PROCESS_CPUTIME_ID);
    render_result made = {.setup_seconds = start - begin, .isa = tracer_isa(j.context.tracer)};
    made.spp = run_passes(&j, pool, &r, start, &made.noise);
    made.seconds = now() - start;
    made.cpu_seconds = read_clock(CLOCK_PROCESS_CPUTIME_ID) - start_cpu;
    made.is_complete = made.spp == r.spp;
    thread_pool_destroy(pool);
    collect_counts(&j, &made);
    status = film_develop(&j.film, &made.picture);
    job_destroy(&j);
    if (status) return facet_error_set(why, status, "size", "no memory for the finished picture");
    *result = made;
    return FACET_OK;
}

void render_result_destroy(render_result *result)
{
    image_destroy(&result->picture);
}
