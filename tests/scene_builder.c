/* scene_builder.c: see scene_builder.h.
 * SPDX-License-Identifier: MIT */
#include "tests/scene_builder.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/geometry.h"

/* A copy of n bytes that the scene may free. */
static void *copy_of(const void *bytes, size_t n)
{
    void *copy = malloc(n);
    assert_non_null(copy);
    memcpy(copy, bytes, n);
    return copy;
}

scene *build_scene(void)
{
    scene *s = scene_create();
    assert_non_null(s);
    return s;
}

size_t build_material(scene *s, const char *spec, float emission, bool is_double_sided)
{
    material m;
    facet_material described;
    facet_error why = {0};
    assert_int_equal(material_default(spec, &m), FACET_OK);
    if (facet_material_parse(spec, &described, &why) || facet_bsdf_prepare(&described, &m.bsdf, &why))
        fail_msg("%s: %s: %s", spec, why.place, why.text);
    m.kind = SURFACE_BSDF;
    m.is_double_sided = is_double_sided;
    for (int k = 0; k < 3; k++) m.emission[k] = emission;
    size_t index;
    assert_int_equal(scene_add_material(s, &m, &index), FACET_OK);
    return index;
}

size_t build_gltf_material(scene *s, float base, float metallic, float roughness)
{
    material m;
    assert_int_equal(material_default("gltf", &m), FACET_OK);
    for (int k = 0; k < 3; k++) m.base_color[k] = base;
    m.metallic = metallic;
    m.roughness = roughness;
    size_t index;
    assert_int_equal(scene_add_material(s, &m, &index), FACET_OK);
    return index;
}

size_t build_mesh(scene *s, size_t mat, const float (*positions)[3], size_t n_vertices, const uint32_t (*triangles)[3],
                  size_t n_triangles)
{
    const mesh m = {.n_vertices = n_vertices,
                    .n_triangles = n_triangles,
                    .positions = copy_of(positions, n_vertices*sizeof *positions),
                    .triangles = copy_of(triangles, n_triangles*sizeof *triangles),
                    .material = mat};
    size_t index;
    assert_int_equal(scene_add_mesh(s, &m, &index), FACET_OK);
    return index;
}

