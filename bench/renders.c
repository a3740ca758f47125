/* renders.c: paths and rays per second on three scenes, and how near that is to Embree's own rate.
 *
 *     renders [--csv FILE] [--quick]
 *
 * The scenes are boxes open to the front with one square light: `spheres` (12 triangles, a rough metal and a
 * smooth glass sphere), `70k` (a displaced ball, 69,324 triangles) and `2M` (eight of them, 2,160,012).  Each is
 * rendered at 512x512, depth 8, on one thread and on two in turn; the rates are per second of CPU time of one
 * thread, the last column the ratio of wall times; medians of five runs.
 *
 * The limit: every ray of a one-thread run with one sample per pixel is recorded at the tracer's interface (the
 * linker puts the recorder between; see CMakeLists.txt) and then traced again alone, in the same order, closest
 * hits and shadow rays apart.  Their time per ray, times the rays of the run, is the share of the run that is
 * spent inside Embree; the run's time over it is how far the renderer is from a renderer that only traces.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bench/build_scene.h"
#include "render/geometry.h"
#include "render/render.h"
#include "render/scene.h"
#include "render/surface.h"
#include "render/tracer.h"

enum { SIZE = 512, RUNS = 5, MOST_RECORDED = 1 << 21 };

/* ---- recording -------------------------------------------------------------------------------- */

/* Rays in the groups in which they were traced. */
typedef struct ray_group {
    size_t first, n;
    bool is_coherent;
} ray_group;

typedef struct ray_log {
    float *fields[8];
    uint32_t *seeds;
    ray_group *groups;
    size_t n, n_groups;
} ray_log;

static ray_log closest, shadow;
static bool is_recording;

void __real_tracer_nearest(const tracer *t, size_t n, rays r, bool is_coherent, hits h);
void __real_tracer_blocked(const tracer *t, size_t n, rays r, uint32_t *is_blocked);
void __wrap_tracer_nearest(const tracer *t, size_t n, rays r, bool is_coherent, hits h);
void __wrap_tracer_blocked(const tracer *t, size_t n, rays r, uint32_t *is_blocked);

static rays logged_rays(const ray_log *log, size_t first)
{
    float *const *f = log->fields;
    return (rays){.origin = {f[0] + first, f[1] + first, f[2] + first},
                  .direction = {f[3] + first, f[4] + first, f[5] + first},
                  .t_min = f[6] + first,
                  .t_max = f[7] + first,
                  .seed = log->seeds + first};
}

static void record(ray_log *log, size_t n, rays r, bool is_coherent)
{
    const size_t room = (n + TRACER_LANES - 1)/TRACER_LANES*TRACER_LANES;
    if (n == 0 || log->n + room > MOST_RECORDED) return;
    const float *const from[8] = {r.origin.x,    r.origin.y,    r.origin.z, r.direction.x,
                                  r.direction.y, r.direction.z, r.t_min,    r.t_max};
    for (int k = 0; k < 8; k++) memcpy(log->fields[k] + log->n, from[k], n*sizeof(float));
    memcpy(log->seeds + log->n, r.seed, n*sizeof *r.seed);
    log->groups[log->n_groups++] = (ray_group){log->n, n, is_coherent};
    log->n += room;
}

void __wrap_tracer_nearest(const tracer *t, size_t n, rays r, bool is_coherent, hits h)
{
    if (is_recording) record(&closest, n, r, is_coherent);
    __real_tracer_nearest(t, n, r, is_coherent, h);
}

void __wrap_tracer_blocked(const tracer *t, size_t n, rays r, uint32_t *is_blocked)
{
    if (is_recording) record(&shadow, n, r, false);
    __real_tracer_blocked(t, n, r, is_blocked);
}

/* ---- scenes ----------------------------------------------------------------------------------- */

static void log_create(ray_log *log)
{
    for (int k = 0; k < 8; k++) log->fields[k] = allocate(MOST_RECORDED, sizeof(float));
    log->seeds = allocate(MOST_RECORDED, sizeof *log->seeds);
    log->groups = allocate(MOST_RECORDED, sizeof *log->groups);
}

