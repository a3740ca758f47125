/* many_lights.c: what a picture with many lights costs: 10 to 10^5 emitting triangles of the same area in all.
 *
 *     many_lights [--meshes|--ceiling] [--csv FILE] [--quick]
 *
 * A hall of 10 x 10 m and 4 m high with balls on its floor; the triangles float anywhere above 2 m and face anywhere,
 * and the camera looks down below them, so that all noise comes from light that was chosen.  With --ceiling they hang
 * below the ceiling and face down; with --meshes they are ten lamps, in ever more triangles.  256 x 256 pixels, direct
 * light, one thread.  The error is the root of half the mean square difference of two pictures over their mean; the
 * time, CPU time to an error of 2 % by the 1/sqrt(N) law.  `building` is the acceleration structure and the tables of
 * lights.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdbool.h>
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

/* The corners of lamp i, floating anywhere and facing anywhere, or down from the ceiling. */
static void place_lamp(uint32_t i, float size, bool is_ceiling, real3 corners[3])
{
    const float height = is_ceiling ? 3.9f : uniform(i, 1, 2, 3.9f);
    const real3 center = make3(uniform(i, 0, -4.9f, 4.9f), height, uniform(i, 2, -4.9f, 4.9f));
    const float cos = is_ceiling ? -1 : uniform(i, 3, -1, 1), sin = ksqrt(1 - cos*cos);
    const real2 azimuth = kcossin_turn(uniform(i, 4, 0, 1));
    const frame f = frame_of_normal(make3(sin*azimuth.x, cos, sin*azimuth.y));
    corners[0] = center;
    corners[1] = madd3(center, size, f.t);
    corners[2] = madd3(center, size, f.b);
}

/* Cuts a triangle into cuts^2, which go to the end of the mesh. */
static void add_pieces(mesh *m, const real3 corners[3], uint32_t cuts)
{
    const real3 edge1 = sub3(corners[1], corners[0]), edge2 = sub3(corners[2], corners[0]);
    for (uint32_t row = 0; row <= cuts; row++)
        for (uint32_t column = 0; column + row <= cuts; column++) {
            const uint32_t here = (uint32_t)m->n_vertices++, above = here + cuts - row + 1;
            const uint32_t lower[3] = {here, here + 1, above}, upper[3] = {here + 1, above + 1, above};
            const real3 at = madd3(madd3(corners[0], (float)column/(float)cuts, edge1), (float)row/(float)cuts,
                                   edge2);
            const float position[3] = {at.x, at.y, at.z};
            memcpy(m->positions[here], position, sizeof position);
            if (column + row < cuts) memcpy(m->triangles[m->n_triangles++], lower, sizeof lower);
            if (column + row + 1 < cuts) memcpy(m->triangles[m->n_triangles++], upper, sizeof upper);
        }
}

static void add_lights(scene *s, uint32_t n_lamps, uint32_t cuts, bool is_ceiling)
{
    mesh m = {.material = add_material(s, "lambert kd=0", 20)};
    m.positions = allocate((size_t)n_lamps*(cuts + 1)*(cuts + 2)/2, sizeof *m.positions);
    m.triangles = allocate((size_t)n_lamps*cuts*cuts, sizeof *m.triangles);
    for (uint32_t i = 0; i < n_lamps; i++) {
        real3 corners[3];
        place_lamp(i, ksqrt(2/(float)n_lamps), is_ceiling, corners);
        add_pieces(&m, corners, cuts);
    }
    add_mesh(s, &m);
}

static scene *hall(uint32_t n_lamps, uint32_t cuts, bool is_ceiling)
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
    add_lights(s, n_lamps, cuts, is_ceiling);
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

static void measure(uint32_t n_lamps, uint32_t cuts, bool is_ceiling, uint32_t spp, FILE *csv)
{
    const uint32_t n = n_lamps*cuts*cuts;
    scene *s = hall(n_lamps, cuts, is_ceiling);
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
    bool has_meshes = false, is_ceiling = false;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--quick") == 0) spp = 4;
        else if (strcmp(argv[i], "--meshes") == 0) has_meshes = true;
        else if (strcmp(argv[i], "--ceiling") == 0) is_ceiling = true;
        else if (strcmp(argv[i], "--csv") == 0 && i + 1 < argc && (csv = fopen(argv[++i], "w")))
            fprintf(csv, "lights,mean,error_of_a_sample,ns_per_path,seconds_to_2_percent,building\n");
        else {
            fprintf(stderr, "usage: many_lights [--meshes|--ceiling] [--csv FILE] [--quick]\n");
            return 2;
        }
    }
    printf("%8s %8s %9s %9s %11s %11s\n", "lights", "mean", "error of", "ns a path", "s to 2 %", "building, s");
    printf("%8s %8s %9s\n", "", "", "a sample");
    if (has_meshes) {
        const uint32_t cuts[] = {1, 3, 10, 32, 100};
        for (size_t i = 0; i < sizeof cuts/sizeof *cuts; i++) measure(10, cuts[i], is_ceiling, spp, csv);
    } else {
        for (uint32_t n = 10; n <= 100000; n *= 10) measure(n, 1, is_ceiling, spp, csv);
    }
    return csv && fclose(csv) != 0 ? 4 : 0;
}
