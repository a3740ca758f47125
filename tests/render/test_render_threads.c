/* test_render_threads.c: the picture does not depend on threads, tiles or crops; the pool survives what a day brings.
 * Small, because it also runs under thread sanitizers.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/thread_pool.h"
#include "tests/scene_builder.h"

/* Diffuse, glass, metal, a lamp, a sky, a texture that is half-transparent or, lest neighbouring pixels are left alone,
 * has holes: every branch of the integrator. */
static scene *some_of_everything(alpha_mode alpha)
{
    static const unsigned char texels[16] = {255, 64, 64, 255, 64, 255, 64, 40, 64, 64, 255, 128, 255, 255, 255, 220};
    scene *s = build_scene();
    build_quad(s, build_material(s, "lambert kd=.6", 0, false), (const float[3]){-2, 0, 2}, (const float[3]){4, 0, 0},
               (const float[3]){0, 0, -4});
    build_quad(s, build_material(s, "lambert kd=.2", 5, true), (const float[3]){-.5f, 2, -.5f},
               (const float[3]){1, 0, 0}, (const float[3]){0, 0, 1});
    build_sphere(s, build_material(s, "glass ior=1.5", 0, false), -.6f, .4f, 0, .4f);
    build_sphere(s, build_material(s, "ggx alpha=.2 ks=.8", 0, false), .5f, .4f, -.3f, .4f);
    const size_t veil = build_gltf_material(s, .8f, 0, .5f);
    s->materials[veil].alpha = alpha;
    s->materials[veil].is_double_sided = true;
    s->materials[veil].base_color_texture.texture = build_texture(s, 2, 2, texels, false);
    build_quad(s, veil, (const float[3]){-.5f, 0, .6f}, (const float[3]){1, 0, 0}, (const float[3]){0, .7f, 0});
    const punctual_light lamp = {.kind = LIGHT_POINT, .position = {1, 1, 1}, .intensity = {.5f, .4f, .3f}};
    assert_int_equal(scene_add_light(s, &lamp, NULL), FACET_OK);
    for (int k = 0; k < 3; k++) s->environment.scale[k] = .3f;
    build_camera(s, (const float[3]){0, 1, 4}, (const float[3]){0, .5f, 0}, .8f);
    return s;
}

/* 5 x 4 tiles, the last ones cut. */
static render_settings settings(void)
{
    render_settings r;
    render_settings_defaults(&r);
    r.width = 71;
    r.height = 53;
    r.spp = SAMPLE_DIVISOR > 1 ? 2 : 7;
    r.seed = 3;
    return r;
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    static const uint32_t counts[] = {2, 3, 7};
    static const struct {
        alpha_mode alpha;
        sampler_kind kind;
    } cases[] = {{ALPHA_BLEND, SAMPLER_SOBOL},
                 {ALPHA_BLEND, SAMPLER_RANDOM},
                 {ALPHA_MASK, SAMPLER_SOBOL},
                 {ALPHA_MASK, SAMPLER_RANDOM}};
    for (size_t k = 0; k < sizeof cases/sizeof cases[0]; k++) {
        scene *s = some_of_everything(cases[k].alpha);
        render_settings r = settings();
        r.sampler = cases[k].kind;
        r.n_threads = 1;
        image one = render_picture(s, &r);
        for (size_t i = 0; i < sizeof counts/sizeof counts[0]; i++) {
            r.n_threads = counts[i];
            image many = render_picture(s, &r);
            assert_memory_equal(one.pixels, many.pixels, 3*sizeof(float)*r.width*r.height);
            image_destroy(&many);
        }
        image_destroy(&one);
        scene_destroy(s);
    }
}

