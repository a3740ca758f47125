/* test_loops.c: what the loops over many (render/loops.h) move and draw, on every instruction set.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "render/loops.h"
#include "render/sampler_point.h"
#include "render/stages.h"
#include "tests/draws.h"

enum { N_ARRAYS = 6 };

static void what_is_kept_is_packed_in_order(void **state)
{
    (void)state;
    draws d = {3};
    static uint32_t keeps[ROOM], from[N_ARRAYS][ROOM], to[N_ARRAYS][ROOM];
    for (int round = 0; round < 300; round++) {
        const uint32_t n = round < 20 ? (uint32_t)round : (uint32_t)(draw_bits(&d)%(PATHS + 1));
        const double share = draw_between(&d, -.2, 1.2); /* all and none as well */
        const int n_arrays = 1 + round%N_ARRAYS;
        for (uint32_t i = 0; i < ROOM; i++) keeps[i] = draw_between(&d, 0, 1) < share;
        for (int k = 0; k < N_ARRAYS; k++)
            for (uint32_t i = 0; i < ROOM; i++) from[k][i] = (uint32_t)draw_bits(&d);
        for (size_t set = 0; facet_isa_name(set); set++) {
            facet_isa_force(facet_isa_name(set));
            packed_array arrays[N_ARRAYS];
            for (int k = 0; k < N_ARRAYS; k++) arrays[k] = (packed_array){from[k], to[k]};
            const uint32_t n_kept = render_loops_chosen()->pack(n, NULL, keeps, (size_t)n_arrays, arrays);
            uint32_t expected = 0;
            for (uint32_t i = 0; i < n; i++) {
                if (!keeps[i]) continue;
                for (int k = 0; k < n_arrays; k++) assert_int_equal(to[k][expected], from[k][i]);
                expected++;
            }
            assert_int_equal(n_kept, expected);
        }
    }
    facet_isa_force(NULL);
}

/* As rays are packed that several lists hold, and what is in the way of them told to the lists. */
static void what_lies_apart_is_packed_and_unpacked(void **state)
{
    (void)state;
    enum { N_LISTS = 4, LONG = N_LISTS*ROOM };
    draws d = {4};
    static uint32_t keeps[LONG], kept[LONG], from[LONG], to[ROOM];
    for (int round = 0; round < 300; round++) {
        uint32_t starts[PATHS/PACKED];
        const uint32_t n = PACKED*(uint32_t)(draw_bits(&d)%(PATHS/PACKED + 1));
        const double share = draw_between(&d, -.2, 1.2);
        for (uint32_t i = 0; i < LONG; i++) {
            keeps[i] = draw_between(&d, 0, 1) < share;
            from[i] = (uint32_t)draw_bits(&d) & 1;
        }
        uint32_t begin[N_LISTS];
        for (uint32_t i = 0; i < N_LISTS; i++) begin[i] = i*ROOM + (uint32_t)(draw_bits(&d)%100);
        for (uint32_t i = 0; i < n/PACKED; i++) starts[i] = begin[i%N_LISTS] + PACKED*(i/N_LISTS);
        for (size_t set = 0; facet_isa_name(set); set++) {
            facet_isa_force(facet_isa_name(set));
            const packed_array array = {from, to};
            const uint32_t n_kept = render_loops_chosen()->pack(n, starts, keeps, 1, &array);
            memcpy(kept, keeps, sizeof kept);
            uint32_t j = 0;
            for (uint32_t i = 0; i < n; i++) {
                const uint32_t k = starts[i/PACKED] + i%PACKED;
                if (!keeps[k]) continue;
                assert_int_equal(to[j++], from[k]);
                kept[k] = from[k];
            }
            assert_int_equal(n_kept, j);
            static uint32_t unpacked[LONG];
            memcpy(unpacked, keeps, sizeof unpacked);
            render_loops_chosen()->unpack(n, starts, to, unpacked);
            assert_memory_equal(unpacked, kept, sizeof kept);
        }
    }
    facet_isa_force(NULL);
}

