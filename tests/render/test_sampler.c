/* test_sampler.c: the numbers that place paths are well spread, uniform, independent of each other and repeatable.
 *
 * (0,2): of the first 2^k points each box of 2^-a by 2^-(k-a) holds exactly one.  [sobol67], [burley20].
 * SPDX-License-Identifier: MIT */
#include "render/sampler.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "render/loops.h"
#include "tests/scene_builder.h"
#include "verify/chi_square.h"

static sample_point point_of(const sampler *s, uint32_t x, uint32_t y, uint32_t index, uint32_t group)
{
    return sampler_point(s, sampler_start(s, x, y, index), group);
}

/* Boxes of all shapes for the first 2^k points in dimensions d and e; returns the number of boxes that do not hold
 * exactly one. */
static int misplaced(const sampler *s, uint32_t x, uint32_t group, int k, int d, int e)
{
    enum { MOST = 1024 };
    int n_wrong = 0;
    for (int a = 0; a <= k; a++) {
        uint8_t count[MOST] = {0};
        for (uint32_t i = 0; i < 1u << k; i++) {
            const sample_point p = point_of(s, x, 5, i, group);
            const uint64_t column = (uint64_t)p.u[d] >> (32 - a), row = (uint64_t)p.u[e] >> (32 - (k - a));
            count[column << (k - a) | row]++;
        }
        for (uint32_t i = 0; i < 1u << k; i++) n_wrong += count[i] != 1;
    }
    return n_wrong;
}

/* Shuffling the order and scrambling the digits keep the strata: of the whole set in the first two dimensions, and of
 * each dimension alone.  The third together with another is no (0,2) sequence: it
 * is checked alone. */
static void each_group_is_stratified(void **state)
{
    (void)state;
    for (int k = 0; k <= 10; k++) {
        const sampler s = sampler_create(SAMPLER_SOBOL, 17, 1u << k);
        for (uint32_t group = 0; group < 8; group++) assert_int_equal(misplaced(&s, group*7, group, k, 0, 1), 0);
        for (int d = 0; d < 3; d++) {
            uint8_t count[1024] = {0};
            for (uint32_t i = 0; i < 1u << k; i++) count[(uint64_t)point_of(&s, 1, 2, i, 3).u[d] >> (32 - k)]++;
            for (uint32_t i = 0; i < 1u << k; i++) assert_int_equal(count[i], 1);
        }
    }
}

/* From 2^21 samples on an index has all of 32 digits: a square's pixels share as many points as there can be. */
static void the_most_samples_have_numbers_of_their_own(void **state)
{
    (void)state;
    static const uint32_t spps[] = {1u << 21, (1u << 21) + 1, 1u << 22, 1u << 23, (1u << 23) + 1, 1u << 24};
    for (size_t i = 0; i < sizeof spps/sizeof *spps; i++) {
        const sampler s = sampler_create(SAMPLER_SOBOL, 17, spps[i]);
        enum { N = 4096, CELLS = 16 };
        double expected[CELLS], observed[3][CELLS] = {{0}};
        for (uint32_t k = 0; k < N; k++) {
            const sample_point p = point_of(&s, k%5, k%7, spps[i]/N*k + spps[i]%N, 3);
            for (int d = 0; d < 3; d++) observed[d][p.u[d]/(UINT32_MAX/CELLS + 1)]++;
        }
        for (int k = 0; k < CELLS; k++) expected[k] = (double)N/CELLS;
        /* Better spread than independent numbers: the test can fail by cells that are left out alone. */
        for (int d = 0; d < 3; d++) assert_true(chi_square_test(expected, observed[d], CELLS).p > 1e-3);
    }
}

/* The shuffle keeps strata of the order, too: each aligned run of 2^j samples is itself stratified, so that a picture
 * that is stopped early is as good as one that was meant to be short. */
static void each_aligned_run_is_stratified(void **state)
{
    (void)state;
    const sampler s = sampler_create(SAMPLER_SOBOL, 17, 256);
    for (uint32_t j = 1; j <= 8; j++)
        for (uint32_t start = 0; start < 256; start += 1u << j) {
            uint8_t count[256] = {0};
            for (uint32_t i = 0; i < 1u << j; i++) count[point_of(&s, 3, 4, start + i, 2).u[0] >> (32 - j)]++;
            for (uint32_t i = 0; i < 1u << j; i++) assert_int_equal(count[i], 1);
        }
}

