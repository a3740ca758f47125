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
#include "render/tile_plan.h"

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

/* A thread_pool_job: the samples that a tile has not got yet, pass by pass, up to the end of this one. */
static void run_tile(void *user, uint32_t piece, uint32_t thread)
{
    job *j = user;
    const tile where = tile_plan_at(&j->plan, piece);
    worker *own = &j->workers[thread];
    uint32_t i = tile_plan_position(&j->plan, where);
    while (i < j->target && !j->plan.is_done[piece]) {
        const uint32_t begin = i, end = tile_plan_pass_end(&j->plan, i);
        for (; i < end; i++)
            path_batch_run(own->batch, &j->context, where, j->plan.first_sample + i, &j->plan.state->film,
                           &own->counts);
        tile_plan_judge(&j->plan, piece);
        const uint64_t n_pixels = (uint64_t)(where.x1 - where.x0)*(where.y1 - where.y0);
        __atomic_fetch_add(&j->n_samples, n_pixels*(end - begin), __ATOMIC_RELAXED);
    }
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
    if (r->n_shards > r->spp || (r->n_shards && (r->shard == 0 || r->shard > r->n_shards)))
        return facet_error_set(why, FACET_BAD_VALUE, "shard", "%u/%u; give 1 to N of N, and N up to the %u samples",
                               r->shard, r->n_shards, r->spp);
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
    tile_plan_destroy(&j->plan);
    light_set_destroy((light_set *)j->context.lights);
    surface_set_destroy((surface_set *)j->context.surfaces);
    tracer_destroy((tracer *)j->context.tracer);
}

/* Acceleration structure, light tables, film and workspaces. */
static facet_status job_create(const scene *s, const render_settings *r, uint32_t n_threads, render_state *state,
                               job *j, facet_error *why)
{
    *j = (job){
        .context = {.scene = s, .camera = &s->cameras[r->camera], .settings = r, .keeps_features = r->keeps_features}};
    j->context.sampler = sampler_create(r->sampler, r->seed, r->spp);
    for (size_t i = 0; i < s->n_materials; i++)
        if (s->materials[i].transmission > 0) j->context.has_mixed_surfaces = true;
    light_set *lights = NULL;
    tracer *built = NULL;
    facet_status status = light_set_create(s, r->strategy == STRATEGY_MIS, &lights, why);
    if (status == FACET_OK) status = tracer_create(s, r->isa, n_threads, surface_opacity, s, &built, why);
    j->context.lights = lights;
    surface_set *surfaces = NULL;
    if (status == FACET_OK && (status = surface_set_create(s, &surfaces)) != FACET_OK)
        facet_error_set(why, status, "", "no memory for the scene's surfaces");
    j->context.surfaces = surfaces;
    j->context.tracer = built;
    if (status == FACET_OK) {
        status = tile_plan_create(r, state, &j->plan, why);
        state->isa = tracer_isa(built);
        if (status == FACET_OK) j->n_samples = tile_plan_samples(&j->plan);
        j->workers = calloc(n_threads, sizeof *j->workers);
        if (!j->workers) status = FACET_NO_MEMORY;
        for (; status == FACET_OK && j->n_workers < n_threads; j->n_workers++)
            if (!(j->workers[j->n_workers].batch = path_batch_create(s))) status = FACET_NO_MEMORY;
        if (status == FACET_NO_MEMORY)
            facet_error_set(why, status, "size", "no memory for a picture of %zux%zu", r->crop_w, r->crop_h);
    }
    if (status) job_destroy(j);
    return status;
}

/* Between two reports of progress [s]. */
static const double PROGRESS_INTERVAL = 0.1;

/* One call's way through the passes. */
typedef struct run {
    job *job;
    const render_settings *settings;
    double start, start_cpu;     /* of this call [s] */
    double seconds, cpu_seconds; /* of the calls before */
    uint64_t n_samples;          /* of the calls before */
    double told, saved;          /* when progress was last reported and the state last saved */
    double noise;                /* negative while unknown */
    uint64_t n_left;             /* samples that noise target and limit still ask for, when n_samples_then were done */
    uint64_t n_samples_then;
    bool is_wanted; /* nobody has asked for the end */
} run;

/* Asks for an early end if the progress callback does. */
static void tell(run *u)
{
    const render_settings *r = u->settings;
    u->told = now();
    if (!r->progress) return;
    const double elapsed = u->told - u->start, total = u->seconds + elapsed;
    render_progress p = {.samples_done = __atomic_load_n(&u->job->n_samples, __ATOMIC_RELAXED),
                         .samples_total = u->n_samples_then + u->n_left,
                         .seconds = total,
                         .noise = u->noise,
                         .time_left = -1};
    if (p.samples_done > p.samples_total) p.samples_total = p.samples_done;
    if (p.samples_done > u->n_samples && elapsed > 0) {
        p.samples_per_second = (double)(p.samples_done - u->n_samples)/elapsed;
        p.time_left = (double)(p.samples_total - p.samples_done)/p.samples_per_second;
        if (r->time_limit > 0) p.time_left = fmin(p.time_left, fmax(r->time_limit - total, 0));
    }
    if (!r->progress(r->user, &p)) u->is_wanted = false;
}