void build_instance(scene *s, size_t mesh_index, const float (*to_world)[4])
{
    static const float identity[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
    instance in = {.mesh = mesh_index};
    memcpy(in.to_world, to_world ? to_world : identity, sizeof in.to_world);
    assert_int_equal(scene_add_instance(s, &in, NULL), FACET_OK);
}

size_t build_quad(scene *s, size_t mat, const float corner[3], const float u[3], const float v[3])
{
    static const uint32_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    static const float uv[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    float positions[4][3];
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++) positions[i][k] = corner[k] + uv[i][0]*u[k] + uv[i][1]*v[k];
    const size_t index = build_mesh(s, mat, (const float(*)[3])positions, 4, triangles, 2);
    s->meshes[index].uv[0] = copy_of(uv, sizeof uv);
    build_instance(s, index, NULL);
    return index;
}

size_t build_box(scene *s, size_t mat, const float low[3], const float high[3])
{
    static const uint32_t triangles[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                              {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    float positions[8][3];
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 3; k++) positions[i][k] = i >> k & 1 ? high[k] : low[k];
    return build_mesh(s, mat, (const float(*)[3])positions, 8, triangles, 12);
}

void build_disc(scene *s, size_t mat, const float center[3], float radius, unsigned n)
{
    float(*positions)[3] = calloc(n + 1, sizeof *positions);
    uint32_t(*triangles)[3] = calloc(n, sizeof *triangles);
    assert_true(positions && triangles);
    memcpy(positions[n], center, sizeof positions[n]);
    for (unsigned i = 0; i < n; i++) {
        const double angle = 6.283185307179586*i/n;
        positions[i][0] = center[0] + radius*(float)cos(angle);
        positions[i][1] = center[1];
        positions[i][2] = center[2] + radius*(float)sin(angle);
        triangles[i][0] = n;
        triangles[i][1] = i; /* from +x to +z: clockwise seen from above */
        triangles[i][2] = (i + 1)%n;
    }
    build_instance(s, build_mesh(s, mat, (const float(*)[3])positions, n + 1, (const uint32_t(*)[3])triangles, n),
                   NULL);
    free(positions);
    free(triangles);
}

size_t build_zone(scene *s, size_t mat, float cos_from, float cos_to, unsigned n_up, unsigned n_around, bool is_inward)
{
    const size_t n_vertices = (size_t)(n_up + 1)*n_around, n_triangles = (size_t)2*n_up*n_around;
    float(*positions)[3] = calloc(n_vertices, sizeof *positions);
    uint32_t(*triangles)[3] = calloc(n_triangles, sizeof *triangles);
    assert_true(positions && triangles);
    for (unsigned j = 0; j <= n_up; j++)
        for (unsigned i = 0; i < n_around; i++) {
            const double y = cos_from + ((double)cos_to - cos_from)*j/n_up, r = sqrt(fmax(1 - y*y, 0));
            const double angle = 6.283185307179586*i/n_around;
            float *p = positions[j*n_around + i];
            p[0] = (float)(r*cos(angle));
            p[1] = (float)y;
            p[2] = (float)(r*sin(angle));
        }
    size_t n = 0;
    const bool is_swapped = is_inward == (cos_from > cos_to);
    for (unsigned j = 0; j < n_up; j++)
        for (unsigned i = 0; i < n_around; i++) {
            const uint32_t a = j*n_around + i, b = j*n_around + (i + 1)%n_around, c = a + n_around,
                           d = b + n_around;
            const uint32_t two[2][3] = {{a, is_swapped ? c : b, is_swapped ? b : c},
                                        {b, is_swapped ? c : d, is_swapped ? d : c}};
            memcpy(triangles[n], two, sizeof two);
            n += 2;
        }
    const size_t index = build_mesh(s, mat, (const float(*)[3])positions, n_vertices, (const uint32_t(*)[3])triangles,
                                    n_triangles);
    free(positions);
    free(triangles);
    return index;
}

void build_sphere(scene *s, size_t mat, float x, float y, float z, float radius)
{
    const sphere sp = {.center = {x, y, z}, .radius = radius, .material = mat};
    assert_int_equal(scene_add_sphere(s, &sp, NULL), FACET_OK);
}

static void add_camera(scene *s, const float eye[3], const float target[3], camera c)
{
    const real3 back = normalize3(sub3(vector_of(eye), vector_of(target)));
    const real3 up = kabs(back.y) < 0.9f ? make3(0, 1, 0) : make3(1, 0, 0);
    const real3 right = normalize3(cross3(up, back)), over = cross3(back, right);
    const real3 columns[4] = {right, over, back, vector_of(eye)};
    for (int j = 0; j < 4; j++) {
        c.to_world[0][j] = columns[j].x;
        c.to_world[1][j] = columns[j].y;
        c.to_world[2][j] = columns[j].z;
    }
    c.name = copy_of("camera", 7);
    assert_int_equal(scene_add_camera(s, &c, NULL), FACET_OK);
}

void build_camera(scene *s, const float eye[3], const float target[3], float yfov)
{
    add_camera(s, eye, target, (camera){.yfov = yfov});
}

void build_orthographic(scene *s, const float eye[3], const float target[3], float half_height)
{
    add_camera(s, eye, target, (camera){.is_orthographic = true, .ymag = half_height});
}

size_t build_texture(scene *s, size_t width, size_t height, const unsigned char *rgba, bool is_nearest)
{
    const image picture = {width, height, 4, PIXEL_U8, copy_of(rgba, 4*width*height)};
    texture t = {.is_nearest = is_nearest};
    size_t index;
    assert_int_equal(scene_add_image(s, &picture, &t.image), FACET_OK);
    assert_int_equal(scene_add_texture(s, &t, &index), FACET_OK);
    return index;
}

void build_wall(scene *s, const char *spec, const float corner[3], const float u[3], const float v[3])
{
    build_quad(s, build_material(s, spec, 0, false), corner, u, v);
}

void build_veil(scene *s, alpha_mode alpha, float x, float z)
{
    static const unsigned char texels[16] = {255, 64, 64, 255, 64, 255, 64, 40, 64, 64, 255, 128, 255, 255, 255, 220};
    const size_t mat = build_gltf_material(s, .8f, 0, .5f);
    material *m = &s->materials[mat];
    m->alpha = alpha;
    m->alpha_cutoff = .5f;
    m->is_double_sided = true;
    m->base_color_texture.texture = build_texture(s, 2, 2, texels, alpha == ALPHA_MASK);
    build_quad(s, mat, (const float[3]){x, .1f, z}, (const float[3]){.5f, 0, .2f}, (const float[3]){0, .8f, 0});
}

void build_sky(scene *s, size_t width, size_t height, const float *texels)
{
    s->environment.map = (image){width, height, 3, PIXEL_F32, copy_of(texels, 3*width*height*sizeof *texels)};
    for (int k = 0; k < 3; k++) s->environment.scale[k] = 1;
}

render_settings random_settings(size_t width, size_t height, uint32_t spp)
{
    render_settings r;
    render_settings_defaults(&r);
    r.width = width;
    r.height = height;
    r.spp = spp/SAMPLE_DIVISOR < 2 ? 2 : spp/SAMPLE_DIVISOR;
    r.sampler = SAMPLER_RANDOM;
    r.gradients = GRADIENTS_OFF; /* else pixels err together, and their spread does not tell how far */
    r.n_threads = 2;
    r.seed = 1;
    return r;
}

image render_picture(const scene *s, const render_settings *settings)
{
    render_result result = {0};
    facet_error why = {0};
    if (render(s, settings, &result, &why)) fail_msg("render: %s: %s", why.place, why.text);
    assert_int_equal(result.n_bad, 0);
    return result.picture;
}

estimate measure(const scene *s, const render_settings *settings)
{
    render_result result = {0};
    facet_error why = {0};
    if (render(s, settings, &result, &why)) fail_msg("render: %s: %s", why.place, why.text);
    assert_int_equal(result.n_bad, 0);
    const float *pixels = result.picture.pixels;
    const size_t n_pixels = result.picture.width*result.picture.height;
    estimate e = {0, 0};
    for (size_t i = 0; i < n_pixels; i++) e.mean += (double)luminance(vector_of(pixels + 3*i))/(double)n_pixels;
    if (result.noise > 0) e.error = result.noise*e.mean/sqrt((double)n_pixels);
    render_result_destroy(&result);
    return e;
}

bool estimate_agrees(estimate e, double truth)
{
    return fabs(e.mean - truth) <= 4*e.error + 2e-5*fabs(truth);
}

void expect_estimate(const char *what, estimate e, double truth)
{
    print_message("  %-44s %.6g +- %.2g, truth %.6g, ratio %.5f\n", what, e.mean, e.error, truth,
                  truth != 0 ? e.mean/truth : 1.0);
    if (!estimate_agrees(e, truth)) fail_msg("%s: %.8g +- %.3g is not %.8g", what, e.mean, e.error, truth);
    const double slack = SAMPLE_DIVISOR > 1 ? 1.5 : 1; /* samples per pixel were rounded down */
    if (e.error > slack*0.00125*sqrt(SAMPLE_DIVISOR)*fabs(truth))
        fail_msg("%s: the standard error %.3g is too large for the claim", what, e.error);
}

surface surface_of_hit(const scene *s, const ray *r, const hit *h, real3 wo)
{
    surface_set *set = NULL;
    facet_bsdf own;
    assert_int_equal(surface_set_create(s, &set), FACET_OK);
    surface at;
    surface_find(set, r, h, wo, 0, &own, &at);
    at.bsdf = NULL;
    surface_set_destroy(set);
    return at;
}

scene *build_ball_and_lamp(void)
{
    scene *s = build_scene();
    build_quad(s, build_material(s, "lambert kd=.6", 0, false), (const float[3]){-2, 0, 2}, (const float[3]){4, 0, 0},
               (const float[3]){0, 0, -4});
    build_sphere(s, build_material(s, "ggx alpha=.3 ks=.8", 0, false), 0, .5f, 0, .5f);
    build_sphere(s, build_material(s, "lambert kd=0", 20, false), 1, 1.5f, .5f, .2f);
    for (int k = 0; k < 3; k++) s->environment.scale[k] = .1f;
    build_camera(s, (const float[3]){0, 1, 4}, (const float[3]){0, .5f, 0}, .8f);
    return s;
}
