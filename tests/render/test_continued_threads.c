/* test_continued_threads.c: renders that are stopped, continued and divided into shards give the bits of one that is
 * not.  Small, because it also runs under thread sanitizers.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/path.h"
#include "render/tile_plan.h"
#include "tests/draws.h"
#include "tests/scene_builder.h"

enum { WIDTH = 71, HEIGHT = 53, MOST_STATES = 64 };

static render_settings settings(uint32_t spp)
{
    render_settings r;
    render_settings_defaults(&r);
    r.width = WIDTH;
    r.height = HEIGHT;
    r.spp = spp;
    r.depth = 3;
    r.n_threads = 2;
    return r;
}

static render_state copy_of(const render_state *state)
{
    render_state copy = *state;
    if (film_create(WIDTH, HEIGHT, &copy.film)) fail();
    if (state->film.features && film_keep_features(&copy.film)) fail();
    film_merge(&copy.film, &state->film);
    return copy;
}

/* The states that a render saves. */
typedef struct saved {
    render_state states[MOST_STATES];
    size_t n;
} saved;

static void keep(void *user, const render_state *state)
{
    saved *all = user;
    if (all->n < MOST_STATES) all->states[all->n++] = copy_of(state);
}

static void check_layer(const film *a, const film *b, film_layer layer)
{
    image p, q;
    assert_int_equal(film_develop_layer(a, layer, &p), FACET_OK);
    assert_int_equal(film_develop_layer(b, layer, &q), FACET_OK);
    assert_memory_equal(p.pixels, q.pixels, WIDTH*HEIGHT*p.n_channels*sizeof(float));
    image_destroy(&q);
    image_destroy(&p);
}

static void continue_and_compare(const scene *s, render_settings r, const render_state *from, const render_state *whole,
                                 const render_result *expected)
{
    render_state state = copy_of(from);
    render_result result = {0};
    facet_error why = {0};
    if (render_continue(s, &r, &state, &result, &why)) fail_msg("%s: %s", why.place, why.text);
    assert_memory_equal(state.film.pixels, whole->film.pixels, WIDTH*HEIGHT*sizeof *state.film.pixels);
    if (r.keeps_features)
        for (film_layer layer = FILM_ALBEDO; layer <= FILM_SAMPLES; layer++)
            check_layer(&state.film, &whole->film, layer);
    assert_memory_equal(result.picture.pixels, expected->picture.pixels, 3*sizeof(float)*WIDTH*HEIGHT);
    assert_true(result.spp == expected->spp && result.is_complete == expected->is_complete);
    assert_true(result.noise == expected->noise);
    assert_true(result.seconds >= from->seconds);
    render_result_destroy(&result);
    render_state_destroy(&state);
}

/* What a render stopped inside a pass has: each tile from one of two states at the pass's ends. */
static render_state state_inside_a_pass(const render_state *before, const render_state *after, draws *d)
{
    render_state state = copy_of(before);
    for (size_t y = 0; y < HEIGHT; y += TILE_SIZE)
        for (size_t x = 0; x < WIDTH; x += TILE_SIZE) {
            if (draw(d) < .5) continue;
            const size_t n = WIDTH - x < TILE_SIZE ? WIDTH - x : TILE_SIZE;
            for (size_t row = y; row < y + TILE_SIZE && row < HEIGHT; row++)
                memcpy(&state.film.pixels[row*WIDTH + x], &after->film.pixels[row*WIDTH + x],
                       n*sizeof *state.film.pixels);
            for (size_t row = y; state.film.features && row < y + TILE_SIZE && row < HEIGHT; row++)
                memcpy(&state.film.features[row*WIDTH + x], &after->film.features[row*WIDTH + x],
                       n*sizeof *state.film.features);
        }
    return state;
}