static void log_destroy(ray_log *log)
{
    for (int k = 0; k < 8; k++) free(log->fields[k]);
    free(log->seeds);
    free(log->groups);
}

/* Box x in [-1,1], y in [0,2], z in [-1,1], front open, and a light of 0.5 x 0.5 a millimetre under its ceiling. */
static scene *add_box(void)
{
    scene *s = scene_create();
    if (!s) check(FACET_NO_MEMORY, "scene");
    const size_t grey = add_material(s, "lambert kd=.725,.71,.68", 0),
                 red = add_material(s, "lambert kd=.63,.065,.05", 0),
                 green = add_material(s, "lambert kd=.14,.45,.091", 0), light = add_material(s, "lambert kd=0", 15);
    add_quad(s, grey, (const float[4][3]){{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}});
    add_quad(s, grey, (const float[4][3]){{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}});
    add_quad(s, grey, (const float[4][3]){{-1, 0, -1}, {1, 0, -1}, {1, 2, -1}, {-1, 2, -1}});
    add_quad(s, red, (const float[4][3]){{-1, 0, 1}, {-1, 0, -1}, {-1, 2, -1}, {-1, 2, 1}});
    add_quad(s, green, (const float[4][3]){{1, 0, -1}, {1, 0, 1}, {1, 2, 1}, {1, 2, -1}});
    add_quad(s, light,
             (const float[4][3]){
                 {-.25f, 1.999f, -.25f}, {.25f, 1.999f, -.25f}, {.25f, 1.999f, .25f}, {-.25f, 1.999f, .25f}});
    camera cam = {
        .name = allocate(2, 1), .to_world = {{1, 0, 0, 0}, {0, 1, 0, 1}, {0, 0, 1, 3.9f}}, .yfov = 39*PI/180};
    cam.name[0] = 'c';
    check(scene_add_camera(s, &cam, NULL), "camera");
    return s;
}

static scene *spheres_scene(void)
{
    scene *s = add_box();
    const sphere metal = {{-.45f, .4f, -.3f}, .4f, add_material(s, "ggx alpha=.09 ks=.9", 0)};
    const sphere glass = {{.45f, .4f, .3f}, .4f, add_material(s, "glass ior=1.5", 0)};
    check(scene_add_sphere(s, &metal, NULL), "sphere");
    check(scene_add_sphere(s, &glass, NULL), "sphere");
    return s;
}

/* A ball with bumps: a cube of six n x n grids blown up to the sphere, 12 n^2 triangles. */
static void add_ball(scene *s, size_t material_index, real3 center, float radius, uint32_t n)
{
    const uint32_t side = n + 1;
    mesh m = {.n_vertices = 6*side*side, .n_triangles = 12*n*n, .material = material_index};
    m.positions = allocate(m.n_vertices, sizeof *m.positions);
    m.triangles = allocate(m.n_triangles, sizeof *m.triangles);
    size_t v = 0, t = 0;
    for (uint32_t face = 0; face < 6; face++) {
        const uint32_t axis = face/2, first = face*side*side;
        for (uint32_t j = 0; j <= n; j++)
            for (uint32_t i = 0; i <= n; i++) {
                float p[3];
                p[axis] = face & 1 ? 1.0f : -1.0f;
                p[(axis + 1)%3] = (2*(float)i/(float)n - 1)*p[axis];
                p[(axis + 2)%3] = 2*(float)j/(float)n - 1;
                const real3 d = normalize3(vector_of(p));
                const float bump = 1 + 0.04f*sinf(17*d.x)*sinf(19*d.y)*sinf(23*d.z);
                const real3 at = madd3(center, radius*bump, d);
                m.positions[v][0] = at.x;
                m.positions[v][1] = at.y;
                m.positions[v++][2] = at.z;
            }
        for (uint32_t j = 0; j < n; j++)
            for (uint32_t i = 0; i < n; i++) {
                const uint32_t a = first + j*side + i, quad[4] = {a, a + 1, a + 1 + side, a + side};
                memcpy(m.triangles[t++], (const uint32_t[3]){quad[0], quad[1], quad[2]}, sizeof m.triangles[0]);
                memcpy(m.triangles[t++], (const uint32_t[3]){quad[0], quad[2], quad[3]}, sizeof m.triangles[0]);
            }
    }
    add_mesh(s, &m);
}

