/* render.c: passes over the picture, by tiles over threads, until enough samples, time or precision.
 * SPDX-License-Identifier: MIT */
#include "render/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/error.h"
#include "render/crew.h"
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

tile job_tile(const job *j, uint32_t piece)
{
    const uint32_t x0 = piece%j->n_tiles_x*TILE_SIZE, y0 = piece/j->n_tiles_x*TILE_SIZE;
    const uint32_t w = (uint32_t)j->state->film.width, h = (uint32_t)j->state->film.height;
    return (tile){x0, y0, x0 + TILE_SIZE < w ? x0 + TILE_SIZE : w, y0 + TILE_SIZE < h ? y0 + TILE_SIZE : h};
}

uint32_t job_position(const job *j, tile where)
{
    const film *f = &j->state->film;
    return f->pixels[where.y0*f->width + where.x0].n;
}

void job_run_tile(job *j, tile where, uint32_t begin, uint32_t end, uint32_t thread)
{
    worker *own = &j->workers[thread];
    if (begin >= end) return;
    for (uint32_t i = begin; i < end; i++)
        path_batch_run(own->batch, &j->context, where, j->first_sample + i, &j->state->film, &own->counts);
    const uint64_t n_pixels = (uint64_t)(where.x1 - where.x0)*(where.y1 - where.y0);
    __atomic_fetch_add(&j->n_samples, n_pixels*(end - begin), __ATOMIC_RELAXED);
}

/* A thread_pool_job: all samples of this pass in one tile. */
static void run_tile(void *user, uint32_t piece, uint32_t thread)
{
    job *j = user;
    const tile where = job_tile(j, piece);
    job_run_tile(j, where, job_position(j, where), j->target, thread);
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
    light_set_destroy((light_set *)j->context.lights);
    surface_set_destroy((surface_set *)j->context.surfaces);
    tracer_destroy((tracer *)j->context.tracer);
    *j = (job){0};
}

/* Makes an empty state's film, or takes the positions of a state's tiles. */
static facet_status adopt_state(job *j, const render_settings *r, facet_error *why)
{
    film *f = &j->state->film;
    if (!f->pixels) {
        *j->state = (render_state){0};
        return film_create(r->crop_w, r->crop_h, f);
    }
    if (f->width != r->crop_w || f->height != r->crop_h)
        return facet_error_set(why, FACET_BAD_VALUE, "size", "%zux%zu is not the picture's %zux%zu", f->width,
                               f->height, r->crop_w, r->crop_h);
    for (uint32_t i = 0; i < j->n_tiles; i++) {
        const tile where = job_tile(j, i);
        const uint32_t position = job_position(j, where);
        bool is_even = position <= j->n_share;
        for (uint32_t y = where.y0; y < where.y1; y++)
            for (uint32_t x = where.x0; x < where.x1; x++) is_even &= f->pixels[y*f->width + x].n == position;
        if (!is_even)
            return facet_error_set(why, FACET_BAD_VALUE, "", "tile %u has not the samples that a render gives it", i);
        j->n_samples += (uint64_t)position*(where.x1 - where.x0)*(where.y1 - where.y0);
    }
    return FACET_OK;
}