/* From every state that a render saves, and from states inside its passes, on any number of threads. */
static void check_all_continuations(render_settings r)
{
    scene *s = build_ball_and_lamp();
    saved *all = calloc(1, sizeof *all);
    render_state whole = {0};
    render_result expected = {0};
    draws d = {1};
    assert_non_null(all);
    r.save = keep;
    r.user = all;
    assert_int_equal(render_continue(s, &r, &whole, &expected, NULL), FACET_OK);
    assert_true(all->n >= 3);
    assert_true(fabs((double)all->states[all->n - 1].n_paths/(WIDTH*HEIGHT*expected.mean_spp) - 1) < 1e-9);
    r.save = NULL;
    for (size_t i = 0; i < all->n; i++) {
        r.n_threads = (uint32_t)(1 + i%3);
        continue_and_compare(s, r, &all->states[i], &whole, &expected);
        if (i == 0) continue;
        render_state inside = state_inside_a_pass(&all->states[i - 1], &all->states[i], &d);
        continue_and_compare(s, r, &inside, &whole, &expected);
        render_state_destroy(&inside);
    }
    for (size_t i = 0; i < all->n; i++) render_state_destroy(&all->states[i]);
    free(all);
    render_result_destroy(&expected);
    render_state_destroy(&whole);
    scene_destroy(s);
}

static void a_continued_render_gives_the_bits_of_an_uninterrupted_one(void **state)
{
    (void)state;
    render_settings r = settings(SAMPLE_DIVISOR > 1 ? 4 : 9);
    check_all_continuations(r);
    r.keeps_features = true;
    check_all_continuations(r);
}

static void a_continued_render_stops_at_the_same_noise(void **state)
{
    (void)state;
    render_settings r = settings(4096);
    r.noise_target = 0.15;
    check_all_continuations(r);
}

/* A tile of 20 samples is inside the pass from 18 to 22: however quiet, it is judged at the end,
   and so is the picture. */
static void nothing_is_judged_inside_a_pass(void **state)
{
    (void)state;
    render_settings r = settings(100);
    render_state made = {0};
    tile_plan plan;
    r.crop_w = 2*TILE_SIZE;
    r.crop_h = TILE_SIZE;
    r.noise_target = 0.5;
    assert_int_equal(tile_plan_create(&r, &made, &plan, NULL), FACET_OK);
    for (size_t x = 0; x < r.crop_w; x++)
        for (size_t y = 0; y < r.crop_h; y++)
            for (uint32_t k = 0; k < (x < TILE_SIZE ? 20u : 18u); k++)
                film_add(&made.film, x, y, (const float[3]){1, 1, k & 1 ? 2 : 1});
    made.mean_luminance = 1;
    tile_plan_look(&plan);
    assert_true(!plan.is_done[0] && plan.is_done[1]);
    assert_true(plan.noise < r.noise_target && !tile_plan_is_quiet(&plan));
    tile_plan_destroy(&plan);
    render_state_destroy(&made);
}

/* Tiles end at different times, and none but those that are quiet enough. */
static void each_tile_ends_at_its_own_noise(void **state)
{
    (void)state;
    scene *s = build_ball_and_lamp();
    render_settings r = settings(4096);
    render_state made = {0};
    render_result result = {0};
    r.noise_target = 0.15;
    assert_int_equal(render_continue(s, &r, &made, &result, NULL), FACET_OK);
    assert_true(result.noise > 0 && result.noise <= r.noise_target && !result.is_complete);
    assert_true(result.mean_spp < result.spp && result.mean_spp >= 16);
    uint32_t least = UINT32_MAX, most = 0;
    for (size_t y = 0; y < HEIGHT; y += TILE_SIZE)
        for (size_t x = 0; x < WIDTH; x += TILE_SIZE) {
            const size_t x1 = x + TILE_SIZE < WIDTH ? x + TILE_SIZE : WIDTH,
                         y1 = y + TILE_SIZE < HEIGHT ? y + TILE_SIZE : HEIGHT;
            const uint32_t n = made.film.pixels[y*WIDTH + x].n;
            film_error e;
            assert_true(film_measure(&made.film, x, y, x1, y1, &e));
            const bool is_quiet = e.deviation <= r.noise_target*sqrt(e.luminance*made.mean_luminance);
            assert_true(is_quiet || n == result.spp);
            least = n < least ? n : least;
            most = n > most ? n : most;
        }
    assert_true(least >= 16 && least < most && most == result.spp);
    render_result_destroy(&result);
    render_state_destroy(&made);
    scene_destroy(s);
}

