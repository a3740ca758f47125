/* renders.c: how fast pictures come, how near that is to the tracer's own rate, and how soon they are free of noise.
 *
 *     renders [--csv FILE] [--quick] [--only SCENE]
 *     renders --export FOLDER     # only writes 70k.glb and 2M.glb there, for other renderers (bench/peers)
 *
 * For each scene of bench/parts/bench_scenes.h, at 512 x 512 and depth 8:
 * - paths and rays per second of CPU time, on one thread and on two in turn, medians of seven runs;
 * - the limit: every ray of a one-thread run with one sample per pixel is recorded and, after each of the runs, traced
 *   again alone, in the same groups.  Its time per ray, times the rays of the run, is the share of the run that is
 *   spent inside the tracer; the run's time over it is how far the renderer is from one that only traces;
 * - RMSE of 64 samples per pixel against a long render with another seed, raw and with values clipped to 1, without
 *   the part that is the long render's own; and CPU time to a clipped RMSE of 0.02 by the 1/sqrt(N) law;
 * - a Z-test: means of 16 x 16 pixels, by --strategy mis, the default sampler and shared light against independent
 *   numbers, each pixel alone, with --strategy explicit (mis in `veach`, `helmet` and `car`), four renders each: the
 *   largest of the deviations over their standard errors, and the share beyond 3.7, which Student's t of six degrees of
 *   freedom exceeds with a probability of 1 %.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/parts/bench_scenes.h"
#include "bench/parts/build_scene.h"
#include "bench/parts/ray_recorder.h"
#include "bench/parts/write_glb.h"
#include "render/render.h"
#include "render/surface.h"

enum { SIZE = 512, RUNS = 7, BLOCK_SIZE = 16, BLOCKS = SIZE/BLOCK_SIZE, SEEDS = 4 };

typedef struct effort {
    uint32_t rate_spp, error_spp, reference_spp, z_spp;
} effort;

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, size_t n)
{
    qsort(values, n, sizeof *values, compare_doubles);
    return values[n/2];
}

/* The picture is the caller's to destroy. */
static render_result run(const scene *s, uint32_t spp, uint32_t n_threads, uint32_t seed, sampler_kind sampler,
                         strategy how)
{
    render_settings settings;
    render_settings_defaults(&settings);
    settings.width = settings.height = SIZE;
    settings.spp = spp;
    settings.n_threads = n_threads;
    settings.seed = seed;
    settings.sampler = sampler;
    settings.gradients = sampler == SAMPLER_SOBOL ? GRADIENTS_AUTO
                                                  : GRADIENTS_OFF; /* the other is what this is held against */
    settings.strategy = how;
    render_result result;
    facet_error why = {.text = ""};
    check(render(s, &settings, &result, &why), why.text);
    if (result.n_bad) check(FACET_BAD_VALUE, "a sample was not finite");
    return result;
}

/* The same without the picture. */
static render_result run_blind(const scene *s, uint32_t spp, uint32_t n_threads)
{
    render_result result = run(s, spp, n_threads, 0, SAMPLER_SOBOL, STRATEGY_MIS);
    render_result_destroy(&result);
    return result;
}

typedef struct rates {
    double paths, rays, closest_per_path, shadow_per_path; /* per CPU second; per path */
    double closest_alone, shadow_alone;                    /* rays per second of the tracer alone */
    double share, scaling;
    const char *isa;
} rates;

static rates measure_rates(const scene *s, uint32_t spp)
{
    recorder_start();
    run_blind(s, 1, 1);
    recorder_stop();
    tracer *alone;
    facet_error why = {.text = ""};
    check(tracer_create(s, NULL, 1, surface_opacity, s, &alone, &why), why.text);
    tracer_prepare_thread();
    double cpu[RUNS], scaling[RUNS], closest[RUNS], shadow[RUNS], share[RUNS];
    render_result one = {.n_paths = 0};
    for (int i = 0; i < RUNS; i++) { /* all in turn, so that a slow spell meets all */
        one = run_blind(s, spp, 1);
        closest[i] = recorder_replay(alone, &recorded_closest);
        shadow[i] = recorder_replay(alone, &recorded_shadow);
        cpu[i] = one.cpu_seconds;
        share[i] = 1e-9*(closest[i]*(double)one.n_rays + shadow[i]*(double)one.n_shadow_rays)/cpu[i];
        scaling[i] = one.seconds/run_blind(s, spp, 2).seconds;
    }
    tracer_destroy(alone);
    recorder_destroy();
    const double n_rays = (double)one.n_rays, n_shadow = (double)one.n_shadow_rays, n_paths = (double)one.n_paths;
    const double seconds = median(cpu, RUNS), shadow_ns = median(shadow, RUNS);
    return (rates){.paths = n_paths/seconds,
                   .rays = (n_rays + n_shadow)/seconds,
                   .closest_per_path = n_rays/n_paths,
                   .shadow_per_path = n_shadow/n_paths,
                   .closest_alone = 1e9/median(closest, RUNS),
                   .shadow_alone = shadow_ns > 0 ? 1e9/shadow_ns : 0,
                   .share = median(share, RUNS),
                   .scaling = median(scaling, RUNS),
                   .isa = one.isa};
}