static scene *one_ball_scene(void)
{
    scene *s = add_box();
    add_ball(s, add_material(s, "lambert kd=.7,.6,.4", 0), make3(0, .8f, 0), .7f, 76);
    return s;
}

static scene *eight_balls_scene(void)
{
    scene *s = add_box();
    for (int i = 0; i < 8; i++) {
        const real3 center = make3(i & 1 ? .45f : -.45f, i & 2 ? 1.4f : .5f, i & 4 ? .45f : -.45f);
        add_ball(s, add_material(s, "lambert kd=.7,.6,.4", 0), center, .4f, 150);
    }
    return s;
}

/* ---- timing ----------------------------------------------------------------------------------- */

static double process_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9*(double)t.tv_nsec;
}

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
static render_result run(const scene *s, uint32_t spp, uint32_t n_threads, uint32_t seed)
{
    render_settings settings;
    render_settings_defaults(&settings);
    settings.width = settings.height = SIZE;
    settings.spp = spp;
    settings.n_threads = n_threads;
    settings.seed = seed;
    render_result result;
    facet_error why = {.text = ""};
    check(render(s, &settings, &result, &why), why.text);
    if (result.n_bad) check(FACET_BAD_VALUE, "a sample was not finite");
    return result;
}

/* The same without the picture. */
static render_result run_blind(const scene *s, uint32_t spp, uint32_t n_threads)
{
    render_result result = run(s, spp, n_threads, 0);
    render_result_destroy(&result);
    return result;
}

/* The noise of the `spheres` picture as peers' was measured: half the mean square difference of two independent
 * pictures, raw and with values clipped to 1; and the CPU time to a clipped RMSE of 0.02 by the 1/sqrt(N) law. */
static void measure_noise(uint32_t spp)
{
    scene *s = spheres_scene();
    render_result a = run(s, spp, 1, 1), b = run(s, spp, 1, 2);
    const float *p = a.picture.pixels, *q = b.picture.pixels;
    const size_t n = 3*(size_t)SIZE*SIZE;
    double raw = 0, clipped = 0, mean[3] = {0};
    for (size_t i = 0; i < n; i++) {
        const double d = (double)p[i] - (double)q[i];
        const double e = fmin((double)p[i], 1) - fmin((double)q[i], 1);
        raw += d*d;
        clipped += e*e;
        mean[i%3] += 1.5*((double)p[i] + (double)q[i])/(double)n;
    }
    raw = sqrt(raw/(2*(double)n));
    clipped = sqrt(clipped/(2*(double)n));
    const double seconds = 0.5*(a.cpu_seconds + b.cpu_seconds);
    printf("spheres at %u spp: mean %.4f %.4f %.4f, %.1f CPU s, RMSE %.4f, clipped to 1 %.4f: 0.02 in %.0f CPU s\n",
           spp, mean[0], mean[1], mean[2], seconds, raw, clipped, seconds*clipped*clipped/(0.02*0.02));
    render_result_destroy(&a);
    render_result_destroy(&b);
    scene_destroy(s);
}

/* CPU nanoseconds per ray of a log, traced alone: the median of the runs. */
static double replay(const tracer *t, const ray_log *log, bool is_shadow)
{
    static float numbers[3][1 << 12];
    static uint32_t words[2][1 << 12];
    double ns[RUNS];
    size_t n = 0;
    for (size_t k = 0; k < log->n_groups; k++) n += log->groups[k].n;
    for (int i = 0; i < RUNS; i++) {
        const double start = process_seconds();
        for (size_t k = 0; k < log->n_groups; k++) {
            const ray_group g = log->groups[k];
            const rays r = logged_rays(log, g.first);
            if (is_shadow) __real_tracer_blocked(t, g.n, r, words[0]);
            else
                __real_tracer_nearest(t, g.n, r, g.is_coherent,
                                      (hits){numbers[0], numbers[1], numbers[2], words[0], words[1]});
        }
        ns[i] = 1e9*(process_seconds() - start)/(double)(n ? n : 1);
    }
    return median(ns, RUNS);
}

