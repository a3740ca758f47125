/* gtr_masking.c: nanoseconds per Lambda of GTR by each way to compute it, per D, per visible normal
 * and per fit, beside GGX.
 *
 *     gtr_masking
 *
 * One core; the library's loops at AVX-512 (core/batch_terms_text.h), a block of 512 elements in cache, best of 300
 * runs; the fit is the library's.  "published" is [vray]'s closed forms and spline with weights prepared per gamma,
 * in one loop: it is short.
 * SPDX-License-Identifier: MIT */
#if defined(__x86_64__)
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx512f,avx512vl,avx512dq,avx512bw"))), apply_to = function)
#else
#pragma GCC target("avx512f,avx512vl,avx512dq,avx512bw")
#endif
#define FACET_REAL_IS_DOUBLE 0
#define FACET_LOOPS
#define FACET_PREPARE
#include "core/batch_terms_text.h"
#include "core/model/model_gtr.h"

#include <math.h>
#include <stdio.h>
#include <time.h>

enum { ROUNDS = 300, REPEATS = 64 };

static float x[BLOCK], y[BLOCK], z[BLOCK], alphas[BLOCK], gammas[BLOCK], mus[BLOCK], numbers[3][BLOCK];
static const float steps[3] = {0.8191725f, 0.6710436f, 0.5497005f}; /* of a lattice */
float gtr_bench_out[BLOCK];                                         /* visible outside, so that it is written */

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9*(double)t.tv_nsec;
}

static void run_ggx(const distribution *d)
{
    const distribution q = *d;
    EACH_OF(BLOCK) gtr_bench_out[i] = ggx_sigma(make3(x[i], y[i], z[i]), q.alpha_x, q.alpha_y);
}

static void run_prepared(const distribution *d)
{
    gtr_exact_sigma(d, BLOCK, (facet_dirs){x, y, z}, gtr_bench_out);
}

static void run_published(const distribution *d)
{
    const distribution q = *d;
    EACH_OF(BLOCK) gtr_bench_out[i] = gtr_published_G1(make3(x[i], y[i], z[i]), q.gtr, q.spline);
}

static void run_direct(const distribution *d)
{
    (void)d;
    gtr_direct_block(BLOCK, alphas, gammas, mus, gtr_bench_out);
}

static void run_D(const distribution *d)
{
    gtr_drawn_D(d, BLOCK, (facet_dirs){x, y, z}, gtr_bench_out);
}

static void run_visible(const distribution *d)
{
    block_vectors m;
    gtr_visible_normals(d, BLOCK, (facet_dirs){x, y, z}, (facet_dirs){numbers[0], numbers[1], numbers[2]}, &m);
    gtr_bench_out[0] = m.x[0];
}

static double best_ns(void (*run)(const distribution *), const distribution *d)
{
    double best = INFINITY;
    for (int r = 0; r < ROUNDS; r++) {
        const double start = seconds();
        for (int k = 0; k < REPEATS; k++) run(d);
        best = fmin(best, (seconds() - start)*1e9/(REPEATS*BLOCK));
    }
    return best;
}

static double fit_ns(double alpha, double gamma)
{
    double best = INFINITY;
    for (int r = 0; r < ROUNDS; r++) {
        gtr_fit fit;
        const double start = seconds();
        for (int k = 0; k < 8; k++) facet_gtr_fit_shape(alpha, gamma, &fit);
        best = fmin(best, (seconds() - start)*1e9/8);
    }
    return best;
}

int main(void)
{
    if (!__builtin_cpu_supports("avx512bw") || !__builtin_cpu_supports("avx512dq")) {
        printf("gtr: this processor has no AVX-512\n");
        return 0;
    }
    for (int i = 0; i < BLOCK; i++) {
        z[i] = ((float)(i*77%BLOCK) + 0.5f)/BLOCK;
        x[i] = sqrtf(1 - z[i]*z[i])*cosf(2.4f*(float)i);
        y[i] = sqrtf(1 - z[i]*z[i])*sinf(2.4f*(float)i);
        mus[i] = z[i]/sqrtf(1 - z[i]*z[i]);
        alphas[i] = 0.01f + 0.9f*(float)(i*37%101)/101;
        gammas[i] = 0.2f + 4*(float)(i*53%103)/103;
        for (int k = 0; k < 3; k++) numbers[k][i] = fmodf(((float)i + 0.5f)*steps[k], 1);
    }
    printf("%-22s %8s %8s %8s %8s %8s %8s %8s  [ns]\n", "alpha, gamma", "ggx", "G1", "publ.", "direct", "D", "visible",
           "fit");
    static const double shapes[][2] = {{.1, 1.5},   {.3, 1.5}, {.1, .7}, {.3, .7}, {1e-3, 1},
                                       {1e-4, 2.5}, {.05, 3},  {.3, 8},  {.5, 20}};
    for (size_t s = 0; s < sizeof shapes/sizeof shapes[0]; s++) {
        const float alpha = (float)shapes[s][0], gamma = (float)shapes[s][1];
        const distribution d = {.kind = NDF_GTR,
                                .alpha_x = alpha,
                                .alpha_y = alpha,
                                .gtr = gtr_shape_of(alpha, alpha, gamma, GTR_STRETCHED),
                                .spline = gtr_spline_at(gamma)};
        printf("%-10g %-11g %8.2f %8.2f %8.2f %8.2f %8.2f %8.2f %8.0f\n", shapes[s][0], shapes[s][1],
               best_ns(run_ggx, &d), best_ns(run_prepared, &d), best_ns(run_published, &d), best_ns(run_direct, &d),
               best_ns(run_D, &d), best_ns(run_visible, &d), fit_ns(shapes[s][0], shapes[s][1]));
    }
    return 0;
}
#if defined(__clang__)
#pragma clang attribute pop
#endif
#else
#include <stdio.h>

int main(void)
{
    printf("gtr: this processor has no AVX-512\n");
    return 0;
}
#endif