/* Acceleration structure, light tables, film and workspaces. */
static facet_status job_create(const scene *s, const render_settings *r, uint32_t n_threads, render_state *state,
                               job *j, facet_error *why)
{
    *j = (job){.context = {.scene = s, .camera = &s->cameras[r->camera], .settings = r}, .state = state};
    j->n_tiles_x = (uint32_t)((r->crop_w + TILE_SIZE - 1)/TILE_SIZE);
    j->n_tiles = j->n_tiles_x*(uint32_t)((r->crop_h + TILE_SIZE - 1)/TILE_SIZE);
    render_share(r->spp, r->shard, r->n_shards, &j->first_sample, &j->n_share);
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
        status = adopt_state(j, r, why);
        state->isa = tracer_isa(built);
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

/* Passes grow, so that the first pictures come soon and later ones waste no time on waiting for the last tile.  Their
 * ends depend on nothing but the samples done, so that a continued render looks at its noise where it would have. */
uint32_t pass_length(uint32_t n_done, uint32_t n_share)
{
    const uint32_t length = n_done < 4 ? 1 : n_done/4 < 16 ? n_done/4 : 16;
    return length < n_share - n_done ? length : n_share - n_done;
}

/* Asks for an early end if the progress callback does. */
void run_tell(run *u)
{
    const render_settings *r = u->settings;
    u->told = run_now();
    if (!r->progress) return;
    const uint64_t n_pixels = (uint64_t)r->crop_w*r->crop_h;
    const double elapsed = u->told - u->start, total = u->seconds + elapsed;
    render_progress p = {.samples_done = __atomic_load_n(&u->job->n_samples, __ATOMIC_RELAXED),
                         .samples_total = n_pixels*u->job->n_share,
                         .seconds = total,
                         .noise = u->noise,
                         .time_left = -1};
    if (p.samples_done > u->n_samples && elapsed > 0) {
        p.samples_per_second = (double)(p.samples_done - u->n_samples)/elapsed;
        p.time_left = (double)(p.samples_total - p.samples_done)/p.samples_per_second;
        if (r->time_limit > 0) p.time_left = fmin(p.time_left, fmax(r->time_limit - total, 0));
        if (r->noise_target > 0 && u->noise > 0) {
            const double factor = u->noise/r->noise_target; /* the error falls with the square root of samples */
            p.time_left = fmin(p.time_left, fmax(factor*factor - 1, 0)*total);
        }
    }
    if (!r->progress(r->user, &p)) u->is_wanted = false;
}

void run_collect(const run *u)
{
    const job *j = u->job;
    render_state *state = j->state;
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
    u->settings->save(u->settings->user, u->job->state);
    u->saved = run_now();
}

bool run_is_save_due(const run *u)
{
    const render_settings *r = u->settings;
    if (!r->save) return false;
    return run_now() - u->saved >= r->save_interval || (r->wants_save && r->wants_save(r->user));
}

void job_positions(const job *j, uint32_t *least, uint32_t *most)
{
    *least = UINT32_MAX;
    *most = 0;
    for (uint32_t i = 0; i < j->n_tiles; i++) {
        const uint32_t position = job_position(j, job_tile(j, i));
        *least = position < *least ? position : *least;
        *most = position > *most ? position : *most;
    }
}

uint32_t job_passed(const job *j, uint32_t least)
{
    uint32_t passed = 0;
    for (uint32_t n; passed < least && passed + (n = pass_length(passed, j->n_share)) <= least;) passed += n;
    return passed;
}

/* Renders the tiles that are behind the target; true when all are there. */
static bool run_pass(run *u, thread_pool *pool)
{
    for (;;) {
        uint32_t least, most;
        job_positions(u->job, &least, &most);
        if (least >= u->job->target) return true;
        /* The first pass is finished, so that there is a whole picture; later ones need not be. */
        if (!u->is_wanted && u->job->state->spp > 0) return false;
        thread_pool_start(pool, run_tile, u->job, u->job->n_tiles);
        while (!thread_pool_wait(pool, PROGRESS_INTERVAL)) {
            run_tell(u);
            if ((!u->is_wanted && u->job->state->spp > 0) || run_is_save_due(u)) thread_pool_cancel(pool);
        }
        if (run_is_save_due(u)) save(u);
    }
}

bool run_is_over(const run *u)
{
    const render_settings *r = u->settings;
    const uint32_t spp = u->job->state->spp;
    if (!u->is_wanted || spp == u->job->n_share) return true;
    if (r->time_limit > 0 && spp > 0 && u->seconds + run_now() - u->start >= r->time_limit) return true;
    return r->noise_target > 0 && u->noise >= 0 && spp >= 16 && u->noise <= r->noise_target;
}

/* Runs passes until an end is reached. */
static void run_passes(run *u, thread_pool *pool)
{
    job *j = u->job;
    uint32_t least, most;
    job_positions(j, &least, &most);
    j->state->spp = job_passed(j, least);
    if (least == most) u->noise = film_noise(&j->state->film);
    while (!run_is_over(u)) {
        j->target = j->state->spp + pass_length(j->state->spp, j->n_share);
        if (!run_pass(u, pool)) break;
        j->state->spp = j->target;
        u->noise = film_noise(&j->state->film);
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
                              (uint64_t)r->sampler};
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
    *u = (run){.job = j,
               .settings = r,
               .seconds = state->seconds,
               .cpu_seconds = state->cpu_seconds,
               .n_samples = j->n_samples,
               .noise = -1,
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
    run u;
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
        result->is_complete = state->spp == j.n_share;
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
