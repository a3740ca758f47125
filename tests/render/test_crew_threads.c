/* test_crew_threads.c: renders shared by several ranks, here threads of one process that pass messages through memory:
 * the bits of one process, whatever the number of ranks and their threads.  Small, because it also runs under thread
 * sanitizers.  tests/cli/test_mpi.c does the same with real processes.
 * SPDX-License-Identifier: MIT */
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "render/crew.h"
#include "tests/draws.h"
#include "tests/scene_builder.h"

enum { WIDTH = 71, HEIGHT = 53, N_PIXELS = WIDTH*HEIGHT, MOST_RANKS = 5, MOST_MESSAGES = 4096 };

/* ---- Messages through memory --------------------------------------------------------------------------------- */

typedef struct short_message {
    uint32_t from;
    uint64_t words[CREW_WORDS];
} short_message;

/* What is on its way to a rank. */
typedef struct mailbox {
    short_message messages[MOST_MESSAGES];
    size_t n_sent, n_taken;
    const void *bytes[MOST_RANKS]; /* offered by that rank, until it has been taken */
    size_t sizes[MOST_RANKS];
    bool is_offered[MOST_RANKS];
} mailbox;

typedef struct network {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    mailbox boxes[MOST_RANKS];
} network;

typedef struct station {
    network *net;
    uint32_t rank;
} station;

static void send_words(void *user, uint32_t to, const uint64_t words[CREW_WORDS])
{
    const station *own = user;
    mailbox *box = &own->net->boxes[to];
    pthread_mutex_lock(&own->net->lock);
    short_message *m = &box->messages[box->n_sent++%MOST_MESSAGES];
    m->from = own->rank;
    memcpy(m->words, words, sizeof m->words);
    pthread_mutex_unlock(&own->net->lock);
}

static bool receive_words(void *user, uint32_t *from, uint64_t words[CREW_WORDS])
{
    const station *own = user;
    mailbox *box = &own->net->boxes[own->rank];
    pthread_mutex_lock(&own->net->lock);
    const bool is_there = box->n_taken < box->n_sent;
    if (is_there) {
        const short_message *m = &box->messages[box->n_taken++%MOST_MESSAGES];
        *from = m->from;
        memcpy(words, m->words, sizeof m->words);
    }
    pthread_mutex_unlock(&own->net->lock);
    return is_there;
}

static size_t exchange_bytes(void *user, uint32_t to, const void *bytes, size_t n, uint32_t from, void *buffer,
                             size_t most)
{
    const station *own = user;
    network *net = own->net;
    size_t n_got = 0;
    pthread_mutex_lock(&net->lock);
    if (to != CREW_NOBODY) {
        mailbox *box = &net->boxes[to];
        box->bytes[own->rank] = bytes;
        box->sizes[own->rank] = n;
        box->is_offered[own->rank] = true;
        pthread_cond_broadcast(&net->changed);
    }
    if (from != CREW_NOBODY) {
        mailbox *box = &net->boxes[own->rank];
        while (!box->is_offered[from]) pthread_cond_wait(&net->changed, &net->lock);
        n_got = box->sizes[from];
        assert_true(n_got <= most);
        if (n_got) memcpy(buffer, box->bytes[from], n_got);
        box->is_offered[from] = false;
        pthread_cond_broadcast(&net->changed);
    }
    while (to != CREW_NOBODY && net->boxes[to].is_offered[own->rank]) pthread_cond_wait(&net->changed, &net->lock);
    pthread_mutex_unlock(&net->lock);
    return n_got;
}

/* ---- Ranks --------------------------------------------------------------------------------------------------- */

typedef struct rank_run {
    station place;
    crew crew;
    render_settings settings;
    render_state state;
    render_result result;
    facet_error why;
    facet_status status;
    uint32_t stop_after; /* calls of progress; 0: never */
    uint32_t n_told;
    const scene *scene;
} rank_run;

static bool count_and_stop(void *user, const render_progress *progress)
{
    rank_run *run = user;
    assert_true(progress->samples_done <= progress->samples_total);
    return !run->stop_after || ++run->n_told < run->stop_after;
}

static void *run_rank(void *user)
{
    rank_run *run = user;
    run->settings.crew = &run->crew;
    run->status = render_continue(run->scene, &run->settings, &run->state, &run->result, &run->why);
    return NULL;
}

