/* test_light_tree.c: lights are drawn from the tree as often as it says, and none that shines at a point is left out.
 * SPDX-License-Identifier: MIT */
#include "render/light_tree.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/loops.h"
#include "tests/draws.h"
#include "tests/receiver_block.h"
#include "tests/scene_builder.h"
#include "verify/chi_square.h"

enum { MOST = 3000 };

typedef enum kind { ONE_SIDED, TWO_SIDED, SPOTS, ALL_AROUND, MIXED, N_KINDS } kind;

static float between(draws *d, double low, double high)
{
    return (float)draw_between(d, low, high);
}

static real3 point_within(draws *d, double extent)
{
    const float x = between(d, -extent, extent), y = between(d, -extent, extent);
    return make3(x, y, between(d, -extent, extent));
}

static real3 direction(draws *d)
{
    double v[3];
    draw_direction(d, v);
    const float sign = draw_bits(d) & 1 ? 1.0f : -1.0f;
    return make3((float)v[0], (float)v[1], sign*(float)v[2]);
}

/* A light of one point of its box, anywhere in a cube of two metres; intensities span six decades. */
static placed_light random_light(draws *d, kind k)
{
    if (k == MIXED) k = (kind)(draw_bits(d)%MIXED);
    const float size = (float)draw_log(d, 1e-6, .5);
    placed_light light = {.low = point_within(d, 1), .intensity = (float)draw_log(d, 1e-3, 1e3)};
    light.high = k == SPOTS ? light.low : add3(light.low, make3(size, size*between(d, 0, 1), size));
    if (k != ALL_AROUND) light.axis = direction(d);
    if (k == SPOTS) light.cos_spread = between(d, 0, 1);
    light.is_double_sided = k == TWO_SIDED;
    return light;
}

static light_tree tree_of(const placed_light *lights, uint32_t n)
{
    light_tree tree;
    assert_int_equal(light_tree_create(lights, n, &tree), FACET_OK);
    return tree;
}

/* Among the lights, and 10^4 times as far away as they are from each other. */
static real3 random_point(draws *d)
{
    return point_within(d, draw_log(d, .1, 1e4));
}

/* ... as it is, or on a surface of any normal with lobes of any width. */
static light_receiver random_receiver(draws *d)
{
    light_receiver to = receiver_anywhere(random_point(d));
    if (draw_bits(d) & 1) return to;
    to.normal = direction(d);
    to.mirror = direction(d);
    to.around = RECEIVED_AROUND;
    to.broad = between(d, 0, 0.3);
    to.width = (float)draw_log(d, 1e-8, 1);
    to.peak = between(d, 0, 1)/to.width;
    return to;
}

/* Rounding: a part in 10^7 for each weight of a sum of eight, on eight levels. */
static double sum_of_probabilities(const light_tree *tree, uint32_t n, const light_receiver *to, double *each)
{
    double sum = 0;
    for (uint32_t i = 0; i < n; i++) sum += each[i] = light_tree_probability(tree, to, i);
    assert_true(sum < 1 + 1e-5);
    return sum;
}

static void probabilities_add_up_to_one(void **state)
{
    (void)state;
    static placed_light lights[MOST];
    static double each[MOST];
    draws d = {1};
    for (kind k = ONE_SIDED; k < N_KINDS; k++)
        for (uint32_t n = 1; n <= MOST; n = n*3 + 1) {
            for (uint32_t i = 0; i < n; i++) lights[i] = random_light(&d, k);
            light_tree tree = tree_of(lights, n);
            for (int i = 0; i < 4 + 96/SAMPLE_DIVISOR; i++) {
                const light_receiver to = i == 0 ? receiver_anywhere(lights[0].low) : random_receiver(&d);
                const double sum = sum_of_probabilities(&tree, n, &to, each);
                /* Elsewhere what lacks is the chance of a node that proves dark only when it is opened. */
                if (k == ALL_AROUND && to.around == 1) assert_true(sum > 1 - 1e-5);
            }
            light_tree_destroy(&tree);
        }
}

