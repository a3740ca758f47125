/* test_gltf_nodes.c: the node hierarchy of glTF and what hangs on it: instances, cameras, lights, spheres.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/gltf_builder.h"

#define ONE_MESH "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"

static void transforms_multiply_down_the_tree(void **state)
{
    (void)state;
    gltf_builder b = {0};
    add_triangle(&b);
    /* 90 degrees about z, then a move along the turned x; a matrix is written by columns */
    scene *s = load(&b, ONE_MESH "\"nodes\":[{\"children\":[1],\"translation\":[1,2,3],\"scale\":[2,2,2]},"
                                 "{\"children\":[2],\"rotation\":[0,0,1,1]},"
                                 "{\"mesh\":0,\"matrix\":[1,0,0,0, 0,1,0,0, 0,0,-1,0, 5,0,0,1]}]");
    /* the unnormalised quaternion (0,0,1,1) has length sqrt 2: 1 ulp of 2 is the rounding of its division */
    const float expected[12] = {0, -2, 0, 1, 2, 0, 0, 12, 0, 0, -2, 3};
    const float *const m = (const float *)s->instances[0].to_world;
    for (int i = 0; i < 12; i++)
        if (fabsf(m[i] - expected[i]) > 2.4e-7f) fail_msg("entry %d is %a", i, (double)m[i]);
    scene_destroy(s);
}

static void meshes_are_built_once_and_shared(void **state)
{
    (void)state;
    gltf_builder b = {0};
    add_triangle(&b);
    scene *s = load(&b, ONE_MESH "\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"translation\":[0,0,1]},{\"mesh\":0}]");
    assert_int_equal(s->n_meshes, 1);
    assert_int_equal(s->n_instances, 3);
    assert_true(s->instances[1].to_world[2][3] == 1);
    scene_destroy(s);
}

static void the_default_scene_decides_what_is_shown(void **state)
{
    (void)state;
    static const struct {
        const char *rest;
        size_t n_instances;
    } cases[] = {
        {"\"scene\":1,\"scenes\":[{\"nodes\":[0]},{\"nodes\":[1,2]}]", 2},
        {"\"scenes\":[{\"nodes\":[0]},{\"nodes\":[1,2]}]", 1},
        {"\"scenes\":[{}]", 0},
        {"\"asset2\":0", 3},
    };
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        gltf_builder b = {0};
        char rest[512];
        add_triangle(&b);
        snprintf(rest, sizeof rest, ONE_MESH "\"nodes\":[{\"mesh\":0},{\"mesh\":0},{\"mesh\":0}],%s", cases[i].rest);
        scene *s = load(&b, rest);
        assert_int_equal(s->n_instances, cases[i].n_instances);
        scene_destroy(s);
    }
}

static void graphs_that_are_no_trees_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *rest, *place, *text;
    } cases[] = {
        {"\"nodes\":[{\"children\":[0]}]", "nodes[0].children[0]", "its own child"},
        {"\"nodes\":[{\"children\":[1]},{\"children\":[2]},{\"children\":[1]}]", "nodes[2].children[0]",
         "already a child"},
        {"\"nodes\":[{},{\"children\":[2]},{\"children\":[1]}]", "nodes[1]", "its own ancestor"},
        {"\"nodes\":[{\"children\":[1,1]},{}]", "nodes[0].children[1]", "already a child"},
        {"\"nodes\":[{\"children\":[1]},{}],\"scenes\":[{\"nodes\":[0,1]}]", "scenes[0].nodes[1]", "roots only"},
        {"\"nodes\":[{}],\"scenes\":[{\"nodes\":[0,0]}]", "scenes[0].nodes", "lists 2 nodes"},
        {"\"nodes\":[{},{}],\"scenes\":[{\"nodes\":[0,0]}]", "scenes[0].nodes[1]", "again"},
        {"\"nodes\":[{\"mesh\":0}]", "nodes[0].mesh", "the number of meshes is 0"},
        {"\"nodes\":[{\"rotation\":[0,0,0,0]}]", "nodes[0].rotation", "unit quaternion"},
        {"\"nodes\":[{\"matrix\":[1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]", "nodes[0].matrix", "not affine"},
    };
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        const gltf_builder b = {0};
        const facet_error why = refuse(&b, cases[i].rest);
        expect_error(&why, cases[i].place, cases[i].text);
    }
}