/* Brings the state's figures up to date; no thread may be at work. */
static void collect(const run *u)
{
    const job *j = u->job;
    render_state *state = j->plan.state;
    state->seconds = u->seconds + now() - u->start;
    state->cpu_seconds = u->cpu_seconds + read_clock(CLOCK_PROCESS_CPUTIME_ID) - u->start_cpu;
    for (uint32_t i = 0; i < j->n_workers; i++) {
        path_counts *c = &j->workers[i].counts;
        state->n_paths += c->n_paths;
        state->n_rays += c->n_rays;
        state->n_shadow_rays += c->n_shadow_rays;
        for (uint32_t k = 0; k < c->n_reported && state->n_bad + k < RENDER_MAX_REPORTED; k++)
            state->bad[state->n_bad + k] = c->bad[k];
        state->n_bad += c->n_bad;
        *c = (path_counts){0};
    }
}

static void save(run *u)
{
    if (!u->settings->save) return;
    collect(u);
    u->settings->save(u->settings->user, u->job->plan.state);
    u->saved = now();
}

static bool is_save_due(const run *u)
{
    return u->settings->save && now() - u->saved >= u->settings->save_interval;
}

/* Renders the tiles that are behind the target; true when all are there or done. */
static bool run_pass(run *u, thread_pool *pool)
{
    job *j = u->job;
    for (;;) {
        const bool has_picture = j->plan.state->spp > 0; /* the first pass is finished, later ones need not be */
        if (tile_plan_least(&j->plan) >= j->target) return true;
        if (!u->is_wanted && has_picture) return false;
        thread_pool_start(pool, run_tile, j, j->plan.n_tiles);
        while (!thread_pool_wait(pool, PROGRESS_INTERVAL)) {
            tell(u);
            if ((!u->is_wanted && has_picture) || is_save_due(u)) thread_pool_cancel(pool);
        }
        if (is_save_due(u)) save(u);
    }
}

/* Brings what is known of the noise up to date, between passes. */
static void look(run *u)
{
    tile_plan_end_pass(&u->job->plan);
    u->noise = film_noise(&u->job->plan.state->film);
    u->n_samples_then = u->job->n_samples;
    u->n_left = tile_plan_samples_left(&u->job->plan);
}

/* Whether an end is reached between passes. */
static bool is_over(const run *u)
{
    const render_settings *r = u->settings;
    const uint32_t spp = u->job->plan.state->spp;
    if (!u->is_wanted || spp == u->job->plan.n_share || tile_plan_is_quiet(&u->job->plan)) return true;
    return r->time_limit > 0 && spp > 0 && u->seconds + now() - u->start >= r->time_limit;
}

/* Runs passes until an end is reached. */
static void run_passes(run *u, thread_pool *pool)
{
    tile_plan *plan = &u->job->plan;
    uint32_t *const spp = &plan->state->spp, least = tile_plan_least(plan), most = tile_plan_most(plan);
    const uint32_t reached = least < most ? least : most;
    for (*spp = 0; *spp < reached && tile_plan_pass_end(plan, *spp) <= reached;) *spp = tile_plan_pass_end(plan, *spp);
    look(u);
    while (!is_over(u)) {
        u->job->target = tile_plan_pass_end(plan, *spp);
        if (!run_pass(u, pool)) break;
        *spp = u->job->target;
        look(u);
        if (now() - u->told >= PROGRESS_INTERVAL) tell(u); /* short passes end before the wait does */
        if (is_save_due(u)) save(u);
    }
    tell(u);
}

facet_status render_continue(const scene *s, const render_settings *settings, render_state *state,
                             render_result *result, facet_error *why)
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
    status = job_create(s, &r, n_threads, state, &j, why);
    if (status) return status;
    thread_pool *pool = NULL;
    status = thread_pool_create(n_threads, tracer_prepare_thread, &pool);
    if (status) {
        job_destroy(&j);
        return facet_error_set(why, status, "threads", "cannot start %u threads", n_threads);
    }
    const double start = now();
    run u = {.job = &j,
             .settings = &r,
             .start = start,
             .start_cpu = read_clock(CLOCK_PROCESS_CPUTIME_ID),
             .seconds = state->seconds,
             .cpu_seconds = state->cpu_seconds,
             .n_samples = j.n_samples,
             .told = start,
             .saved = start,
             .noise = -1,
             .is_wanted = true};
    run_passes(&u, pool);
    thread_pool_destroy(pool);
    save(&u);
    collect(&u);
    status = render_develop(state, result, why);
    if (status == FACET_OK) {
        result->setup_seconds = start - begin;
        result->is_complete = state->spp == j.plan.n_share;
    }
    job_destroy(&j);
    return status;
}

facet_status render(const scene *s, const render_settings *settings, render_result *result, facet_error *why)
{
    render_state state = {0};
    const facet_status status = render_continue(s, settings, &state, result, why);
    render_state_destroy(&state);
    return status;
}