/* What film_noise estimates, in truth: the mean over blocks of the root mean square error of their pixels, over the
 * mean luminance. */
static double true_noise(const image *picture, const image *reference)
{
    double error = 0, luminance = 0;
    for (size_t y = 0; y < HEIGHT; y += FILM_BLOCK)
        for (size_t x = 0; x < WIDTH; x += FILM_BLOCK) {
            double squares = 0, n = 0;
            for (size_t row = y; row < HEIGHT && row < y + FILM_BLOCK; row++)
                for (size_t column = x; column < WIDTH && column < x + FILM_BLOCK; column++, n++) {
                    const float *p = (const float *)picture->pixels + 3*(row*WIDTH + column),
                                *q = (const float *)reference->pixels + 3*(row*WIDTH + column);
                    squares += pow((double)(p[1] - q[1]), 2); /* all is grey */
                    luminance += (double)q[1];
                }
            error += n*sqrt(squares/n);
        }
    return error/luminance;
}

/* The estimate takes samples for independent; those that are spread evenly err several times less in so simple a
 * scene. */
static void the_noise_that_is_promised_is_kept(void **state)
{
    (void)state;
    scene *s = build_ball_and_lamp();
    render_settings r = settings(4096);
    render_state made = {0}, reference = {0};
    render_result result = {0}, exact = {0};
    r.noise_target = 0.1;
    assert_int_equal(render_continue(s, &r, &made, &result, NULL), FACET_OK);
    r.noise_target = 0;
    r.seed = 1;
    r.spp = 64*result.spp/(SAMPLE_DIVISOR > 1 ? 8 : 1);
    assert_int_equal(render_continue(s, &r, &reference, &exact, NULL), FACET_OK);
    const double error = true_noise(&result.picture, &exact.picture);
    if (!(error <= result.noise && error > result.noise/8))
        fail_msg("the noise is %g, and was estimated as %g", error, result.noise);
    render_result_destroy(&exact);
    render_result_destroy(&result);
    render_state_destroy(&reference);
    render_state_destroy(&made);
    scene_destroy(s);
}

/* Stopped by its own progress callback again and again, on other numbers of threads. */
static bool refuse(void *user, const render_progress *progress)
{
    (void)user;
    (void)progress;
    return false;
}

static void a_render_that_is_stopped_again_and_again_ends_the_same(void **state)
{
    (void)state;
    scene *s = build_ball_and_lamp();
    render_settings r = settings(SAMPLE_DIVISOR > 1 ? 5 : 60);
    render_state whole = {0}, pieces = {0};
    render_result expected = {0}, result = {0};
    assert_int_equal(render_continue(s, &r, &whole, &expected, NULL), FACET_OK);
    r.progress = refuse;
    int n_runs = 0;
    while (!result.is_complete) {
        render_result_destroy(&result);
        r.n_threads = (uint32_t)(1 + n_runs%4);
        assert_int_equal(render_continue(s, &r, &pieces, &result, NULL), FACET_OK);
        n_runs++;
        assert_true(n_runs < 1000);
    }
    assert_memory_equal(pieces.film.pixels, whole.film.pixels, WIDTH*HEIGHT*sizeof *whole.film.pixels);
    assert_int_equal(pieces.n_paths, whole.n_paths);
    assert_int_equal(pieces.n_rays, whole.n_rays);
    render_result_destroy(&result);
    render_result_destroy(&expected);
    render_state_destroy(&pieces);
    render_state_destroy(&whole);
    scene_destroy(s);
}