static void draws_follow_the_probabilities(void **state)
{
    (void)state;
    enum { N = 300, COUNT = 100000/SAMPLE_DIVISOR };
    static placed_light lights[N];
    static double expected[N + 1], observed[N + 1];
    draws d = {2};
    for (kind k = ONE_SIDED; k < N_KINDS; k++)
        for (int i = 0; i < 8; i++) {
            for (uint32_t j = 0; j < N; j++) lights[j] = random_light(&d, k);
            light_tree tree = tree_of(lights, N);
            const light_receiver to = random_receiver(&d);
            expected[N] = fmax(1 - sum_of_probabilities(&tree, N, &to, expected), 1e-5);
            for (int j = 0; j <= N; j++) {
                expected[j] *= COUNT;
                observed[j] = 0;
            }
            for (int j = 0; j < COUNT; j++) {
                double u = draw(&d) + draw(&d)*0x1p-24;
                uint32_t light = N;
                const double probability = light_tree_draw(&tree, &to, &u, &light);
                assert_true(u >= 0 && u < 1);
                observed[probability > 0 ? light : N]++;
                if (!(probability > 0)) continue;
                const double told = light_tree_probability(&tree, &to, light);
                assert_true(fabs(told - probability) <= 1e-14*probability); /* the factors in another order */
            }
            const chi_square c = chi_square_test(expected, observed, N + 1);
            assert_true(c.p > sidak_level(1e-3, N_KINDS*8));
            light_tree_destroy(&tree);
        }
}

/* What is left of the number that drew a light is as uniform as the number was. */
static void the_rest_is_uniform(void **state)
{
    (void)state;
    enum { N = 40, COUNT = 100000/SAMPLE_DIVISOR, CELLS = 16 };
    placed_light lights[N];
    double expected[CELLS], observed[CELLS] = {0};
    draws d = {3};
    for (uint32_t i = 0; i < N; i++) lights[i] = random_light(&d, ALL_AROUND);
    light_tree tree = tree_of(lights, N);
    const light_receiver to = receiver_anywhere(make3(.1f, 3, .2f));
    for (int i = 0; i < COUNT; i++) {
        double u = draw(&d) + draw(&d)*0x1p-24;
        uint32_t light;
        assert_true(light_tree_draw(&tree, &to, &u, &light) > 0);
        observed[(int)(u*CELLS)]++;
    }
    for (int i = 0; i < CELLS; i++) expected[i] = (double)COUNT/CELLS;
    assert_true(chi_square_test(expected, observed, CELLS).p > 1e-3);
    light_tree_destroy(&tree);
}

/* A walk of many points, as light_tree_draw of each, but that what is distant has the upper part of the numbers. */
static void walks_share_numbers_with_what_is_distant(void **state)
{
    (void)state;
    enum { N = 300 };
    static placed_light lights[N];
    static receiver_block block;
    draws d = {11};
    for (uint32_t i = 0; i < N; i++) lights[i] = random_light(&d, MIXED);
    light_tree tree = tree_of(lights, N);
    int n_distant = 0, n_placed = 0;
    for (int round = 0; round < 100; round++) {
        float distant[LOOP_LANES], probability[LOOP_LANES];
        double number[LOOP_LANES], u[LOOP_LANES];
        uint32_t which[LOOP_LANES];
        for (size_t i = 0; i < LOOP_LANES; i++) {
            const light_receiver to = random_receiver(&d);
            put_receiver(&block, i, &to);
            distant[i] = i%4 == 0 ? 0 : light_tree_weight(&tree, &to)*(float)draw_log(&d, 1e-2, 1e2);
            u[i] = number[i] = draw(&d) + draw(&d)*0x1p-24;
        }
        const light_choices c = {which, probability, u};
        render_loops_chosen()->walk_light_tree(&tree, LOOP_LANES, receivers_in(&block), distant, c);
        for (size_t i = 0; i < LOOP_LANES; i++) {
            light_receiver to = receiver_at(receivers_in(&block), i);
            const double told = (double)to.weight;
            to.weight = 0;
            const double sum = (double)light_tree_weight(&tree, &to), all = sum + (double)distant[i];
            assert_true(told == sum);
            if (!(all > 0)) {
                assert_true(probability[i] == 0);
                continue;
            }
            double rest = sum > 0 ? number[i]*all/sum : 1, share = sum/all;
            uint32_t light = 0;
            if (rest < 1) {
                const double drawn = light_tree_draw(&tree, &to, &rest, &light);
                share *= drawn;
                n_placed += drawn > 0;
            } else {
                rest = (number[i]*all - sum)/(double)distant[i];
                share = (double)distant[i]/all;
                light = LIGHT_DISTANT;
                n_distant++;
            }
            /* Sums and shares are floats; one more bit for the quotient. */
            assert_true(fabs((double)probability[i] - share) <= 2.4e-7*share);
            if (!(share > 0)) continue;
            assert_int_equal(which[i], light);
            assert_true(u[i] >= 0 && u[i] < 1 && (light != LIGHT_DISTANT || fabs(u[i] - rest) < 1e-4));
        }
    }
    assert_true(n_distant > 1000 && n_placed > 1000);
    light_tree_destroy(&tree);
}