/* The mean square difference of two pictures, of values up to `most`. */
static double mean_square(const image *a, const image *b, double most)
{
    const float *p = a->pixels, *q = b->pixels;
    const size_t n = 3*a->width*a->height;
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        const double d = fmin((double)p[i], most) - fmin((double)q[i], most);
        sum += d*d;
    }
    return sum/(double)n;
}

typedef struct errors {
    double raw, clipped, seconds; /* RMSE, and CPU seconds to a clipped one of 0.02 */
    double mean[3];
} errors;

static errors measure_errors(const scene *s, effort e)
{
    render_result picture = run(s, e.error_spp, 1, 1, SAMPLER_SOBOL, STRATEGY_MIS);
    render_result reference = run(s, e.reference_spp, 2, 2, SAMPLER_SOBOL, STRATEGY_MIS);
    /* The long render's own error is about that of so many times as many samples: take it off. */
    const double own = 1/(1 + (double)e.error_spp/(double)e.reference_spp);
    errors result = {.raw = sqrt(own*mean_square(&picture.picture, &reference.picture, 1e30)),
                     .clipped = sqrt(own*mean_square(&picture.picture, &reference.picture, 1))};
    result.seconds = picture.cpu_seconds*result.clipped*result.clipped/(0.02*0.02);
    const float *p = reference.picture.pixels;
    for (size_t i = 0; i < 3*(size_t)SIZE*SIZE; i++) result.mean[i%3] += (double)p[i]/((double)SIZE*SIZE);
    render_result_destroy(&picture);
    render_result_destroy(&reference);
    return result;
}

/* Sums of a block's means and of their squares over the seeds. */
typedef struct block_sums {
    double sum[BLOCKS*BLOCKS], squares[BLOCKS*BLOCKS];
} block_sums;

static void add_blocks(block_sums *to, const image *picture)
{
    const float *p = picture->pixels;
    for (size_t by = 0; by < BLOCKS; by++)
        for (size_t bx = 0; bx < BLOCKS; bx++) {
            double sum = 0;
            for (size_t y = by*BLOCK_SIZE; y < (by + 1)*BLOCK_SIZE; y++)
                for (size_t i = 3*(y*SIZE + bx*BLOCK_SIZE); i < 3*(y*SIZE + (bx + 1)*BLOCK_SIZE); i++)
                    sum += (double)p[i];
            const double mean = sum/(3.0*BLOCK_SIZE*BLOCK_SIZE);
            to->sum[by*BLOCKS + bx] += mean;
            to->squares[by*BLOCKS + bx] += mean*mean;
        }
}

/* The variance of the mean over the seeds. */
static double variance(const block_sums *b, size_t i)
{
    const double mean = b->sum[i]/SEEDS;
    return fmax(b->squares[i]/SEEDS - mean*mean, 0)/(SEEDS - 1);
}

/* The largest deviation over its standard error, and the share beyond Student's 1 %. */
static void measure_bias(const scene *s, strategy how, uint32_t spp, double *largest, double *share)
{
    static block_sums usual, other;
    memset(&usual, 0, sizeof usual);
    memset(&other, 0, sizeof other);
    for (uint32_t seed = 0; seed < SEEDS; seed++) {
        render_result a = run(s, spp, 2, 10 + seed, SAMPLER_SOBOL, STRATEGY_MIS);
        render_result b = run(s, spp, 2, 20 + seed, SAMPLER_RANDOM, how);
        add_blocks(&usual, &a.picture);
        add_blocks(&other, &b.picture);
        render_result_destroy(&a);
        render_result_destroy(&b);
    }
    size_t n = 0, n_beyond = 0;
    *largest = 0;
    for (size_t i = 0; i < BLOCKS*BLOCKS; i++) {
        const double error = sqrt(variance(&usual, i) + variance(&other, i));
        if (!(error > 0)) continue; /* black, or lit evenly by what the camera sees */
        const double z = fabs(usual.sum[i] - other.sum[i])/SEEDS/error;
        n++;
        n_beyond += z > 3.707;
        *largest = fmax(*largest, z);
    }
    *share = n ? (double)n_beyond/(double)n : 0;
}

