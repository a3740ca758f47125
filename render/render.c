/* render.c: passes over the picture, by tiles over threads, until enough samples, time or precision.
 * SPDX-License-Identifier: MIT */
#include "render/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/error.h"
#include "render/crew.h"
#include "render/pilot.h"
#include "render/render_run.h"
#include "render/surface.h"

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

double run_now(void)
{
    return read_clock(CLOCK_MONOTONIC);
}

void job_run_tile(job *j, uint32_t piece, uint32_t begin, uint32_t end, uint32_t thread)
{
    worker *own = &j->workers[thread];
    const tile where = tile_plan_at(&j->plan, piece);
    if (begin >= end) return;
    for (uint32_t i = begin; i < end; i++)
        path_batch_run(own->batch, &j->context, where, j->plan.first_sample + i, &j->plan.state->film, &own->counts);
    const uint64_t n_pixels = (uint64_t)(where.x1 - where.x0)*(where.y1 - where.y0);
    __atomic_fetch_add(&j->n_samples, n_pixels*(end - begin), __ATOMIC_RELAXED);
}

/* A thread_pool_job: the samples that a tile has not got yet, pass by pass, up to the end of this one. */
static void run_tile(void *user, uint32_t piece, uint32_t thread)
{
    job *j = user;
    uint32_t position = tile_plan_position(&j->plan, tile_plan_at(&j->plan, piece));
    while (position < j->target && !j->plan.is_done[piece]) {
        const uint32_t end = tile_plan_pass_end(&j->plan, position);
        job_run_tile(j, piece, position, end, thread);
        tile_plan_judge(&j->plan, piece);
        position = end;
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
    *j = (job){0};
}

/* Whether what lies between two points is known once it has been asked. */
static bool is_opaque(const scene *s)
{
    for (size_t i = 0; i < s->n_materials; i++)
        if (s->materials[i].alpha == ALPHA_BLEND) return false;
    return true;
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
    j->context.has_gradients = r->gradients != GRADIENTS_OFF && r->depth >= 1 && is_opaque(s);
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

/* Asks for an early end if the progress callback does. */
void run_tell(run *u)
{
    const render_settings *r = u->settings;
    u->told = run_now();
    if (!r->progress) return;
    const double elapsed = u->told - u->start, total = u->seconds + elapsed;
    render_progress p = {.samples_done = __atomic_load_n(&u->job->n_samples, __ATOMIC_RELAXED),
                         .samples_total = u->n_samples_then + u->n_left,
                         .seconds = total,
                         .noise = u->job->plan.noise,
                         .time_left = -1};
    if (p.samples_done > p.samples_total) p.samples_total = p.samples_done;
    if (p.samples_done > u->n_samples && elapsed > 0) {
        p.samples_per_second = (double)(p.samples_done - u->n_samples)/elapsed;
        p.time_left = (double)(p.samples_total - p.samples_done)/p.samples_per_second;
        if (r->time_limit > 0) p.time_left = fmin(p.time_left, fmax(r->time_limit - total, 0));
    }
    if (!r->progress(r->user, &p)) u->is_wanted = false;
}

void run_collect(const run *u)
{
    const job *j = u->job;
    render_state *state = j->plan.state;
    state->seconds = u->seconds + run_now() - u->start;
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
    run_collect(u);
    u->settings->save(u->settings->user, u->job->plan.state);
    u->saved = run_now();
}

bool run_is_save_due(const run *u)
{
    const render_settings *r = u->settings;
    if (!r->save) return false;
    return run_now() - u->saved >= r->save_interval || (r->wants_save && r->wants_save(r->user));
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
            run_tell(u);
            if ((!u->is_wanted && has_picture) || run_is_save_due(u)) thread_pool_cancel(pool);
        }
        if (run_is_save_due(u)) save(u);
    }
}

void run_look(run *u)
{
    job *j = u->job;
    tile_plan_look(&j->plan);
    j->plan.state->spp = tile_plan_passed(&j->plan);
    u->n_samples_then = __atomic_load_n(&j->n_samples, __ATOMIC_RELAXED);
    u->n_left = tile_plan_samples_left(&j->plan);
}

bool run_is_over(const run *u)
{
    const render_settings *r = u->settings;
    const uint32_t spp = u->job->plan.state->spp;
    if (!u->is_wanted || spp == u->job->plan.n_share || tile_plan_is_quiet(&u->job->plan)) return true;
    return r->time_limit > 0 && spp > 0 && u->seconds + run_now() - u->start >= r->time_limit;
}