/* One number of a block's lanes of what light_samples holds. */
typedef struct sample_block {
    float of[10][LOOP_LANES];
    uint32_t is_infinite[LOOP_LANES], is_delta[LOOP_LANES];
} sample_block;

static light_samples samples_in(sample_block *b)
{
    float(*of)[LOOP_LANES] = b->of;
    return (light_samples){
        {of[0], of[1], of[2]}, {of[3], of[4], of[5]}, {of[6], of[7], of[8]}, of[9], b->is_infinite, b->is_delta};
}

static real3 draw3(draws *d)
{
    return make3((float)draw_between(d, -1, 1), (float)draw_between(d, -1, 1), (float)draw_between(d, -1, 1));
}

/* Lists that permutations of vectors serve, and longer ones. */
static void points_on_few_triangles_are_those_on_any(void **state)
{
    (void)state;
    enum { MOST = 12 };
    draws d = {5};
    for (uint32_t n = 1; n <= MOST; n++) {
        light_triangle triangles[MOST];
        const light_triangle *chosen[LOOP_LANES];
        float from[3][LOOP_LANES], probability[LOOP_LANES];
        uint32_t which[LOOP_LANES], numbers[3][LOOP_LANES];
        double rest[LOOP_LANES];
        uint32_t *const u[3] = {numbers[0], numbers[1], numbers[2]};
        for (uint32_t k = 0; k < n; k++)
            triangles[k] = (light_triangle){.origin = draw3(&d),
                                            .edge1 = draw3(&d),
                                            .edge2 = draw3(&d),
                                            .normal = normalize3(draw3(&d)),
                                            .radiance = draw3(&d),
                                            .area = (float)draw_between(&d, .1, 1),
                                            .offset = (float)draw_between(&d, 0, .1),
                                            .lowest = k%2 ? 0 : -1e30f};
        for (int i = 0; i < LOOP_LANES; i++) {
            which[i] = (uint32_t)(draw_bits(&d)%n);
            chosen[i] = &triangles[which[i]];
            probability[i] = (float)draw_between(&d, 0, 1);
            for (int k = 0; k < 3; k++) {
                from[k][i] = (float)draw_between(&d, -3, 3);
                numbers[k][i] = (uint32_t)draw_bits(&d);
            }
        }
        const vectors points = {from[0], from[1], from[2]};
        sample_block any, few;
        memset(&any, 0, sizeof any);
        memset(&few, 0, sizeof few);
        facet_isa_force("base");
        render_loops_chosen()->light_any(chosen, probability, LOOP_LANES, points, u, samples_in(&any));
        for (size_t set = 0; facet_isa_name(set); set++) {
            facet_isa_force(facet_isa_name(set));
            render_loops_chosen()->light(n, triangles, LOOP_LANES, points, (light_choices){which, probability, rest}, u,
                                         samples_in(&few));
            assert_memory_equal(&few, &any, sizeof any);
        }
    }
    facet_isa_force(NULL);
}

/* Each column is made from the two before it, as Joe and Kuo 2008 say, in reverse: their shift to the right is one to
 * the left; and the digits of an index are the sum of its bits' columns. */
static void the_third_dimension_has_its_primitive_polynomial(void **state)
{
    (void)state;
    uint32_t columns[32] = {1, 3};
    for (int k = 2; k < 32; k++) columns[k] = columns[k - 1] ^ columns[k - 2] ^ columns[k - 2] << 2;
    draws d = {7};
    for (int round = 0; round < 10000; round++) {
        const uint32_t index = round < 32 ? 1u << round : (uint32_t)draw_bits(&d);
        uint32_t digits = 0;
        for (int k = 0; k < 32; k++) digits ^= index >> k & 1 ? columns[k] : 0;
        assert_int_equal(sobol_third(index), digits);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_kept_is_packed_in_order),
        cmocka_unit_test(what_lies_apart_is_packed_and_unpacked),
        cmocka_unit_test(points_on_few_triangles_are_those_on_any),
        cmocka_unit_test(the_third_dimension_has_its_primitive_polynomial),
    };
    return cmocka_run_group_tests_name("loops", tests, NULL, NULL);
}