static void measure(const bench_scene *which, effort e, FILE *csv)
{
    scene *s = which->make();
    if (!s) {
        printf("%-8s left out: its file is not in ../shared/assets\n", which->name);
        return;
    }
    size_t n_triangles = 0;
    for (size_t i = 0; i < s->n_instances; i++) n_triangles += s->meshes[s->instances[i].mesh].n_triangles;
    const rates r = measure_rates(s, e.rate_spp);
    const errors error = measure_errors(s, e);
    double largest, share;
    measure_bias(s, which->other, e.z_spp, &largest, &share);
    printf("%-8s %9zu %7.3f %6.2f %6.2f %7.1f %7.1f %5.0f%% %6.2f %6.2f %8.4f %8.4f %8.1f %7.2f %5.1f%%\n", which->name,
           n_triangles, 1e-6*r.paths, r.closest_per_path, r.shadow_per_path, 1e-6*r.closest_alone,
           1e-6*r.shadow_alone, 100*r.share, 1/r.share, r.scaling, error.raw, error.clipped, error.seconds,
           largest, 100*share);
    fflush(stdout);
    if (csv)
        fprintf(csv, "%s,%zu,%.6g,%.6g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.5g,%.5g,%.5g,%.3g,%.3g,%s\n",
                which->name, n_triangles, r.paths, r.rays, r.closest_per_path, r.shadow_per_path, r.closest_alone,
                r.shadow_alone, r.share, r.scaling, error.raw, error.clipped, error.seconds, error.mean[0],
                error.mean[1], error.mean[2], largest, share, r.isa);
    if (csv) fflush(csv);
    scene_destroy(s);
}

static void export_scenes(const char *folder)
{
    static const char *const names[] = {"70k", "2M"};
    for (size_t k = 0; k < sizeof names/sizeof *names; k++)
        for (size_t i = 0; i < BENCH_SCENES; i++) {
            char path[512];
            if (strcmp(bench_scenes[i].name, names[k]) != 0) continue;
            scene *s = bench_scenes[i].make();
            snprintf(path, sizeof path, "%s/%s.glb", folder, names[k]);
            write_glb(s, path);
            scene_destroy(s);
        }
}

int main(int argc, char **argv)
{
    if (argc == 3 && strcmp(argv[1], "--export") == 0) {
        export_scenes(argv[2]);
        return 0;
    }
    FILE *csv = NULL;
    const char *only = NULL;
    effort e = {.rate_spp = 16, .error_spp = 64, .reference_spp = 256, .z_spp = 16};
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--quick") == 0)
            e = (effort){.rate_spp = 2, .error_spp = 8, .reference_spp = 64, .z_spp = 4};
        else if (strcmp(argv[i], "--only") == 0 && i + 1 < argc) only = argv[++i];
        else if (strcmp(argv[i], "--csv") == 0 && i + 1 < argc && (csv = fopen(argv[++i], "w")))
            fprintf(csv, "scene,triangles,paths_per_s,rays_per_s,closest_per_path,shadow_per_path,alone_closest_per_s,"
                         "alone_shadow_per_s,share_in_tracer,scaling_1_to_2,rmse,rmse_clipped,cpu_s_to_0.02,mean_r,"
                         "mean_g,mean_b,z_largest,z_share_beyond_1_percent,isa\n");
        else {
            fprintf(stderr, "usage: renders [--csv FILE] [--quick] [--only SCENE] | --export FOLDER\n");
            return 2;
        }
    }
    printf("%-8s %9s %7s %13s %15s %6s %6s %6s %8s %8s %8s %14s\n", "", "", "Mpaths", "rays per path", "tracer Mrays/s",
           "share", "time /", "1 to 2", "RMSE", "clipped", "CPU s to", "Z-test");
    printf("%-8s %9s %7s %6s %6s %7s %7s %6s %6s %6s %8s %8s %8s %7s %6s\n", "scene", "triangles", "per s", "near",
           "shadow", "near", "shadow", "there", "limit", "cores", "64 spp", "to 1", "0.02", "largest", "> 1 %");
    for (size_t i = 0; i < BENCH_SCENES; i++)
        if (!only || strcmp(only, bench_scenes[i].name) == 0) measure(&bench_scenes[i], e, csv);
    return csv && fclose(csv) != 0 ? 4 : 0;
}
