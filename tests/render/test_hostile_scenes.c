/* test_hostile_scenes.c: no scene puts a NaN or an infinity into the picture, or hangs.
 *
 * Samples that overflow are counted and reported with their place; elsewhere the count is 0.
 * SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/draws.h"
#include "tests/scene_builder.h"

static const float origin[3] = {0, 0, 0};

static render_settings settings(strategy how)
{
    render_settings r;
    render_settings_defaults(&r);
    r.width = r.height = 24;
    r.spp = 8;
    r.depth = 12;
    r.n_threads = 2;
    r.strategy = how;
    return r;
}

/* Every pixel must be at least `least` and finite, and no sample bad.  Returns the largest value. */
static float largest_value(const scene *s, const render_settings *r, float least)
{
    render_result result = {0};
    facet_error why = {0};
    if (render(s, r, &result, &why)) fail_msg("%s: %s", why.place, why.text);
    assert_int_equal(result.n_bad, 0);
    float largest = 0;
    for (size_t i = 0; i < 3*r->width*r->height; i++) {
        const float value = ((const float *)result.picture.pixels)[i];
        assert_true(value >= least && isfinite(value));
        if (value > largest) largest = value;
    }
    render_result_destroy(&result);
    return largest;
}

/* Renders with all strategies, each pixel alone, none of which may then be negative, and compared with its neighbours,
 * where few samples may be.  The scene is destroyed.  Returns the largest value of pixels alone. */
static float survive(scene *s)
{
    float largest = 0;
    for (strategy how = STRATEGY_MIS; how <= STRATEGY_IMPLICIT; how++) {
        render_settings r = settings(how);
        largest_value(s, &r, -FLT_MAX);
        r.gradients = GRADIENTS_OFF;
        largest = fmaxf(largest, largest_value(s, &r, 0));
    }
    scene_destroy(s);
    return largest;
}

static scene *floor_and_view(const char *spec)
{
    scene *s = build_scene();
    build_quad(s, build_material(s, spec, 0, false), (const float[3]){-2, 0, 2}, (const float[3]){4, 0, 0},
               (const float[3]){0, 0, -4});
    build_camera(s, (const float[3]){0, 1, 3}, (const float[3]){0, .3f, 0}, .8f);
    return s;
}

static void enormous_and_minute_lights(void **state)
{
    (void)state;
    static const float strengths[] = {1e30f, 1e15f, 1e-30f, 1e-42f}; /* the last is denormal */
    for (int i = 0; i < 4; i++) {
        scene *s = floor_and_view("ggx alpha=.3 ks=.5 kd=.4");
        const size_t m = build_material(s, "lambert kd=.5", strengths[i], true);
        build_quad(s, m, (const float[3]){-.5f, 1, -.5f}, (const float[3]){1, 0, 0}, (const float[3]){0, 0, 1});
        build_sphere(s, m, .5f, .3f, 0, .2f);
        const float largest = survive(s);
        if (i == 0) assert_true(largest == FILM_MOST);
        if (i == 1) assert_true(largest > 1e14f && largest < FILM_MOST);
    }
}

/* Overflow is no defect of a path but its sum: it is counted, reported with its place, and black. */
static void overflow_is_reported(void **state)
{
    (void)state;
    scene *s = floor_and_view("lambert kd=.9");
    build_sphere(s, build_material(s, "lambert kd=.9", 3e38f, true), 0, .5f, 0, .4f);
    build_sphere(s, build_material(s, "lambert kd=.9", 3e38f, true), 1, .5f, 0, .4f);
    render_settings r = settings(STRATEGY_MIS);
    render_result result = {0};
    facet_error why = {0};
    assert_int_equal(render(s, &r, &result, &why), FACET_OK);
    assert_true(result.n_bad > 0);
    for (uint64_t i = 0; i < result.n_bad && i < RENDER_MAX_REPORTED; i++) {
        assert_true(result.bad[i].x < r.width && result.bad[i].y < r.height && result.bad[i].sample < r.spp);
        assert_true(result.bad[i].y > 0);
    }
    for (size_t i = 0; i < 3*r.width*r.height; i++)
        assert_true(isfinite(((const float *)result.picture.pixels)[i]));
    render_result_destroy(&result);
    scene_destroy(s);
}