static void a_chain_of_100000_nodes_is_read(void **state)
{
    (void)state;
    enum { N = 100000 };
    char *const rest = malloc((size_t)N*48 + 512);
    assert_non_null(rest);
    size_t used = (size_t)sprintf(rest, ONE_MESH "\"nodes\":[");
    for (int i = 0; i < N; i++)
        used += (size_t)sprintf(rest + used, "{\"translation\":[0,1,0],\"children\":[%d]},", i + 1);
    strcpy(rest + used, "{\"mesh\":0}]");
    gltf_builder b = {0};
    add_triangle(&b);
    scene *s = load(&b, rest);
    assert_int_equal(s->n_instances, 1);
    assert_true(s->instances[0].to_world[1][3] == N);
    scene_destroy(s);
    free(rest);
}

static void gpu_instances_multiply_the_node(void **state)
{
    (void)state;
    static const float translations[6] = {1, 0, 0, 0, 2, 0}, scales[6] = {1, 1, 1, 3, 3, 3};
    static const int8_t rotations[8] = {0, 0, 0, 127, 0, 127, 0, 0}; /* none; half a turn about y */
    gltf_builder b = {0};
    add_triangle(&b);
    add_floats(&b, "VEC3", 2, translations, 6);
    add_array(&b, "VEC4", 5120, 2, rotations, sizeof rotations, "\"normalized\":true");
    add_floats(&b, "VEC3", 2, scales, 6);
    scene *s = load(&b, ONE_MESH "\"nodes\":[{\"mesh\":0,\"scale\":[2,2,2],\"extensions\":{\"EXT_mesh_gpu_instancing\":"
                                 "{\"attributes\":{\"TRANSLATION\":1,\"ROTATION\":2,\"SCALE\":3}}}}]");
    assert_int_equal(s->n_meshes, 1);
    assert_int_equal(s->n_instances, 2);
    EXPECT_FLOATS(s->instances[0].to_world, 12, 2, 0, 0, 2, 0, 2, 0, 0, 0, 0, 2, 0);
    EXPECT_FLOATS(s->instances[1].to_world, 12, -6, 0, 0, 0, 0, 6, 0, 4, 0, 0, -6, 0);
    scene_destroy(s);
}

static void spheres_need_even_scale(void **state)
{
    (void)state;
    static const char shape[] = "\"extensions\":{\"FACET_shape\":{\"sphere\":{\"radius\":0.5},\"material\":0}}";
    const gltf_builder b = {0};
    char rest[512];
    snprintf(rest, sizeof rest,
             "\"materials\":[{\"name\":\"ball\"}],\"nodes\":[{\"translation\":[1,2,3],\"scale\":"
             "[-4,4,4],%s},{%s}]",
             shape, shape);
    scene *s = load(&b, rest);
    assert_int_equal(s->n_spheres, 2);
    EXPECT_FLOATS(s->spheres[0].center, 3, 1, 2, 3);
    EXPECT_FLOATS(&s->spheres[0].radius, 1, 2);
    EXPECT_FLOATS(&s->spheres[1].radius, 1, 0.5f);
    assert_string_equal(s->materials[s->spheres[1].material].name, "ball");
    assert_int_equal(s->n_materials, 1);
    scene_destroy(s);
    snprintf(rest, sizeof rest, "\"materials\":[{}],\"nodes\":[{},{\"scale\":[1,1.001,1],%s}]", shape);
    facet_error why = refuse(&b, rest);
    expect_error(&why, "nodes[1]", "the same scale along all axes");
    why = refuse(&b, "\"nodes\":[{\"extensions\":{\"FACET_shape\":{\"sphere\":{\"radius\":0}}}}]");
    expect_error(&why, "nodes[0].extensions.FACET_shape.sphere.radius", "must be above 0");
    why = refuse(&b, "\"nodes\":[{\"extensions\":{\"FACET_shape\":{\"box\":1}}}]");
    expect_error(&why, "nodes[0].extensions.FACET_shape.sphere", "missing");
}