/* Where the tree's weight is known already, probabilities are the same. */
static void a_known_weight_changes_no_probability(void **state)
{
    (void)state;
    enum { N = 300 };
    static placed_light lights[N];
    draws d = {12};
    for (uint32_t i = 0; i < N; i++) lights[i] = random_light(&d, MIXED);
    light_tree tree = tree_of(lights, N);
    for (int round = 0; round < 100; round++) {
        const light_receiver to = random_receiver(&d);
        light_receiver knows = to;
        knows.weight = light_tree_weight(&tree, &to);
        for (uint32_t i = 0; i < N; i++) {
            const double p = light_tree_probability(&tree, &to, i);
            assert_true(fabs(light_tree_probability(&tree, &knows, i) - p) <= 6e-8*p); /* the weight is a float */
        }
    }
    light_tree_destroy(&tree);
}

/* The cosine between a light's axis and the direction from a point of it to `to`. */
static double cosine_at(const placed_light *light, real3 at, real3 to)
{
    const double x = (double)to.x - (double)at.x, y = (double)to.y - (double)at.y, z = (double)to.z - (double)at.z;
    const double cos = (x*(double)light->axis.x + y*(double)light->axis.y + z*(double)light->axis.z)/
                       sqrt(x*x + y*y + z*z);
    return light->is_double_sided ? fabs(cos) : cos;
}

static real3 point_of(const placed_light *light, draws *d)
{
    const real3 size = sub3(light->high, light->low);
    const float x = between(d, 0, 1)*size.x, y = between(d, 0, 1)*size.y;
    return min3(add3(light->low, make3(x, y, between(d, 0, 1)*size.z)), light->high);
}

static bool is_above(const light_receiver *to, real3 at)
{
    const double x = (double)at.x - (double)to->position.x, y = (double)at.y - (double)to->position.y,
                 z = (double)at.z - (double)to->position.z;
    return to->around == 1 || x*(double)to->normal.x + y*(double)to->normal.y + z*(double)to->normal.z > 0;
}

static void lights_that_shine_at_a_point_can_be_drawn(void **state)
{
    (void)state;
    static placed_light lights[MOST];
    draws d = {4};
    int n_lit = 0, n_spared = 0;
    for (kind k = ONE_SIDED; k < N_KINDS; k++)
        for (uint32_t n = 1; n <= MOST; n = n*5 + 2) {
            for (uint32_t i = 0; i < n; i++) lights[i] = random_light(&d, k);
            light_tree tree = tree_of(lights, n);
            for (int i = 0; i < 20000/SAMPLE_DIVISOR; i++) {
                const uint32_t which = (uint32_t)(draw_bits(&d)%n);
                const placed_light *light = &lights[which];
                const real3 at = point_of(light, &d);
                light_receiver to = random_receiver(&d);
                real3 from = to.position;
                if (i%4 == 0 && max_abs3(light->axis) > 0) { /* grazing: barely within the spread */
                    const frame f = frame_of_normal(light->axis);
                    const float cos = light->cos_spread, sin = ksqrt(1 - cos*cos), far = between(&d, .1, 10);
                    from = add3(at, scale3(far, add3(scale3(sin, f.t), scale3(cos*1.0001f + 1e-6f, f.n))));
                }
                if (i%3 == 0 && to.around < 1) { /* ... barely above the horizon */
                    const frame f = frame_of_normal(normalize3(sub3(at, from)));
                    to.normal = normalize3(madd3(f.t, 1e-6f, f.n));
                }
                to.position = from;
                const double probability = light_tree_probability(&tree, &to, which);
                const double cos = max_abs3(light->axis) > 0 ? cosine_at(light, at, from) : 1;
                const bool is_lit = cos > (double)light->cos_spread && is_above(&to, at);
                if (is_lit && !(probability > 0))
                    fail_msg("kind %d, %u lights: light %u, cosine %a, from %a %a %a", (int)k, n, which, cos,
                             (double)from.x, (double)from.y, (double)from.z);
                n_lit += is_lit;
                n_spared += !(probability > 0);
            }
            light_tree_destroy(&tree);
        }
    print_message("  %d lit, %d proven dark\n", n_lit, n_spared);
    assert_true(n_lit > 1000/SAMPLE_DIVISOR && n_spared > 1000/SAMPLE_DIVISOR);
}