static void measure(const char *name, scene *(*make)(void), uint32_t spp, FILE *csv)
{
    scene *s = make();
    size_t n_triangles = 0;
    for (size_t i = 0; i < s->n_meshes; i++) n_triangles += s->meshes[i].n_triangles;
    double cpu[RUNS], ratios[RUNS];
    render_result one = {.n_paths = 0};
    for (int i = 0; i < RUNS; i++) { /* one and two threads in turn, so that a slow spell meets both */
        one = run_blind(s, spp, 1);
        cpu[i] = one.cpu_seconds;
        ratios[i] = one.seconds/run_blind(s, spp, 2).seconds;
    }
    const double seconds = median(cpu, RUNS), scaling = median(ratios, RUNS);

    closest.n = closest.n_groups = shadow.n = shadow.n_groups = 0;
    is_recording = true;
    run_blind(s, 1, 1);
    is_recording = false;
    tracer *alone;
    facet_error why = {.text = ""};
    check(tracer_create(s, NULL, 1, surface_opacity, s, &alone, &why), why.text);
    tracer_prepare_thread();
    const double closest_ns = replay(alone, &closest, false), shadow_ns = replay(alone, &shadow, true);
    tracer_destroy(alone);

    const double n_rays = (double)one.n_rays, n_shadow = (double)one.n_shadow_rays, n_paths = (double)one.n_paths;
    const double inside = 1e-9*(closest_ns*n_rays + shadow_ns*n_shadow);
    printf("%-8s %9zu %8.3f %8.2f %6.2f %6.2f %8.1f %8.1f %7.0f%% %6.2f %6.2f\n", name, n_triangles,
           1e-6*n_paths/seconds, 1e-6*(n_rays + n_shadow)/seconds, n_rays/n_paths, n_shadow/n_paths,
           1e3/closest_ns, 1e3/shadow_ns, 100*inside/seconds, seconds/inside, scaling);
    if (csv)
        fprintf(csv, "%s,%zu,%.6g,%.6g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%s\n", name, n_triangles, n_paths/seconds,
                (n_rays + n_shadow)/seconds, n_rays/n_paths, n_shadow/n_paths, 1e9/closest_ns, 1e9/shadow_ns,
                inside/seconds, scaling, one.isa);
    scene_destroy(s);
}

int main(int argc, char **argv)
{
    FILE *csv = NULL;
    uint32_t spp = 16;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--quick") == 0) spp = 2;
        else if (strcmp(argv[i], "--csv") == 0 && i + 1 < argc && (csv = fopen(argv[++i], "w")))
            fprintf(csv, "scene,triangles,paths_per_s,rays_per_s,closest_per_path,shadow_per_path,"
                         "embree_closest_per_s,embree_shadow_per_s,share_in_embree,scaling_1_to_2,isa\n");
        else {
            fprintf(stderr, "usage: renders [--csv FILE] [--quick]\n");
            return 2;
        }
    }
    log_create(&closest);
    log_create(&shadow);
    printf("%-8s %9s %8s %8s %13s %17s %8s %6s %6s\n", "", "", "Mpaths/s", "Mrays/s", "rays per path", "Embree Mrays/s",
           "share in", "time /", "1 to 2");
    printf("%-8s %9s %8s %8s %6s %6s %8s %8s %8s %6s %6s\n", "scene", "triangles", "1 thread", "1 thread", "near",
           "shadow", "near", "shadow", "Embree", "limit", "threads");
    measure("spheres", spheres_scene, spp, csv);
    measure("70k", one_ball_scene, spp, csv);
    measure("2M", eight_balls_scene, spp, csv);
    measure_noise(4*spp);
    log_destroy(&closest);
    log_destroy(&shadow);
    return csv && fclose(csv) != 0 ? 4 : 0;
}