static void cameras_lose_their_scale_and_keep_their_aim(void **state)
{
    (void)state;
    const gltf_builder b = {0};
    scene *s = load(
        &b, "\"cameras\":[{\"type\":\"perspective\",\"name\":\"main\",\"perspective\":{\"yfov\":0.5,\"znear\":1,"
            "\"aspectRatio\":1.5}},{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":3,\"ymag\":2,"
            "\"zfar\":9,\"znear\":0}}],\"nodes\":[{\"camera\":0,\"scale\":[7,8,9],\"translation\":[1,2,3]},"
            "{\"camera\":1,\"name\":\"top\",\"scale\":[0,0,0]},{\"camera\":0},{\"camera\":1}]");
    assert_int_equal(s->n_cameras, 4);
    EXPECT_FLOATS(s->cameras[0].to_world, 12, 1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3);
    EXPECT_FLOATS(&s->cameras[0].yfov, 1, 0.5f);
    EXPECT_FLOATS(&s->cameras[0].aspect, 1, 1.5f);
    assert_false(s->cameras[0].is_orthographic);
    assert_true(s->cameras[1].is_orthographic);
    EXPECT_FLOATS(&s->cameras[1].ymag, 1, 2);
    EXPECT_FLOATS(&s->cameras[1].aspect, 1, 1.5f);
    EXPECT_FLOATS(s->cameras[1].to_world, 12, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0);
    assert_string_equal(s->cameras[0].name, "main");
    assert_string_equal(s->cameras[1].name, "top");
    assert_string_equal(s->cameras[2].name, "main#2");
    assert_string_equal(s->cameras[3].name, "camera1");
    scene_destroy(s);
}

static void impossible_cameras_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *camera, *place;
    } cases[] = {
        {"{\"type\":\"perspective\",\"perspective\":{\"yfov\":0,\"znear\":1}}", "cameras[0].perspective.yfov"},
        {"{\"type\":\"perspective\",\"perspective\":{\"yfov\":3.2,\"znear\":1}}", "cameras[0].perspective.yfov"},
        {"{\"type\":\"perspective\",\"perspective\":{}}", "cameras[0].perspective.yfov"},
        {"{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":0,\"ymag\":1}}", "cameras[0].orthographic.xmag"},
        {"{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":1e9,\"ymag\":1}}", "cameras[0].orthographic"},
        {"{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"aspectRatio\":0}}",
         "cameras[0].perspective.aspectRatio"},
        {"{\"type\":\"fisheye\"}", "cameras[0].type"},
    };
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        const gltf_builder b = {0};
        char rest[256];
        snprintf(rest, sizeof rest, "\"cameras\":[%s],\"nodes\":[{\"camera\":0}]", cases[i].camera);
        const facet_error why = refuse(&b, rest);
        expect_error(&why, cases[i].place, "");
    }
}

#define LIGHTS(lights) "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[" lights "]}},"
#define LIGHT_NODE(members) "\"nodes\":[{" members "\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}]"