/* Runs passes until an end is reached. */
static void run_passes(run *u, thread_pool *pool)
{
    job *j = u->job;
    run_look(u);
    while (!run_is_over(u)) {
        j->target = tile_plan_pass_end(&j->plan, j->plan.state->spp);
        if (!run_pass(u, pool)) break;
        run_look(u);
        if (run_now() - u->told >= PROGRESS_INTERVAL) run_tell(u); /* short passes end before the wait does */
        if (run_is_save_due(u)) save(u);
    }
    run_tell(u);
}

/* A number that differs between renders of other settings. */
static uint64_t identity_of(const scene *s, const render_settings *r)
{
    const uint64_t words[] = {s->hash,
                              r->width,
                              r->height,
                              r->crop_x,
                              r->crop_y,
                              r->crop_w,
                              r->crop_h,
                              r->camera,
                              r->spp,
                              r->depth,
                              r->seed,
                              r->shard,
                              r->shard,
                              r->n_shards,
                              (uint64_t)r->strategy,
                              (uint64_t)r->sampler,
                              r->keeps_features,
                              (uint64_t)r->gradients};
    uint64_t hash = 0xcbf29ce484222325; /* FNV-1a, by words */
    for (size_t i = 0; i < sizeof words/sizeof *words; i++) hash = (hash ^ words[i])*0x100000001b3;
    return hash;
}

/* All that a run needs; on failure what was made remains to be destroyed. */
static facet_status run_create(const scene *s, const render_settings *r, render_state *state, job *j, run *u,
                               thread_pool **pool, crew_part **part, facet_error *why)
{
    const uint32_t n_threads = r->n_threads ? r->n_threads : thread_pool_default_size();
    facet_status status = check_settings(s, r, why);
    if (!status) status = job_create(s, r, n_threads, state, j, why);
    if (status) return status;
    status = thread_pool_create(n_threads, tracer_prepare_thread, pool);
    if (status) return facet_error_set(why, status, "threads", "cannot start %u threads", n_threads);
    if (j->context.has_gradients && r->gradients == GRADIENTS_AUTO &&
        (status = pilot_run(j, *pool, &j->context.has_gradients)) != FACET_OK)
        return facet_error_set(why, status, "gradients", "no memory for a pilot; give on or off");
    *u = (run){.job = j,
               .settings = r,
               .seconds = state->seconds,
               .cpu_seconds = state->cpu_seconds,
               .n_samples = j->n_samples,
               .is_wanted = true};
    if (r->crew && (status = crew_prepare(r->crew, u, *pool, part)) != FACET_OK)
        return facet_error_set(why, status, "size", "no memory for a picture of %zux%zu", r->crop_w, r->crop_h);
    return FACET_OK;
}

static void run_destroy(job *j, thread_pool *pool, crew_part *part)
{
    thread_pool_destroy(pool);
    crew_unprepare(part);
    job_destroy(j);
}

facet_status render_continue(const scene *s, const render_settings *settings, render_state *state,
                             render_result *result, facet_error *why)
{
    render_settings r = *settings;
    if (r.crop_w == 0 && r.crop_h == 0) {
        r.crop_w = r.width;
        r.crop_h = r.height;
    }
    const double begin = run_now();
    job j = {0};
    run u = {.job = &j, .settings = &r};
    thread_pool *pool = NULL;
    crew_part *part = NULL;
    facet_status status = run_create(s, &r, state, &j, &u, &pool, &part, why);
    if (r.crew) status = crew_agree(r.crew, part, status, identity_of(s, &r), state->isa, why);
    if (status) {
        run_destroy(&j, pool, part);
        return status;
    }
    u.start = u.told = u.saved = run_now();
    u.start_cpu = read_clock(CLOCK_PROCESS_CPUTIME_ID);
    if (part) crew_run(part);
    else run_passes(&u, pool);
    if (r.crew && r.crew->rank > 0) {
        *result = (render_result){.isa = state->isa};
    } else {
        save(&u);
        run_collect(&u);
        status = render_develop(state, result, why);
    }
    if (status == FACET_OK) {
        result->setup_seconds = u.start - begin;
        result->has_gradients = j.context.has_gradients;
        result->is_complete = state->spp == j.plan.n_share;
        result->is_stopped = !u.is_wanted;
    }
    run_destroy(&j, pool, part);
    return status;
}

facet_status render(const scene *s, const render_settings *settings, render_result *result, facet_error *why)
{
    render_state state = {0};
    const facet_status status = render_continue(s, settings, &state, result, why);
    render_state_destroy(&state);
    return status;
}
