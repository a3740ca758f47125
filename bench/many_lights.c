/* many_lights.c: what a picture with many lights costs: 10 to 10^5 emitting triangles of the same area in all.
 *
 *     many_lights [--csv FILE] [--quick]
 *
 * A hall of 10 x 10 m and 4 m high with balls on its floor; the triangles float anywhere above 2 m and face anywhere,
 * and the camera looks down below them, so that all noise comes from light that was chosen.  256 x 256 pixels, direct
 * light, one thread.  The error is the root of half the mean square difference of two pictures over their mean; the
 * time, CPU time to an error of 2 % by the 1/sqrt(N) law.  `building` is the acceleration structure and the tables of
 * lights.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/parts/build_scene.h"
#include "render/geometry.h"
#include "render/render.h"
#include "render/sampler.h"

static const double error_wanted = 0.02;

/* Uniform in [low, high): number k of light i. */
static float uniform(uint32_t i, uint32_t k, float low, float high)
{
    return low + (high - low)*fraction(hash_pair(i, k));
}

static void add_lights(scene *s, uint32_t n)
{
    const size_t glow = add_material(s, "lambert kd=0", 20);
    mesh m = {.n_vertices = 3*n, .n_triangles = n, .material = glow};
    m.positions = allocate(m.n_vertices, sizeof *m.positions);
    m.triangles = allocate(m.n_triangles, sizeof *m.triangles);
    const float size = ksqrt(2/(float)n);
    for (uint32_t i = 0; i < n; i++) {
        const real3 center = make3(uniform(i, 0, -4.9f, 4.9f), uniform(i, 1, 2, 3.9f), uniform(i, 2, -4.9f, 4.9f));
        const float cos = uniform(i, 3, -1, 1), sin = ksqrt(1 - cos*cos);
        const real2 azimuth = kcossin_turn(uniform(i, 4, 0, 1));
        const frame f = frame_of_normal(make3(sin*azimuth.x, cos, sin*azimuth.y));
        const real3 corners[3] = {center, madd3(center, size, f.t), madd3(center, size, f.b)};
        for (uint32_t k = 0; k < 3; k++) {
            const float corner[3] = {corners[k].x, corners[k].y, corners[k].z};
            memcpy(m.positions[3*i + k], corner, sizeof corner);
            m.triangles[i][k] = 3*i + k;
        }
    }
    add_mesh(s, &m);
}

static scene *hall(uint32_t n_lights)
{
    scene *s = scene_create();
    if (!s) check(FACET_NO_MEMORY, "scene");
    const size_t grey = add_material(s, "lambert kd=.7,.7,.7", 0);
    add_quad(s, grey, (const float[4][3]){{-5, 0, 5}, {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}});
    add_quad(s, grey, (const float[4][3]){{-5, 0, -5}, {5, 0, -5}, {5, 4, -5}, {-5, 4, -5}});
    for (uint32_t i = 0; i < 12; i++) {
        const float radius = uniform(i, 5, .1f, .6f);
        const sphere ball = {{uniform(i, 6, -3, 3), radius, uniform(i, 7, -4, 2)}, radius, grey};
        check(scene_add_sphere(s, &ball, NULL), "sphere");
    }
    add_lights(s, n_lights);
    const float cos = 0.8191520f, sin = 0.5735764f; /* looks down by 35 degrees, and sees 45 */
    camera cam = {.name = allocate(2, 1),
                  .to_world = {{1, 0, 0, 0}, {0, cos, sin, 1.8f}, {0, -sin, cos, 4.9f}},
                  .yfov = 45*PI/180};
    cam.name[0] = 'c';
    check(scene_add_camera(s, &cam, NULL), "camera");
    return s;
}

static render_result picture(const scene *s, uint32_t spp, uint32_t seed)
{
    render_settings settings;
    render_settings_defaults(&settings);
    settings.width = settings.height = 256;
    settings.spp = spp;
    settings.depth = 1;
    settings.n_threads = 1;
    settings.seed = seed;
    render_result result;
    facet_error why = {.text = ""};
    check(render(s, &settings, &result, &why), why.text);
    return result;
}

static void measure(uint32_t n, uint32_t spp, FILE *csv)
{
    scene *s = hall(n);
    render_result a = picture(s, spp, 1), b = picture(s, spp, 2);
    const float *p = a.picture.pixels, *q = b.picture.pixels;
    const size_t n_values = 3*a.picture.width*a.picture.height;
    double square = 0, sum = 0;
    for (size_t i = 0; i < n_values; i++) {
        const double d = (double)p[i] - (double)q[i];
        square += d*d;
        sum += (double)p[i] + (double)q[i];
    }
    const double mean = 0.5*sum/(double)n_values, error = sqrt(0.5*square/(double)n_values)/mean;
    const double ns = 1e9*0.5*(a.cpu_seconds + b.cpu_seconds)/(double)a.n_paths;
    const double seconds = 0.5*(a.cpu_seconds + b.cpu_seconds)*error*error/(error_wanted*error_wanted);
    printf("%8u %8.4f %9.3f %9.0f %11.2f %11.2f\n", n, mean, error*sqrt((double)spp), ns, seconds, a.setup_seconds);
    if (csv)
        fprintf(csv, "%u,%.5g,%.4g,%.4g,%.4g,%.4g\n", n, mean, error*sqrt((double)spp), ns, seconds, a.setup_seconds);
    render_result_destroy(&a);
    render_result_destroy(&b);
    scene_destroy(s);
}

int main(int argc, char **argv)
{
    FILE *csv = NULL;
    uint32_t spp = 64;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--quick") == 0) spp = 4;
        else if (strcmp(argv[i], "--csv") == 0 && i + 1 < argc && (csv = fopen(argv[++i], "w")))
            fprintf(csv, "lights,mean,error_of_a_sample,ns_per_path,seconds_to_2_percent,building\n");
        else {
            fprintf(stderr, "usage: many_lights [--csv FILE] [--quick]\n");
            return 2;
        }
    }
    printf("%8s %8s %9s %9s %11s %11s\n", "lights", "mean", "error of", "ns a path", "s to 2 %", "building, s");
    printf("%8s %8s %9s\n", "", "", "a sample");
    for (uint32_t n = 10; n <= 100000; n *= 10) measure(n, spp, csv);
    return csv && fclose(csv) != 0 ? 4 : 0;
}