static void triangles_without_area(void **state)
{
    (void)state;
    static const float positions[6][3] = {{0, 0, 0},     {1, 1, 0},     {2, 2, 0},
                                          {.5f, .5f, 0}, {.5f, .5f, 0}, {1e-30f, 1e-30f, 0}};
    static const uint32_t triangles[4][3] = {{0, 1, 2}, {3, 4, 3}, {0, 0, 0}, {0, 5, 5}};
    for (int emits = 0; emits < 2; emits++) {
        scene *s = floor_and_view("lambert kd=.5");
        const size_t m = build_material(s, "lambert kd=.5", emits ? 10 : 0, true);
        build_instance(s, build_mesh(s, m, positions, 6, triangles, 4), NULL);
        for (int k = 0; k < 3; k++) s->environment.scale[k] = 1;
        survive(s);
    }
    scene *s = floor_and_view("lambert kd=.5"); /* a light of such triangles alone */
    build_instance(s, build_mesh(s, build_material(s, "lambert kd=.5", 10, true), positions, 6, triangles, 4), NULL);
    survive(s);
    s = floor_and_view("lambert kd=.5"); /* and one without any triangle */
    build_instance(s, build_mesh(s, build_material(s, "lambert kd=.5", 10, true), positions, 6, triangles, 0), NULL);
    survive(s);
}

/* Slivers of 1e-20 in one direction: areas and normals underflow. */
static void minute_triangles(void **state)
{
    (void)state;
    for (float size = 1; size > 1e-22f; size *= 1e-4f) {
        scene *s = floor_and_view("lambert kd=.5");
        const size_t m = build_material(s, "lambert kd=.5", 10, true);
        build_quad(s, m, (const float[3]){0, .5f, 0}, (const float[3]){size, 0, 0}, (const float[3]){0, size, 0});
        build_quad(s, m, (const float[3]){0, 0, 0}, (const float[3]){size, 0, 0}, (const float[3]){0, 1, 0});
        survive(s);
    }
}

static void singular_and_enormous_instances(void **state)
{
    (void)state;
    static const float maps[5][3][4] = {
        {{0}},
        {{1, 0, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}},
        {{1e-20f, 0, 0, 0}, {0, 1e-20f, 0, 0}, {0, 0, 1e-20f, 0}},
        {{1e15f, 0, 0, 0}, {0, 1e15f, 0, 0}, {0, 0, 1e15f, 0}},
        {{1e-10f, 0, 0, 0}, {0, 1e10f, 0, 0}, {0, 0, 1, 0}},
    };
    for (int emits = 0; emits < 2; emits++)
        for (int i = 0; i < 5; i++)
            for (int is_shared = 0; is_shared < 2; is_shared++) {
                scene *s = floor_and_view("lambert kd=.5");
                const size_t m = build_material(s, "lambert kd=.5", emits ? 1 : 0, true);
                const size_t box = build_box(s, m, (const float[3]){-.3f, .1f, -.3f}, (const float[3]){.3f, .7f, .3f});
                build_instance(s, box, maps[i]);
                if (is_shared) build_instance(s, box, NULL);
                for (int k = 0; k < 3; k++) s->environment.scale[k] = .5f;
                survive(s);
            }
}

static void coincident_surfaces(void **state)
{
    (void)state;
    static const char *const specs[] = {"lambert kd=.8", "ggx alpha=.05 ks=.9", "glass ior=1.5", "glass ior=1"};
    scene *s = floor_and_view("lambert kd=.5");
    for (int i = 0; i < 4; i++) {
        const size_t m = build_material(s, specs[i], i ? 0 : 1, i & 1);
        build_quad(s, m, (const float[3]){-1, 0, 1}, (const float[3]){2, 0, 0}, (const float[3]){0, 0, -2});
        build_sphere(s, m, 0, .5f, 0, .5f);
        build_instance(s, build_box(s, m, (const float[3]){-.9f, 0, -.3f}, (const float[3]){-.3f, .6f, .3f}), NULL);
    }
    for (int k = 0; k < 3; k++) s->environment.scale[k] = 1;
    survive(s);
}

