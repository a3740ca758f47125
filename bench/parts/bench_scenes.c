/* bench_scenes.c: see bench_scenes.h.
 * SPDX-License-Identifier: MIT */
#include "bench/parts/bench_scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/parts/build_scene.h"
#include "io/gltf.h"
#include "io/image_file.h"
#include "render/geometry.h"
#include "render/view.h"

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

scene *bench_ball_scene(uint32_t n)
{
    scene *s = add_box();
    add_ball(s, add_material(s, "lambert kd=.7,.6,.4", 0), make3(0, .8f, 0), .7f, n);
    return s;
}

static scene *one_ball_scene(void)
{
    return bench_ball_scene(76);
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

/* The balls of the spheres' box in metals with long tails. */
static scene *gtr_scene(void)
{
    scene *s = add_box();
    const sphere left = {{-.45f, .4f, -.3f}, .4f, add_material(s, "gtr alpha=.05 gamma=1.2 metal=Au", 0)};
    const sphere right = {{.45f, .4f, .3f}, .4f, add_material(s, "gtr alpha=.2 gamma=.7 ks=.9", 0)};
    check(scene_add_sphere(s, &left, NULL), "sphere");
    check(scene_add_sphere(s, &right, NULL), "sphere");
    return s;
}

static scene *read_scene(const char *file)
{
    char path[512];
    scene *s = NULL;
    facet_error why = {.text = ""};
    snprintf(path, sizeof path, FACET_SOURCE_DIR "/../shared/assets/%s", file);
    return gltf_read(path, NULL, NULL, &s, &why) == FACET_OK ? s : NULL;
}

static scene *veach_scene(void)
{
    return read_scene("scenes/veach_mis/veach_mis.glb");
}

/* A model under a sky of photographs, seen whole. */
static scene *model_scene(const char *model, const char *sky)
{
    char path[512];
    scene *s = read_scene(model);
    image raw = {0}, linear = {0};
    snprintf(path, sizeof path, FACET_SOURCE_DIR "/../shared/assets/hdri/%s", sky);
    if (!s) return NULL;
    if (image_read(path, &raw, NULL) == FACET_OK) check(image_to_linear(&raw, &linear, NULL), sky);
    image_destroy(&raw);
    s->environment.map = linear;
    for (int k = 0; k < 3; k++) s->environment.scale[k] = 1;
    if (s->n_cameras == 0) check(scene_add_framing_camera(s, NULL), "camera");
    return s;
}

static scene *helmet_scene(void)
{
    return model_scene("models/FlightHelmet_1k/FlightHelmet.gltf", "lebombo_1k.hdr");
}

static scene *car_scene(void)
{
    return model_scene("models/ToyCar/glTF/ToyCar.gltf", "studio_small_03_1k.hdr");
}

const bench_scene bench_scenes[BENCH_SCENES] = {
    {"spheres", spheres_scene, STRATEGY_EXPLICIT},
    {"70k", one_ball_scene, STRATEGY_EXPLICIT},
    {"2M", eight_balls_scene, STRATEGY_EXPLICIT},
    {"gtr", gtr_scene, STRATEGY_EXPLICIT},
    {"veach", veach_scene, STRATEGY_MIS},
    {"helmet", helmet_scene, STRATEGY_MIS},
    {"car", car_scene, STRATEGY_MIS},
};
