/* gtr_masking.c: nanoseconds per Lambda of GTR by each way to compute it, per D and per fit, beside GGX.
 *
 *     gtr_masking
 *
 * One core; loops over the kernels at AVX-512, compiled with the flags of the library, 4096 elements in cache, best of
 * 300 runs; the fit is the library's.  "published" is [vray]'s closed forms and spline with weights prepared per gamma,
 * vectorised like the rest.
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
#include "core/model/model_gtr.h"

#include <math.h>
#include <stdio.h>
#include <time.h>

enum { N = 4096, ROUNDS = 300 };

static float x[N], y[N], z[N], alphas[N], gammas[N], mus[N];
float gtr_bench_out[N]; /* visible outside, so that it is written */

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9*(double)t.tv_nsec;
}

#define LOOP(name, expression)                                                                                         \
    static __attribute__((noinline)) void name(const gtr_shape *shape, gtr_spline spline)                              \
    {                                                                                                                  \
        const gtr_shape g = *shape;                                                                                    \
        (void)spline, (void)g;                                                                                         \
        _Pragma("omp simd") for (int i = 0; i < N; i++) gtr_bench_out[i] = (expression);                               \
    }
LOOP(loop_ggx, ggx_sigma(make3(x[i], y[i], z[i]), g.alpha, g.alpha))
LOOP(loop_prepared, gtr_sigma(make3(x[i], y[i], z[i]), g))
LOOP(loop_published, gtr_published_G1(make3(x[i], y[i], z[i]), g, spline))
LOOP(loop_direct, gtr_Lambda_direct(alphas[i], gammas[i], mus[i]))
LOOP(loop_D, gtr_D(make3(x[i], y[i], z[i]), g))

static double best_ns(void (*loop)(const gtr_shape *, gtr_spline), const gtr_shape *g, gtr_spline spline)
{
    double best = INFINITY;
    for (int r = 0; r < ROUNDS; r++) {
        const double start = seconds();
        for (int k = 0; k < 8; k++) loop(g, spline);
        best = fmin(best, (seconds() - start)*1e9/(8*N));
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
    for (int i = 0; i < N; i++) {
        z[i] = ((float)i + 0.5f)/N;
        x[i] = sqrtf(1 - z[i]*z[i])*cosf(2.4f*(float)i);
        y[i] = sqrtf(1 - z[i]*z[i])*sinf(2.4f*(float)i);
        alphas[i] = 0.01f + 0.9f*(float)(i*37%101)/101;
        gammas[i] = 0.2f + 4*(float)(i*53%103)/103;
        mus[i] = z[i]/sqrtf(1 - z[i]*z[i]);
    }
    printf("%-22s %8s %8s %8s %8s %8s %8s  [ns]\n", "alpha, gamma", "ggx", "G1", "publ.", "direct", "D", "fit");
    static const double shapes[][2] = {{.1, 1.5}, {.3, .7}, {1e-3, 1}, {1e-4, 2.5}, {.05, 3}, {.3, 8}, {.5, 20}};
    for (size_t s = 0; s < sizeof shapes/sizeof shapes[0]; s++) {
        const gtr_shape g = gtr_shape_of((float)shapes[s][0], (float)shapes[s][0], (float)shapes[s][1], GTR_STRETCHED);
        const gtr_spline spline = gtr_spline_at((float)shapes[s][1]);
        printf("%-10g %-11g %8.2f %8.2f %8.2f %8.2f %8.2f %8.0f\n", shapes[s][0], shapes[s][1],
               best_ns(loop_ggx, &g, spline), best_ns(loop_prepared, &g, spline), best_ns(loop_published, &g, spline),
               best_ns(loop_direct, &g, spline), best_ns(loop_D, &g, spline), fit_ns(shapes[s][0], shapes[s][1]));
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
