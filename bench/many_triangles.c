/* many_triangles.c: what a picture of many triangles costs, from its file on: a ball with bumps in a box, in 10^4 to
 * 10^7 triangles, as .glb in the temporary folder.
 *
 *     many_triangles [--csv FILE] [--quick]
 *
 * 512 x 512 pixels, one thread; reading and building use all processors.  The error is the root of half the mean square
 * difference of two pictures of clipped values over their mean; the time, CPU time to an error of 2 % by the 1/sqrt(N)
 * law.  Each size is measured in a process of its own, whose peak memory is counted beyond that of the smallest scene.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "bench/parts/bench_scenes.h"
#include "bench/parts/build_scene.h"
#include "bench/parts/write_glb.h"
#include "io/gltf.h"
#include "render/geometry.h"

static const double error_wanted = 0.02;

typedef struct figures {
    double n_triangles, reading, building, memory, ns, error, seconds;
} figures;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9*(double)t.tv_nsec;
}

/* ---- Measuring ----------------------------------------------------------------------------------------------- */

static render_result picture(const scene *s, uint32_t spp, uint32_t n_threads, uint32_t seed)
{
    render_settings settings;
    render_settings_defaults(&settings);
    settings.width = settings.height = 512;
    settings.spp = spp;
    settings.n_threads = n_threads;
    settings.seed = seed;
    render_result result;
    facet_error why = {.text = ""};
    check(render(s, &settings, &result, &why), why.text);
    return result;
}

static figures measure(const char *path, uint32_t spp)
{
    scene *s = NULL;
    facet_error why = {.text = ""};
    figures f = {0};
    const double begin = now();
    check(gltf_read(path, NULL, NULL, &s, &why), why.text);
    f.reading = now() - begin;
    for (size_t i = 0; i < s->n_meshes; i++) f.n_triangles += s->meshes[i].n_triangles;
    render_result quick = picture(s, 1, 0, 0), a = picture(s, spp, 1, 1), b = picture(s, spp, 1, 2);
    f.building = quick.setup_seconds;
    const float *p = a.picture.pixels, *q = b.picture.pixels;
    const size_t n_values = 3*a.picture.width*a.picture.height;
    double square = 0, sum = 0;
    for (size_t i = 0; i < n_values; i++) {
        const double x = (double)kmin(p[i], 1), y = (double)kmin(q[i], 1);
        square += (x - y)*(x - y);
        sum += x + y;
    }
    const double mean = 0.5*sum/(double)n_values, error = ksqrt((float)(0.5*square/(double)n_values))/mean;
    const double cpu = 0.5*(a.cpu_seconds + b.cpu_seconds);
    f.ns = 1e9*cpu/(double)a.n_paths;
    f.error = error*(double)ksqrt((float)spp);
    f.seconds = cpu*error*error/(error_wanted*error_wanted);
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    f.memory = 1024*(double)usage.ru_maxrss;
    return f;
}

/* In a process of its own. */
static figures measure_alone(uint32_t n, uint32_t spp)
{
    const char *folder = getenv("TMPDIR");
    char path[512];
    int ends[2];
    figures f;
    snprintf(path, sizeof path, "%s/many_triangles-%ld.glb", folder ? folder : "/tmp", (long)getpid());
    for (int step = 0; step < 2; step++) {
        if (pipe(ends) != 0) check(FACET_IO, "pipe");
        fflush(NULL);
        const pid_t child = fork();
        if (child < 0) check(FACET_NO_MEMORY, "fork");
        if (child == 0) {
            if (step == 0) write_glb(bench_ball_scene(n), path);
            else f = measure(path, spp);
            const bool is_told = step == 0 || write(ends[1], &f, sizeof f) == (ssize_t)sizeof f;
            _exit(is_told ? 0 : 4);
        }
        close(ends[1]);
        const bool is_told = step == 0 || read(ends[0], &f, sizeof f) == (ssize_t)sizeof f;
        close(ends[0]);
        int status;
        if (waitpid(child, &status, 0) != child || status != 0 || !is_told) {
            unlink(path);
            check(FACET_IO, "a part of the measurement");
        }
    }
    unlink(path);
    return f;
}

int main(int argc, char **argv)
{
    static const uint32_t sides[] = {9, 29, 91, 289, 913}; /* 12 n^2 triangles */
    FILE *csv = NULL;
    uint32_t spp = 16;
    double base = 0;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--quick") == 0) spp = 2;
        else if (strcmp(argv[i], "--csv") == 0 && i + 1 < argc && (csv = fopen(argv[++i], "w")))
            fprintf(
                csv,
                "triangles,reading,building,bytes_per_triangle,ns_per_path,error_of_a_sample,seconds_to_2_percent\n");
        else {
            fprintf(stderr, "usage: many_triangles [--csv FILE] [--quick]\n");
            return 2;
        }
    }
    printf("%10s %10s %11s %12s %9s %9s %9s\n", "triangles", "reading, s", "building, s", "bytes / tri.", "ns a path",
           "error of", "s to 2 %");
    for (size_t i = 0; i < sizeof sides/sizeof *sides; i++) {
        const figures f = measure_alone(sides[i], spp);
        if (i == 0) {
            base = f.memory;
            continue; /* what any scene takes */
        }
        const double bytes = (f.memory - base)/f.n_triangles;
        printf("%10.0f %10.3f %11.3f %12.0f %9.0f %9.3f %9.2f\n", f.n_triangles, f.reading, f.building, bytes, f.ns,
               f.error, f.seconds);
        if (csv)
            fprintf(csv, "%.0f,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g\n", f.n_triangles, f.reading, f.building, bytes, f.ns,
                    f.error, f.seconds);
    }
    return csv && fclose(csv) != 0 ? 4 : 0;
}