/* Tiles are cut from the crop's corner, so that each crop also brings another order and another shape of tiles. */
static void a_crop_equals_its_part_of_the_picture(void **state)
{
    (void)state;
    static const size_t crops[][4] = {{0, 0, 16, 16}, {5, 3, 40, 37}, {70, 52, 1, 1}, {0, 31, 71, 1}, {33, 0, 7, 53}};
    scene *s = some_of_everything(ALPHA_BLEND);
    render_settings r = settings();
    r.gradients = GRADIENTS_OFF; /* the pixels of a tile would err together, and the crop has other tiles */
    r.n_threads = 3;
    image whole = render_picture(s, &r);
    for (size_t i = 0; i < sizeof crops/sizeof crops[0]; i++) {
        r.crop_x = crops[i][0];
        r.crop_y = crops[i][1];
        r.crop_w = crops[i][2];
        r.crop_h = crops[i][3];
        image part = render_picture(s, &r);
        assert_int_equal(part.width, r.crop_w);
        assert_int_equal(part.height, r.crop_h);
        for (size_t y = 0; y < r.crop_h; y++)
            assert_memory_equal((const float *)part.pixels + 3*y*r.crop_w,
                                (const float *)whole.pixels + 3*((r.crop_y + y)*r.width + r.crop_x),
                                3*sizeof(float)*r.crop_w);
        image_destroy(&part);
    }
    image_destroy(&whole);
    scene_destroy(s);
}

/* Another seed is another picture, so the equalities above compare something. */
static void another_seed_gives_other_bits(void **state)
{
    (void)state;
    scene *s = some_of_everything(ALPHA_BLEND);
    render_settings r = settings();
    image a = render_picture(s, &r);
    r.seed = 4;
    image b = render_picture(s, &r);
    assert_memory_not_equal(a.pixels, b.pixels, 3*sizeof(float)*r.width*r.height);
    image_destroy(&a);
    image_destroy(&b);
    scene_destroy(s);
}

/* ---- Ends before the end ------------------------------------------------------------------------------------- */

static bool stop_at_once(void *user, const render_progress *state)
{
    (void)state;
    (*(int *)user)++;
    return false;
}

static void a_render_that_is_stopped_gives_the_picture_of_the_passes_done(void **state)
{
    (void)state;
    scene *s = some_of_everything(ALPHA_BLEND);
    render_settings r = settings();
    int n_calls = 0;
    render_result result = {0};
    facet_error why = {0};
    r.n_threads = 2;
    r.spp = 1 << 20;
    r.progress = stop_at_once;
    r.user = &n_calls;
    assert_int_equal(render(s, &r, &result, &why), FACET_OK);
    assert_true(n_calls > 0);
    assert_false(result.is_complete);
    assert_true(result.spp < r.spp);
    for (size_t i = 0; i < 3*r.width*r.height; i++) assert_true(((const float *)result.picture.pixels)[i] >= 0);
    render_result_destroy(&result);
    r.progress = NULL;
    r.time_limit = 0.2;
    assert_int_equal(render(s, &r, &result, &why), FACET_OK);
    assert_false(result.is_complete);
    assert_true(result.spp >= 1);
    render_result_destroy(&result);
    scene_destroy(s);
}

/* ---- The pool ------------------------------------------------------------------------------------------------ */

enum { MOST_PIECES = 5000 };

typedef struct tally {
    uint32_t times[MOST_PIECES]; /* each piece was done; written by one thread each */
    uint32_t n_threads, n_bad_threads, n_done;
} tally;

static void count_piece(void *user, uint32_t piece, uint32_t thread)
{
    tally *t = user;
    t->times[piece]++;
    if (thread >= t->n_threads) __atomic_fetch_add(&t->n_bad_threads, 1, __ATOMIC_RELAXED);
    __atomic_fetch_add(&t->n_done, 1, __ATOMIC_RELAXED);
}

static uint32_t n_prepared; /* atomic */

static void count_thread(void)
{
    __atomic_fetch_add(&n_prepared, 1, __ATOMIC_RELAXED);
}