static void a_camera_inside_or_on_things(void **state)
{
    (void)state;
    static const char *const specs[] = {"lambert kd=.8", "ggx alpha=.2 ks=.9", "glass ior=1.5"};
    for (int i = 0; i < 3; i++)
        for (int place = 0; place < 3; place++) {
            scene *s = build_scene();
            const size_t m = build_material(s, specs[i], .5f, place & 1);
            build_sphere(s, m, 0, 0, 0, 1);
            build_instance(s, build_box(s, m, (const float[3]){-2, -2, -2}, (const float[3]){2, 2, 2}), NULL);
            for (int k = 0; k < 3; k++) s->environment.scale[k] = 1;
            const float eye[3] = {place == 1 ? 1.0f : 0.0f, place == 2 ? 2.0f : 0.0f, 0};
            build_camera(s, eye, (const float[3]){.3f, .2f, -.4f}, 1);
            survive(s);
        }
}

static void spheres_of_all_sizes(void **state)
{
    (void)state;
    for (int exponent = -30; exponent <= 18; exponent += 4)
        for (int emits = 0; emits < 2; emits++) {
            scene *s = floor_and_view("lambert kd=.5");
            const float radius = (float)pow(10, exponent);
            build_sphere(s, build_material(s, "ggx alpha=.3 ks=.5 kd=.4", emits ? 1 : 0, true), 0, .3f, 0, radius);
            for (int k = 0; k < 3; k++) s->environment.scale[k] = 1;
            survive(s);
        }
}

static void a_light_at_a_lit_point(void **state)
{
    (void)state;
    for (light_kind kind = LIGHT_POINT; kind <= LIGHT_DIRECTIONAL; kind++) {
        scene *s = floor_and_view("lambert kd=.5");
        const punctual_light light = {.kind = kind,
                                      .position = {0, 0, 0},
                                      .direction = {0, -1, 0},
                                      .intensity = {1, 1, 1},
                                      .cos_inner = 1,
                                      .cos_outer = 1};
        assert_int_equal(scene_add_light(s, &light, NULL), FACET_OK);
        survive(s);
    }
}

/* Half of the texels hostile: they count as black. */
static void a_sky_of_bad_texels(void **state)
{
    (void)state;
    enum { W = 16, H = 8 };
    static float texels[H*W*3];
    static const float bad[] = {NAN, INFINITY, -INFINITY, -1, 3e38f, 1e-45f};
    for (int i = 0; i < H*W*3; i++) texels[i] = i%2 ? 1 : bad[i/2%4];
    scene *s = floor_and_view("lambert kd=.5");
    build_sky(s, W, H, texels);
    survive(s);
    for (int i = 0; i < H*W*3; i++) texels[i] = i == 150 ? 1e30f : bad[5];
    s = floor_and_view("ggx alpha=.3 ks=.5 kd=.4");
    build_sky(s, W, H, texels);
    survive(s);
    for (int i = 0; i < H*W*3; i++) texels[i] = bad[0];
    s = floor_and_view("lambert kd=.5");
    build_sky(s, W, H, texels);
    assert_true(survive(s) == 0);
}