/* Runs all ranks to their end; runs[0] may have a state to begin with. */
static void run_all(const scene *s, rank_run *runs, uint32_t n)
{
    pthread_t threads[MOST_RANKS];
    network *net = calloc(1, sizeof *net);
    assert_non_null(net);
    pthread_mutex_init(&net->lock, NULL);
    pthread_cond_init(&net->changed, NULL);
    for (uint32_t i = 0; i < n; i++) {
        runs[i].scene = s;
        runs[i].place = (station){net, i};
        runs[i].crew = (crew){.rank = i,
                              .n_ranks = n,
                              .user = &runs[i].place,
                              .send = send_words,
                              .receive = receive_words,
                              .exchange = exchange_bytes};
        snprintf(runs[i].crew.name, sizeof runs[i].crew.name, "host%u", i);
        assert_int_equal(pthread_create(&threads[i], NULL, run_rank, &runs[i]), 0);
    }
    for (uint32_t i = 0; i < n; i++) pthread_join(threads[i], NULL);
    pthread_cond_destroy(&net->changed);
    pthread_mutex_destroy(&net->lock);
    free(net);
}

static void destroy_all(rank_run *runs, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        render_result_destroy(&runs[i].result);
        render_state_destroy(&runs[i].state);
    }
}

static render_settings small_settings(uint32_t spp)
{
    render_settings r;
    render_settings_defaults(&r);
    r.width = WIDTH;
    r.height = HEIGHT;
    r.spp = spp;
    r.n_threads = 2;
    return r;
}

static void expect_same(const rank_run *leader, const render_state *whole, const render_result *expected)
{
    const render_state *made = &leader->state;
    assert_int_equal(leader->status, FACET_OK);
    assert_memory_equal(made->film.pixels, whole->film.pixels, N_PIXELS*sizeof *whole->film.pixels);
    assert_memory_equal(leader->result.picture.pixels, expected->picture.pixels, N_PIXELS*3*sizeof(float));
    assert_true(!made->film.features == !whole->film.features);
    if (made->film.features)
        assert_memory_equal(made->film.features, whole->film.features, N_PIXELS*sizeof *whole->film.features);
    assert_int_equal(made->spp, whole->spp);
    assert_int_equal(made->n_paths, whole->n_paths);
    assert_int_equal(made->n_rays, whole->n_rays);
    assert_int_equal(made->n_shadow_rays, whole->n_shadow_rays);
    assert_true(leader->result.noise == expected->noise);
}

/* ---- Claims -------------------------------------------------------------------------------------------------- */

/* On 1 to 5 ranks of 1 to 3 threads. */
static void compare_ranks(render_settings r)
{
    scene *s = build_ball_and_lamp();
    render_state whole = {0};
    render_result expected = {0};
    assert_int_equal(render_continue(s, &r, &whole, &expected, NULL), FACET_OK);
    for (uint32_t n = 1; n <= MOST_RANKS; n++) {
        rank_run runs[MOST_RANKS] = {0};
        for (uint32_t i = 0; i < n; i++) {
            runs[i].settings = r;
            runs[i].settings.n_threads = 1 + (i + n)%3;
        }
        run_all(s, runs, n);
        expect_same(&runs[0], &whole, &expected);
        assert_true(runs[0].result.is_complete == expected.is_complete);
        for (uint32_t i = 1; i < n; i++) {
            assert_int_equal(runs[i].status, FACET_OK);
            assert_null(runs[i].result.picture.pixels);
        }
        destroy_all(runs, n);
    }
    render_result_destroy(&expected);
    render_state_destroy(&whole);
    scene_destroy(s);
}

static void any_number_of_ranks_gives_the_bits_of_one_process(void **state)
{
    (void)state;
    compare_ranks(small_settings(SAMPLE_DIVISOR > 1 ? 5 : 37));
}

static void features_travel_with_the_films(void **state)
{
    (void)state;
    render_settings r = small_settings(SAMPLE_DIVISOR > 1 ? 3 : 9);
    r.keeps_features = true;
    compare_ranks(r);
}

static void a_crop_that_is_smaller_than_the_ranks_is_shared_too(void **state)
{
    (void)state;
    render_settings r = small_settings(SAMPLE_DIVISOR > 1 ? 5 : 40);
    scene *s = build_ball_and_lamp();
    r.crop_x = 30;
    r.crop_y = 20;
    r.crop_w = 3;
    r.crop_h = 1;
    render_state whole = {0};
    render_result expected = {0};
    assert_int_equal(render_continue(s, &r, &whole, &expected, NULL), FACET_OK);
    rank_run runs[MOST_RANKS] = {0};
    for (uint32_t i = 0; i < MOST_RANKS; i++) runs[i].settings = r;
    run_all(s, runs, MOST_RANKS);
    assert_int_equal(runs[0].status, FACET_OK);
    assert_memory_equal(runs[0].state.film.pixels, whole.film.pixels, 3*sizeof *whole.film.pixels);
    destroy_all(runs, MOST_RANKS);
    render_result_destroy(&expected);
    render_state_destroy(&whole);
    scene_destroy(s);
}

static void ignore_state(void *user, const render_state *state)
{
    (void)user;
    (void)state;
}

