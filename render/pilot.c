/* pilot.c: a few squares of the picture, rendered with shared light and without.
 * SPDX-License-Identifier: MIT */
#include "render/pilot.h"

/* Squares a side, at most, and samples of each of their pixels. */
enum { SIDE = 4, N_SAMPLES = 2 };

/* Any, but the same for every seed of the picture. */
static const uint32_t SEED = 0x9e3779b9;

/* The share of the variance that may be left: a sample takes 1.2 to 2.3 times as long (docs/performance.md). */
static const double MOST_LEFT = 0.6;

typedef struct pilot {
    const job *job;
    uint32_t across, down;
    double deviations[2][SIDE*SIDE]; /* without and with */
    bool has_memory[2][SIDE*SIDE];
} pilot;

/* Squares that have room on a side of so many pixels. */
static uint32_t squares_along(size_t side)
{
    return side < TILE_SIZE ? 1 : side < SIDE*TILE_SIZE ? (uint32_t)(side/TILE_SIZE) : SIDE;
}

/* Where the i-th of n squares begins; they lie in the middle of n equal parts. */
static size_t begin_of(size_t side, uint32_t i, uint32_t n)
{
    return side < TILE_SIZE ? 0 : (side*(2*i + 1)/n - TILE_SIZE)/2;
}

static uint32_t length_of(size_t side)
{
    return (uint32_t)(side < TILE_SIZE ? side : TILE_SIZE);
}

/* A thread_pool_job. */
static void run_square(void *user, uint32_t piece, uint32_t thread)
{
    pilot *p = user;
    const uint32_t square = piece/2, way = piece%2;
    path_context context = p->job->context;
    render_settings settings = *context.settings;
    path_counts counts = {0};
    film f;
    film_error error = {0};
    const uint32_t width = length_of(settings.width), height = length_of(settings.height);
    settings.crop_x = begin_of(settings.width, square%p->across, p->across);
    settings.crop_y = begin_of(settings.height, square/p->across, p->down);
    context.settings = &settings;
    context.sampler = sampler_create(SAMPLER_RANDOM, SEED, N_SAMPLES);
    context.keeps_features = false;
    context.has_gradients = way == 1;
    p->has_memory[way][square] = film_create(width, height, &f) == FACET_OK;
    if (!p->has_memory[way][square]) return;
    for (uint32_t i = 0; i < N_SAMPLES; i++)
        path_batch_run(p->job->workers[thread].batch, &context, (tile){0, 0, width, height}, i, &f, &counts);
    film_measure(&f, 0, 0, width, height, &error);
    p->deviations[way][square] = error.deviation;
    film_destroy(&f);
}

facet_status pilot_run(const job *j, thread_pool *pool, bool *pays)
{
    const render_settings *r = j->context.settings;
    pilot p = {.job = j, .across = squares_along(r->width), .down = squares_along(r->height)};
    const uint32_t n_squares = p.across*p.down;
    double sum[2] = {0, 0}; /* as film_noise has it */
    thread_pool_start(pool, run_square, &p, 2*n_squares);
    while (!thread_pool_wait(pool, PROGRESS_INTERVAL)) continue;
    for (int way = 0; way < 2; way++)
        for (uint32_t i = 0; i < n_squares; i++) {
            if (!p.has_memory[way][i]) return FACET_NO_MEMORY;
            sum[way] += p.deviations[way][i];
        }
    *pays = sum[1]*sum[1] < MOST_LEFT*sum[0]*sum[0];
    return FACET_OK;
}
