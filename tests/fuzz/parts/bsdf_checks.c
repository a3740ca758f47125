/* bsdf_checks.c: see bsdf_checks.h.
 * SPDX-License-Identifier: MIT */
#include "tests/fuzz/parts/bsdf_checks.h"

#include <math.h>

#include "tests/fuzz/parts/harness.h"

enum { N_DIRECTIONS = 6, N_DRAWS = 4 };

static const float directions[N_DIRECTIONS][3] = {
    {0, 0, 1}, {0.6f, 0, 0.8f}, {0, -0.8f, 0.6f}, {-0.99999994f, 0, 3e-4f}, {0, 0.6f, -0.8f}, {0, 1, 0},
};

static const float draws[N_DRAWS][3] = {
    {0, 0, 0}, {0.5f, 0.25f, 0.75f}, {0x1.fffffep-1f, 0x1.fffffep-1f, 0x1.fffffep-1f}, {1e-6f, 0.9f, 0.01f}};

static void require_amounts(const float *numbers, size_t n)
{
    for (size_t i = 0; i < n; i++) require(isfinite(numbers[i]) && numbers[i] >= 0);
}

static void check_sample(const facet_bsdf *bsdf, const float wo[3], const float u[3])
{
    const facet_sample s = facet_bsdf_sample(bsdf, wo, u);
    require_amounts(&s.pdf, 1);
    require_amounts(s.weight, 3);
    if (s.pdf == 0) return;
    const float length = sqrtf(s.wi[0]*s.wi[0] + s.wi[1]*s.wi[1] + s.wi[2]*s.wi[2]);
    require(fabsf(length - 1) <
            1e-5f); /* some rounding errors of 6e-8, in three squares and a root, after a rotation */
}

void check_bsdf(const facet_bsdf *bsdf)
{
    for (int i = 0; i < N_DIRECTIONS; i++) {
        for (int j = 0; j < N_DIRECTIONS; j++) {
            float f[3];
            const float pdf = facet_bsdf_eval_pdf(bsdf, directions[i], directions[j], f);
            require_amounts(f, 3);
            require_amounts(&pdf, 1);
        }
        for (int j = 0; j < N_DRAWS; j++) check_sample(bsdf, directions[i], draws[j]);
    }
}