/* A ring of equal lights above a surface. */
static void a_surface_draws_the_light_that_it_mirrors(void **state)
{
    (void)state;
    enum { N = 8 };
    placed_light lights[N] = {0};
    for (uint32_t i = 0; i < N; i++) {
        const real2 azimuth = kcossin_turn((float)i/(float)N);
        lights[i].low = lights[i].high = make3(azimuth.x, azimuth.y, 1);
        lights[i].intensity = 1;
    }
    light_tree tree = tree_of(lights, N);
    light_receiver to = receiver_anywhere(splat3(0));
    for (uint32_t i = 0; i < N; i++) assert_true(fabs(light_tree_probability(&tree, &to, i) - 1.0/N) < 1e-6);
    to.normal = make3(0, 0, 1);
    to.mirror = normalize3(lights[3].low);
    to.around = RECEIVED_AROUND;
    to.width = 0.01f;
    to.peak = 1/(FOUR_PI*to.width);
    assert_true(light_tree_probability(&tree, &to, 3) > 0.95);
    to.peak = 0;
    to.broad = INV_PI;
    to.normal = make3(1, 0, 0); /* the first is overhead, the fifth below the horizon */
    assert_true(light_tree_probability(&tree, &to, 0) > light_tree_probability(&tree, &to, 1));
    assert_true(light_tree_probability(&tree, &to, 4) == 0);
    light_tree_destroy(&tree);
}

static void the_same_lights_give_the_same_tree(void **state)
{
    (void)state;
    static placed_light lights[MOST];
    draws d = {5};
    for (uint32_t i = 0; i < MOST; i++) lights[i] = random_light(&d, MIXED);
    light_tree a = tree_of(lights, MOST), b = tree_of(lights, MOST);
    assert_int_equal(a.n_nodes, b.n_nodes);
    assert_memory_equal(a.nodes, b.nodes, a.n_nodes*sizeof *a.nodes);
    assert_memory_equal(a.place, b.place, MOST*sizeof *a.place);
    light_tree_destroy(&a);
    light_tree_destroy(&b);
}

/* Every light has a positive probability at a point outside, and all probabilities add up to one. */
static void expect_all(const placed_light *lights, uint32_t n, real3 from)
{
    light_tree tree = tree_of(lights, n);
    const light_receiver to = receiver_anywhere(from);
    double sum = 0;
    for (uint32_t i = 0; i < n; i++) {
        const double p = light_tree_probability(&tree, &to, i);
        assert_true(lights[i].intensity > 0 ? p > 0 : p == 0);
        sum += p;
    }
    assert_true(fabs(sum - 1) < 1e-5);
    light_tree_destroy(&tree);
}

static void odd_sets_of_lights_are_served(void **state)
{
    (void)state;
    enum { N = 100000 };
    placed_light *lights = calloc(N, sizeof *lights);
    assert_non_null(lights);
    for (uint32_t i = 0; i < N; i++) lights[i].intensity = 1;
    expect_all(lights, N, make3(0, 1, 0)); /* all at one point */
    expect_all(lights, N, splat3(0));      /* ... and seen from there */
    expect_all(lights, 1, make3(0, 1, 0));
    for (uint32_t i = 0; i < N; i++) lights[i].intensity = i%3 == 0 ? 0.0f : 1.0f;
    for (uint32_t i = 0; i < N; i++) lights[i].low.x = lights[i].high.x = ldexpf(1, (int)(i%250) - 125);
    expect_all(lights, 250, make3(0, 1, 0)); /* ever nearer to each other */
    expect_all(lights, N, make3(0, 1, 0));
    for (uint32_t i = 0; i < N; i++) lights[i].low = splat3(-1e38f);
    for (uint32_t i = 0; i < N; i++) lights[i].high = splat3(1e38f);
    expect_all(lights, N, make3(0, 1, 0)); /* larger than numbers */

    for (uint32_t i = 0; i < N; i++) lights[i].intensity = 0;
    light_tree tree = tree_of(lights, N); /* dark */
    const light_receiver to = receiver_anywhere(splat3(0));
    double u = .5;
    uint32_t light;
    assert_true(light_tree_draw(&tree, &to, &u, &light) == 0);
    assert_true(light_tree_weight(&tree, &to) == 0);
    assert_true(light_tree_probability(&tree, &to, 7) == 0);
    light_tree_destroy(&tree);
    free(lights);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(probabilities_add_up_to_one),
        cmocka_unit_test(draws_follow_the_probabilities),
        cmocka_unit_test(the_rest_is_uniform),
        cmocka_unit_test(walks_share_numbers_with_what_is_distant),
        cmocka_unit_test(a_known_weight_changes_no_probability),
        cmocka_unit_test(lights_that_shine_at_a_point_can_be_drawn),
        cmocka_unit_test(a_surface_draws_the_light_that_it_mirrors),
        cmocka_unit_test(the_same_lights_give_the_same_tree),
        cmocka_unit_test(odd_sets_of_lights_are_served),
    };
    return cmocka_run_group_tests_name("light_tree", tests, NULL, NULL);
}