/* Each aligned square of pixels holds a whole set, too: neighbours complement each other. */
static void squares_of_pixels_are_stratified_together(void **state)
{
    (void)state;
    for (uint32_t side = 2; side <= 16; side *= 2)
        for (uint32_t spp = 1; spp*side*side <= 1024; spp *= 4) {
            const sampler s = sampler_create(SAMPLER_SOBOL, 17, spp);
            const uint32_t n = spp*side*side;
            int k = 0;
            while (1u << k < n) k++;
            for (int a = 0; a <= k; a++) {
                uint8_t count[1024] = {0};
                for (uint32_t i = 0; i < n; i++) {
                    const sample_point p = point_of(&s, 48 + i%side, 80 + i/side%side, i/side/side, 3);
                    count[((uint64_t)p.u[0] >> (32 - a)) << (k - a) | (uint64_t)p.u[1] >> (32 - (k - a))]++;
                }
                for (uint32_t i = 0; i < n; i++) assert_int_equal(count[i], 1);
            }
        }
}

/* The error of an integral that each pixel estimates from one sample: sums over squares of pixels have less of it than
 * as many independent samples have. */
static void errors_of_neighbours_cancel(void **state)
{
    (void)state;
    enum { SIDE = 64, BLOCK_SIDE = 4 };
    const sampler s = sampler_create(SAMPLER_SOBOL, 4, 1);
    double squares = 0, of_blocks = 0, sums[SIDE/BLOCK_SIDE][SIDE/BLOCK_SIDE] = {{0}};
    for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 0; x < SIDE; x++) {
            const sample_point p = point_of(&s, x, y, 0, 2);
            const double u = p.u[0]*0x1p-32, v = p.u[1]*0x1p-32, error = 4*u*v - 1;
            squares += error*error/SIDE/SIDE;
            sums[y/BLOCK_SIDE][x/BLOCK_SIDE] += error/BLOCK_SIDE/BLOCK_SIDE;
        }
    for (int i = 0; i < SIDE*SIDE/BLOCK_SIDE/BLOCK_SIDE; i++) of_blocks += pow((&sums[0][0])[i], 2);
    of_blocks /= SIDE*SIDE/BLOCK_SIDE/BLOCK_SIDE;
    assert_true(fabs(squares/(7/9.0) - 1) < 0.1);               /* of one sample */
    assert_true(of_blocks < 0.1*squares/BLOCK_SIDE/BLOCK_SIDE); /* a tenth of independent ones' variance */
}

/* Without scrambling the sets of two pixels would be equal up to order: their points differ in the last digits. */
static void scrambling_moves_points_inside_their_strata(void **state)
{
    (void)state;
    const sampler s = sampler_create(SAMPLER_SOBOL, 1, 16);
    int n_equal = 0;
    for (uint32_t i = 0; i < 16; i++)
        for (uint32_t j = 0; j < 16; j++) n_equal += point_of(&s, 0, 0, i, 0).u[0] == point_of(&s, 1, 0, j, 0).u[0];
    assert_int_equal(n_equal, 0);
}

/* Over pixels, each number of each group is uniform: chi-square over 64 cells. */
static void numbers_are_uniform(void **state)
{
    (void)state;
    enum { CELLS = 64, GROUPS = 10 };
    const double level = sidak_level(0.01, 2*GROUPS*3);
    for (sampler_kind kind = SAMPLER_SOBOL; kind <= SAMPLER_RANDOM; kind++) {
        const sampler s = sampler_create(kind, 2, 4);
        for (uint32_t group = 0; group < GROUPS; group++)
            for (int d = 0; d < 3; d++) {
                double expected[CELLS], observed[CELLS] = {0};
                /* One sample of each pixel: those of one pixel are not independent. */
                for (uint32_t i = 0; i < 10000; i++) observed[point_of(&s, i%100, i/100, 1, group).u[d] >> 26]++;
                for (int i = 0; i < CELLS; i++) expected[i] = 10000.0/CELLS;
                const chi_square c = chi_square_test(expected, observed, CELLS);
                if (c.p < level) fail_msg("sampler %d, group %u, dimension %d: p = %g", kind, group, d, c.p);
            }
    }
}