static void shards_add_up_to_the_whole(void **state)
{
    (void)state;
    static const uint32_t counts[] = {1, 2, 3, 5};
    scene *s = build_ball_and_lamp();
    render_settings r = settings(5);
    render_state whole = {0};
    render_result expected = {0};
    assert_int_equal(render_continue(s, &r, &whole, &expected, NULL), FACET_OK);
    for (size_t i = 0; i < sizeof counts/sizeof *counts; i++) {
        film sum;
        assert_int_equal(film_create(WIDTH, HEIGHT, &sum), FACET_OK);
        r.n_shards = counts[i];
        for (uint32_t k = 0; k < counts[i]; k++) {
            render_state part = {0};
            render_result result = {0};
            r.shard = 1 + (k + 2)%counts[i]; /* not in order */
            assert_int_equal(render_continue(s, &r, &part, &result, NULL), FACET_OK);
            assert_true(result.is_complete);
            film_merge(&sum, &part.film);
            render_result_destroy(&result);
            render_state_destroy(&part);
        }
        assert_memory_equal(sum.pixels, whole.film.pixels, WIDTH*HEIGHT*sizeof *sum.pixels);
        film_destroy(&sum);
    }
    render_result_destroy(&expected);
    render_state_destroy(&whole);
    scene_destroy(s);
}

static void shares_cover_all_samples_once(void **state)
{
    (void)state;
    for (uint32_t n_shards = 1; n_shards <= 70; n_shards++) {
        const uint32_t sizes[] = {n_shards, n_shards + 1, 1000, 1 << 24};
        for (size_t i = 0; i < sizeof sizes/sizeof *sizes; i++) {
            uint32_t next = 0, first, n;
            for (uint32_t k = 1; k <= n_shards; k++) {
                render_share(sizes[i], k, n_shards, &first, &n);
                assert_int_equal(first, next);
                assert_true(n >= sizes[i]/n_shards && n <= sizes[i]/n_shards + 1);
                next += n;
            }
            assert_int_equal(next, sizes[i]);
        }
    }
}

static void states_of_other_renders_are_refused(void **state)
{
    (void)state;
    scene *s = build_ball_and_lamp();
    render_settings r = settings(2);
    render_state made = {0};
    render_result result = {0};
    facet_error why = {0};
    assert_int_equal(render_continue(s, &r, &made, &result, NULL), FACET_OK);
    render_result_destroy(&result);
    r.spp = 1; /* the state has more */
    assert_int_equal(render_continue(s, &r, &made, &result, &why), FACET_BAD_VALUE);
    r.spp = 3;
    r.width++;
    assert_int_equal(render_continue(s, &r, &made, &result, &why), FACET_BAD_VALUE);
    r.width--;
    r.keeps_features = true; /* the state has none */
    assert_int_equal(render_continue(s, &r, &made, &result, &why), FACET_BAD_VALUE);
    r.keeps_features = false;
    made.film.pixels[WIDTH + 1].n--; /* within a tile */
    assert_int_equal(render_continue(s, &r, &made, &result, &why), FACET_BAD_VALUE);
    render_state_destroy(&made);
    static const uint32_t shards[][2] = {{0, 1}, {2, 1}, {1, 4}};
    for (size_t i = 0; i < sizeof shards/sizeof *shards; i++) {
        r.shard = shards[i][0];
        r.n_shards = shards[i][1];
        assert_int_equal(render_continue(s, &r, &made, &result, &why), FACET_BAD_VALUE);
        assert_string_equal(why.place, "shard");
    }
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_continued_render_gives_the_bits_of_an_uninterrupted_one),
        cmocka_unit_test(a_continued_render_stops_at_the_same_noise),
        cmocka_unit_test(nothing_is_judged_inside_a_pass),
        cmocka_unit_test(each_tile_ends_at_its_own_noise),
        cmocka_unit_test(the_noise_that_is_promised_is_kept),
        cmocka_unit_test(a_render_that_is_stopped_again_and_again_ends_the_same),
        cmocka_unit_test(shards_add_up_to_the_whole),
        cmocka_unit_test(shares_cover_all_samples_once),
        cmocka_unit_test(states_of_other_renders_are_refused),
    };
    return cmocka_run_group_tests_name("continued_threads", tests, NULL, NULL);
}