static void pools_come_and_go(void **state)
{
    (void)state;
    tally *t = calloc(1, sizeof *t);
    assert_non_null(t);
    n_prepared = 0;
    uint32_t n_started = 0;
    for (uint32_t round = 0; round < 50; round++) {
        thread_pool *pool = NULL;
        t->n_threads = 1 + round%7;
        n_started += t->n_threads;
        assert_int_equal(thread_pool_create(t->n_threads, count_thread, &pool), FACET_OK);
        assert_int_equal(thread_pool_size(pool), t->n_threads);
        if (round%3) { /* some pools never see a job */
            memset(t->times, 0, sizeof t->times);
            thread_pool_start(pool, count_piece, t, 100);
            while (!thread_pool_wait(pool, 10)) {}
            for (int i = 0; i < 100; i++) assert_int_equal(t->times[i], 1);
        }
        thread_pool_destroy(pool);
    }
    assert_int_equal(n_prepared, n_started);
    assert_int_equal(t->n_bad_threads, 0);
    free(t);
    thread_pool_destroy(NULL);
}

static void many_small_jobs_do_each_piece_once(void **state)
{
    (void)state;
    tally *t = calloc(1, sizeof *t);
    thread_pool *pool = NULL;
    assert_non_null(t);
    t->n_threads = 4;
    assert_int_equal(thread_pool_create(4, NULL, &pool), FACET_OK);
    const uint32_t n_jobs = 2000/SAMPLE_DIVISOR;
    uint32_t expected = 0;
    for (uint32_t job = 0; job < n_jobs; job++) {
        thread_pool_start(pool, count_piece, t, job%5);
        expected += job%5;
        while (!thread_pool_wait(pool, 10)) {}
        assert_int_equal(__atomic_load_n(&t->n_done, __ATOMIC_RELAXED), expected);
    }
    thread_pool_start(pool, count_piece, t, MOST_PIECES);
    while (!thread_pool_wait(pool, 10)) {}
    for (uint32_t i = 5; i < MOST_PIECES; i++) assert_int_equal(t->times[i], 1);
    assert_int_equal(t->n_bad_threads, 0);
    thread_pool_destroy(pool);
    free(t);
}

static void a_cancelled_job_ends_and_leaves_the_pool_usable(void **state)
{
    (void)state;
    tally *t = calloc(1, sizeof *t);
    thread_pool *pool = NULL;
    assert_non_null(t);
    t->n_threads = 3;
    assert_int_equal(thread_pool_create(3, NULL, &pool), FACET_OK);
    for (int round = 0; round < 100; round++) {
        memset(t->times, 0, sizeof t->times);
        thread_pool_start(pool, count_piece, t, MOST_PIECES);
        if (round%2) thread_pool_wait(pool, 1e-5);
        thread_pool_cancel(pool);
        while (!thread_pool_wait(pool, 10)) {}
        for (uint32_t i = 0; i < MOST_PIECES; i++) assert_true(t->times[i] <= 1);
    }
    memset(t->times, 0, sizeof t->times);
    thread_pool_start(pool, count_piece, t, 64);
    while (!thread_pool_wait(pool, 10)) {}
    for (uint32_t i = 0; i < 64; i++) assert_int_equal(t->times[i], 1);
    thread_pool_destroy(pool);
    /* Destroyed while a job runs: the pieces under way end, nothing is freed under them. */
    assert_int_equal(thread_pool_create(3, NULL, &pool), FACET_OK);
    thread_pool_start(pool, count_piece, t, MOST_PIECES);
    thread_pool_destroy(pool);
    free(t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
        cmocka_unit_test(a_crop_equals_its_part_of_the_picture),
        cmocka_unit_test(another_seed_gives_other_bits),
        cmocka_unit_test(a_render_that_is_stopped_gives_the_picture_of_the_passes_done),
        cmocka_unit_test(pools_come_and_go),
        cmocka_unit_test(many_small_jobs_do_each_piece_once),
        cmocka_unit_test(a_cancelled_job_ends_and_leaves_the_pool_usable),
    };
    return cmocka_run_group_tests_name("render_threads", tests, NULL, NULL);
}