/* The correlation of two numbers over n pixels has the standard deviation 1/sqrt(n). */
static double correlation(const sampler *s, uint32_t dx, uint32_t index, uint32_t group_a, uint32_t group_b, int d,
                          int e)
{
    enum { SIDE = 100 };
    double sum = 0;
    for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 0; x < SIDE; x++) {
            const double a = point_of(s, x, y, 0, group_a).u[d]*0x1p-32 - 0.5;
            const double b = point_of(s, x + dx, y, index, group_b).u[e]*0x1p-32 - 0.5;
            sum += a*b;
        }
    return sum*12/SIDE/SIDE;
}

static void groups_and_pixels_are_uncorrelated(void **state)
{
    (void)state;
    double worst = 0;
    int n = 0;
    for (sampler_kind kind = SAMPLER_SOBOL; kind <= SAMPLER_RANDOM; kind++) {
        const sampler s = sampler_create(kind, 2, 16);
        for (int d = 0; d < 3; d++)
            for (int e = 0; e < 3; e++) {
                for (uint32_t group = 1; group < 5; group++, n++) /* between groups */
                    worst = fmax(worst, fabs(correlation(&s, 0, 0, 0, group, d, e)));
                for (uint32_t dx = 32; dx < 128; dx += 32, n++) /* between pixels of different squares */
                    worst = fmax(worst, fabs(correlation(&s, dx, 0, 2, 2, d, e)));
                if (d != e) worst = fmax(worst, fabs(correlation(&s, 0, 0, 2, 2, d, e))), n++; /* inside a point */
                if (kind == SAMPLER_RANDOM) worst = fmax(worst, fabs(correlation(&s, 0, 1, 2, 2, d, e))), n++;
            }
    }
    print_message("  largest of %d correlations: %.4f\n", n, worst);
    assert_true(erfc(worst*100/sqrt(2)) > sidak_level(0.01, n));
}

/* In a pixel, the pairs of numbers of two groups fill the square although each group is stratified.  Both margins are
 * exact, so chi-square of an even filling has (SIDE - 1)^2 degrees of freedom, which is its mean; what correlation the
 * hash leaves takes the mean to 56.  If the stratum in one group determined that in the other, the mean would be
 * (SIDE - 1) COUNT. */
static void pairs_across_groups_fill_the_square(void **state)
{
    (void)state;
    enum { SIDE = 8, COUNT = 1024, PIXELS = 40, GROUPS = 5 };
    const sampler s = sampler_create(SAMPLER_SOBOL, 9, COUNT);
    double mean = 0;
    for (uint32_t x = 0; x < PIXELS; x++)
        for (uint32_t group = 1; group <= GROUPS; group++) {
            double observed[SIDE*SIDE] = {0};
            for (uint32_t i = 0; i < COUNT; i++)
                observed[(point_of(&s, x, 0, i, 0).u[0] >> 29)*SIDE + (point_of(&s, x, 0, i, group).u[0] >> 29)]++;
            const double expected = (double)COUNT/SIDE/SIDE;
            for (int i = 0; i < SIDE*SIDE; i++)
                mean += (observed[i] - expected)*(observed[i] - expected)/expected/PIXELS/GROUPS;
        }
    print_message("  mean chi-square of pairs: %.1f (%d)\n", mean, (SIDE - 1)*(SIDE - 1));
    assert_true(mean < 1.5*(SIDE - 1)*(SIDE - 1));
}

/* The mean of a product over two groups converges in each pixel, and faster than with independent numbers
 * (whose error is sqrt(7/9/n)). */
static void products_across_groups_converge(void **state)
{
    (void)state;
    enum { PIXELS = 200, COUNT = 256 };
    const sampler s = sampler_create(SAMPLER_SOBOL, 1, COUNT);
    double squares = 0;
    for (uint32_t x = 0; x < PIXELS; x++) {
        double sum = 0;
        for (uint32_t i = 0; i < COUNT; i++)
            sum += 4*(point_of(&s, x, 1, i, 1).u[0]*0x1p-32)*(point_of(&s, x, 1, i, 2).u[0]*0x1p-32);
        squares += (sum/COUNT - 1)*(sum/COUNT - 1)/PIXELS;
    }
    assert_true(sqrt(squares) < 0.6*sqrt(7/9.0/COUNT));
}