static void lights_shine_along_minus_z_in_radiometric_units(void **state)
{
    (void)state;
    const gltf_builder b = {0};
    scene *s = load(&b, LIGHTS("{\"type\":\"spot\",\"intensity\":10,\"color\":[1,0.5,0],\"spot\":{}}")
                            LIGHT_NODE("\"translation\":[1,2,3],\"scale\":[5,5,5],\"rotation\":[0,1,0,0],"));
    assert_int_equal(s->n_lights, 1);
    const punctual_light *const light = &s->lights[0];
    assert_int_equal(light->kind, LIGHT_SPOT);
    EXPECT_FLOATS(light->position, 3, 1, 2, 3);
    EXPECT_FLOATS(light->direction, 3, 0, 0, 1);
    EXPECT_FLOATS(light->intensity, 3, 10, 5, 0);
    EXPECT_FLOATS(&light->cos_inner, 1, 1);
    EXPECT_FLOATS(&light->cos_outer, 1, (float)cos(3.14159265358979323846/4));
    scene_destroy(s);
    s = load(&b, LIGHTS("{\"type\":\"point\",\"range\":4}") LIGHT_NODE(""));
    EXPECT_FLOATS(s->lights[0].intensity, 3, 1, 1, 1);
    assert_non_null(strstr(gltf_warnings, "extensions.KHR_lights_punctual.lights[0]: range 4 is ignored"));
    scene_destroy(s);
    s = load(&b, LIGHTS("{\"type\":\"directional\",\"intensity\":3}") LIGHT_NODE(""));
    assert_int_equal(s->lights[0].kind, LIGHT_DIRECTIONAL);
    scene_destroy(s);
}

static void impossible_lights_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *rest, *place;
    } cases[] = {
        {LIGHTS("{\"type\":\"spot\",\"spot\":{\"innerConeAngle\":1,\"outerConeAngle\":0.5}}") LIGHT_NODE(""), ".spot"},
        {LIGHTS("{\"type\":\"spot\",\"spot\":{\"outerConeAngle\":1.6}}") LIGHT_NODE(""), ".spot.outerConeAngle"},
        {LIGHTS("{\"type\":\"spot\"}") LIGHT_NODE(""), ".spot"},
        {LIGHTS("{\"type\":\"area\"}") LIGHT_NODE(""), ".type"},
        {LIGHTS("{\"type\":\"point\",\"intensity\":-1}") LIGHT_NODE(""), ".intensity"},
    };
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        const gltf_builder b = {0};
        char place[96];
        snprintf(place, sizeof place, "extensions.KHR_lights_punctual.lights[0]%s", cases[i].place);
        const facet_error why = refuse(&b, cases[i].rest);
        expect_error(&why, place, "");
    }
}

static void singular_transforms_and_flat_triangles_are_read(void **state)
{
    (void)state;
    gltf_builder b = {0};
    add_triangle(&b);
    scene *s = load(&b, ONE_MESH "\"nodes\":[{\"mesh\":0,\"scale\":[0,1,1]}]");
    EXPECT_FLOATS(s->instances[0].to_world, 12, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0);
    scene_destroy(s);
    const facet_error why = refuse(&b, ONE_MESH "\"nodes\":[{\"mesh\":0,\"scale\":[1e19,1,1]}]");
    expect_error(&why, "nodes[0]", "must stay within 1e+18 m");
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)
    const struct CMUnitTest tests[] = {
        TEST(transforms_multiply_down_the_tree),
        TEST(meshes_are_built_once_and_shared),
        TEST(the_default_scene_decides_what_is_shown),
        TEST(graphs_that_are_no_trees_are_refused),
        TEST(a_chain_of_100000_nodes_is_read),
        TEST(gpu_instances_multiply_the_node),
        TEST(spheres_need_even_scale),
        TEST(cameras_lose_their_scale_and_keep_their_aim),
        TEST(impossible_cameras_are_refused),
        TEST(lights_shine_along_minus_z_in_radiometric_units),
        TEST(impossible_lights_are_refused),
        TEST(singular_transforms_and_flat_triangles_are_read),
    };
    return cmocka_run_group_tests_name("glTF nodes", tests, NULL, NULL);
}