static void ranks_stop_at_the_same_noise(void **state)
{
    (void)state;
    render_settings r = small_settings(4096);
    r.noise_target = 0.15; /* tiles end after different passes */
    compare_ranks(r);
    r.save = ignore_state; /* the films are added up in the middle of passes, too, where nothing is to be judged */
    compare_ranks(r);
}

static void ranks_share_the_samples_of_a_shard(void **state)
{
    (void)state;
    render_settings r = small_settings(SAMPLE_DIVISOR > 1 ? 7 : 50);
    r.shard = 2;
    r.n_shards = 3;
    compare_ranks(r);
}

/* A state that each save leaves, of which the last is kept. */
static void keep_state(void *user, const render_state *state)
{
    rank_run *run = user;
    assert_int_equal(run->crew.rank, 0); /* the others are never asked */
    assert_true(state->film.pixels == run->state.film.pixels);
}

/* Stopped after some reports of progress, by the leader or by another, and continued by other ranks until the end. */
static void a_render_that_ranks_stop_and_continue_ends_the_same(void **state)
{
    (void)state;
    scene *s = build_ball_and_lamp();
    render_settings r = small_settings(SAMPLE_DIVISOR > 1 ? 60 : 2000);
    render_state whole = {0}, made = {0};
    render_result expected = {0};
    draws d = {1};
    uint32_t n_runs = 0, n_stopped = 0;
    assert_int_equal(render_continue(s, &r, &whole, &expected, NULL), FACET_OK);
    for (bool is_complete = false; !is_complete; n_runs++) {
        const uint32_t n = 1 + (uint32_t)(draw_bits(&d)%MOST_RANKS), who = (uint32_t)(draw_bits(&d)%n);
        rank_run runs[MOST_RANKS] = {0};
        for (uint32_t i = 0; i < n; i++) {
            runs[i].settings = r;
            runs[i].settings.progress = count_and_stop;
            runs[i].settings.save = keep_state;
            runs[i].settings.save_interval = 0.02;
            runs[i].settings.user = &runs[i];
        }
        runs[who].stop_after = 1;
        runs[0].state = made;
        run_all(s, runs, n);
        made = runs[0].state;
        is_complete = runs[0].result.is_complete;
        assert_true(is_complete || runs[0].result.is_stopped);
        n_stopped += !is_complete;
        if (is_complete) expect_same(&runs[0], &whole, &expected);
        runs[0].state = (render_state){0};
        destroy_all(runs, n);
        assert_true(n_runs < 1000);
    }
    if (SAMPLE_DIVISOR == 1) assert_true(n_stopped > 1);
    render_state_destroy(&made);
    render_result_destroy(&expected);
    render_state_destroy(&whole);
    scene_destroy(s);
}

static void ranks_that_differ_are_refused_by_all(void **state)
{
    (void)state;
    scene *s = build_ball_and_lamp();
    static const struct {
        uint32_t rank;
        const char *isa;
        uint32_t seed, width;
        const char *reason;
    } cases[] = {{2, NULL, 1, WIDTH, "rank 2 (host2) renders another scene or has other options"},
                 {1, NULL, 0, WIDTH + 1, "rank 1 (host1) renders another scene or has other options"},
                 {1, "sse2", 0, WIDTH, "rank 1 (host1) would use sse2 and this one "},
                 {2, NULL, 0, 0, "on rank 2 (host2): 0x53; give 1 to 65536 pixels a side"},
                 {0, NULL, 0, 0, "0x53; give 1 to 65536 pixels a side"}};
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        rank_run runs[3] = {0};
        for (uint32_t k = 0; k < 3; k++) {
            runs[k].settings = small_settings(2);
            runs[k].settings.isa = cases[i].isa ? "avx" : NULL;
            if (k != cases[i].rank) continue;
            runs[k].settings.width = cases[i].width;
            runs[k].settings.seed = cases[i].seed;
            if (cases[i].isa) runs[k].settings.isa = cases[i].isa;
        }
        run_all(s, runs, 3);
        for (uint32_t k = 0; k < 3; k++) assert_int_not_equal(runs[k].status, FACET_OK);
        if (!strstr(runs[0].why.text, cases[i].reason))
            fail_msg("case %zu: `%s`, expected `%s`", i, runs[0].why.text, cases[i].reason);
        destroy_all(runs, 3);
    }
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_number_of_ranks_gives_the_bits_of_one_process),
        cmocka_unit_test(features_travel_with_the_films),
        cmocka_unit_test(a_crop_that_is_smaller_than_the_ranks_is_shared_too),
        cmocka_unit_test(ranks_stop_at_the_same_noise),
        cmocka_unit_test(ranks_share_the_samples_of_a_shard),
        cmocka_unit_test(a_render_that_ranks_stop_and_continue_ends_the_same),
        cmocka_unit_test(ranks_that_differ_are_refused_by_all),
    };
    return cmocka_run_group_tests_name("crew_threads", tests, NULL, NULL);
}