/* A number is a function of seed, pixel, sample and group; more samples per pixel keep those of a shorter run only
 * when the count stays within the same power of two. */
static void numbers_are_repeatable(void **state)
{
    (void)state;
    for (sampler_kind kind = SAMPLER_SOBOL; kind <= SAMPLER_RANDOM; kind++) {
        const sampler a = sampler_create(kind, 5, 33), b = sampler_create(kind, 5, 64), c = sampler_create(kind, 6, 64);
        int n_equal = 0;
        for (uint32_t i = 0; i < 33; i++) {
            const sample_point p = point_of(&a, 10, 20, i, 4), q = point_of(&b, 10, 20, i, 4),
                               r = point_of(&c, 10, 20, i, 4);
            assert_memory_equal(&p, &q, sizeof p);
            for (int d = 0; d < 3; d++) n_equal += p.u[d] == r.u[d];
        }
        assert_int_equal(n_equal, 0);
    }
    assert_int_equal(sampler_create(SAMPLER_SOBOL, 0, 1).index_mask, (1u << 10) - 1);
    assert_int_equal(sampler_create(SAMPLER_SOBOL, 0, 3).index_mask, (1u << 12) - 1);
    assert_int_equal(sampler_create(SAMPLER_SOBOL, 0, 1u << 24).index_mask, UINT32_MAX); /* squares of 16 x 16 */
}

static void a_fraction_stays_below_one(void **state)
{
    (void)state;
    assert_true(fraction(0) == 0);
    assert_true(fraction(UINT32_MAX) == 1 - 0x1p-24f);
    assert_true(fraction(0x80000000u) == 0.5f);
}

/* 150 of many streams at once, on every instruction set, and each alone. */
static void a_point_does_not_depend_on_its_place_or_the_instruction_set(void **state)
{
    (void)state;
    enum { N = 150, WHOLE = (N + LOOP_LANES - 1)/LOOP_LANES*LOOP_LANES };
    for (int kind = SAMPLER_SOBOL; kind <= SAMPLER_RANDOM; kind++) {
        const sampler s = sampler_create((sampler_kind)kind, 3, 1000);
        uint32_t pixel[WHOLE] = {0}, index[WHOLE] = {0}, room[3][WHOLE];
        uint32_t *const u[3] = {room[0], room[1], room[2]};
        for (uint32_t i = 0; i < N; i++) {
            const sample_stream stream = sampler_start(&s, i, 7, 11*i%1000);
            pixel[i] = stream.pixel;
            index[i] = stream.index;
        }
        for (size_t set = 0; facet_isa_name(set); set++) {
            facet_isa_force(facet_isa_name(set));
            render_loops_chosen()->points(&s, N, pixel, index, 5, u);
            facet_isa_force("base");
            for (uint32_t i = 0; i < N; i++) {
                const sample_point alone = point_of(&s, i, 7, 11*i%1000, 5);
                for (int d = 0; d < 3; d++) assert_int_equal(room[d][i], alone.u[d]);
            }
        }
        facet_isa_force(NULL);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_group_is_stratified),
        cmocka_unit_test(the_most_samples_have_numbers_of_their_own),
        cmocka_unit_test(each_aligned_run_is_stratified),
        cmocka_unit_test(squares_of_pixels_are_stratified_together),
        cmocka_unit_test(errors_of_neighbours_cancel),
        cmocka_unit_test(scrambling_moves_points_inside_their_strata),
        cmocka_unit_test(numbers_are_uniform),
        cmocka_unit_test(groups_and_pixels_are_uncorrelated),
        cmocka_unit_test(pairs_across_groups_fill_the_square),
        cmocka_unit_test(products_across_groups_converge),
        cmocka_unit_test(numbers_are_repeatable),
        cmocka_unit_test(a_fraction_stays_below_one),
        cmocka_unit_test(a_point_does_not_depend_on_its_place_or_the_instruction_set),
    };
    return cmocka_run_group_tests_name("sampler", tests, NULL, NULL);
}