/* Vertex normals that are 0, against the surface, or not unit; tangents likewise; texture coordinates of 1e30. */
static void misleading_vertices(void **state)
{
    (void)state;
    static const unsigned char texels[16] = {128, 128, 255, 255, 0, 0, 0, 0, 255, 0, 128, 255, 10, 250, 0, 255};
    draws d = {3};
    for (int i = 0; i < 40; i++) {
        scene *s = floor_and_view("lambert kd=.5");
        const size_t m = build_gltf_material(s, .8f, i%3*.5f, i%5*.25f);
        const size_t index = build_quad(s, m, (const float[3]){-1, .1f, .5f}, (const float[3]){2, 0, 0},
                                        (const float[3]){0, .2f, -1.5f});
        mesh *own = &s->meshes[index];
        own->normals = calloc(4, sizeof *own->normals);
        own->tangents = calloc(4, sizeof *own->tangents);
        assert_true(own->normals && own->tangents);
        for (int v = 0; v < 4; v++)
            for (int k = 0; k < 3 && i; k++) {
                own->normals[v][k] = (float)draw_between(&d, -1, 1)*(i%7 == 3 ? 1e-25f : 1);
                own->tangents[v][k] = (float)draw_between(&d, -1, 1)*(i%7 == 5 ? 1e20f : 1);
                own->tangents[v][3] = draw(&d) < .5 ? -1.0f : 1.0f;
                if (k < 2 && i%4 == 1) own->uv[0][v][k] *= 1e30f;
            }
        const size_t texture_index = build_texture(s, 2, 2, texels, i & 1);
        s->materials[m].normal_texture.texture = texture_index;
        s->materials[m].metallic_roughness_texture.texture = texture_index;
        s->materials[m].emissive_texture.texture = texture_index;
        for (int k = 0; k < 3; k++) s->materials[m].emission[k] = i%2 ? 1.0f : 0.0f;
        for (int k = 0; k < 3; k++) s->environment.scale[k] = 1;
        survive(s);
    }
}

static void empty_scenes_and_wrong_settings(void **state)
{
    (void)state;
    scene *s = build_scene();
    build_camera(s, origin, (const float[3]){0, 0, -1}, 1);
    assert_true(survive(s) == 0);

    s = floor_and_view("lambert kd=.5");
    render_result result = {0};
    const struct {
        size_t width, height, crop_w, crop_x, camera;
        uint32_t spp, depth, n_threads;
        const char *place;
    } wrong[] = {{0, 1, 0, 0, 0, 1, 1, 1, "size"},      {70000, 1, 0, 0, 0, 1, 1, 1, "size"},
                 {8, 8, 4, 5, 0, 1, 1, 1, "crop"},      {8, 8, 0, 0, 1, 1, 1, 1, "camera"},
                 {8, 8, 0, 0, 0, 0, 1, 1, "spp"},       {8, 8, 0, 0, 0, 1, 5000, 1, "depth"},
                 {8, 8, 0, 0, 0, 1, 1, 2000, "threads"}};
    for (size_t i = 0; i < sizeof wrong/sizeof wrong[0]; i++) {
        render_settings r;
        facet_error why = {0};
        render_settings_defaults(&r);
        r.width = wrong[i].width;
        r.height = wrong[i].height;
        r.crop_w = wrong[i].crop_w;
        r.crop_h = wrong[i].crop_w;
        r.crop_x = wrong[i].crop_x;
        r.camera = wrong[i].camera;
        r.spp = wrong[i].spp;
        r.depth = wrong[i].depth;
        r.n_threads = wrong[i].n_threads;
        assert_int_equal(render(s, &r, &result, &why), FACET_BAD_VALUE);
        assert_string_equal(why.place, wrong[i].place);
        assert_null(result.picture.pixels);
    }
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(enormous_and_minute_lights),
        cmocka_unit_test(overflow_is_reported),
        cmocka_unit_test(triangles_without_area),
        cmocka_unit_test(minute_triangles),
        cmocka_unit_test(singular_and_enormous_instances),
        cmocka_unit_test(coincident_surfaces),
        cmocka_unit_test(a_camera_inside_or_on_things),
        cmocka_unit_test(spheres_of_all_sizes),
        cmocka_unit_test(a_light_at_a_lit_point),
        cmocka_unit_test(a_sky_of_bad_texels),
        cmocka_unit_test(misleading_vertices),
        cmocka_unit_test(empty_scenes_and_wrong_settings),
    };
    return cmocka_run_group_tests_name("hostile_scenes", tests, NULL, NULL);
}
