/* test_gltf.c: geometry from glTF: accessors of every kind, primitive modes, attributes, morphs and skins.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "tests/gltf_builder.h"

static void expect_triangles(const mesh *m, size_t n, const uint32_t (*expected)[3])
{
    assert_int_equal(m->n_triangles, n);
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < 3; k++)
            if (m->triangles[i][k] != expected[i][k])
                fail_msg("triangle %zu is %u %u %u", i, m->triangles[i][0], m->triangles[i][1], m->triangles[i][2]);
}

/* ---- Modes and indices ---------------------------------------------------------------------------- */

/* Five vertices in a row, accessor 0. */
static void add_row(gltf_builder *b)
{
    float corners[15];
    for (int i = 0; i < 15; i++) corners[i] = (float)i;
    add_floats(b, "VEC3", 5, corners, 15);
}

static void triangles_without_indices_take_vertices_in_order(void **state)
{
    (void)state;
    gltf_builder b = {0};
    add_triangle(&b);
    scene *s = load_primitive(&b, "{\"attributes\":{\"POSITION\":0}}");
    assert_int_equal(s->n_meshes, 1);
    assert_int_equal(s->n_instances, 1);
    expect_triangles(&s->meshes[0], 1, (const uint32_t[][3]){{0, 1, 2}});
    EXPECT_FLOATS(s->meshes[0].positions, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    assert_null(s->meshes[0].normals);
    assert_null(s->meshes[0].uv[0]);
    assert_string_equal(s->materials[s->meshes[0].material].name, "default");
    scene_destroy(s);
}

static void strips_and_fans_become_the_triangles_of_the_specification(void **state)
{
    (void)state;
    gltf_builder b = {0};
    add_row(&b);
    scene *s = load_primitive(&b, "{\"attributes\":{\"POSITION\":0},\"mode\":5}");
    expect_triangles(&s->meshes[0], 3, (const uint32_t[][3]){{0, 1, 2}, {1, 3, 2}, {2, 3, 4}});
    scene_destroy(s);
    s = load_primitive(&b, "{\"attributes\":{\"POSITION\":0},\"mode\":6}");
    expect_triangles(&s->meshes[0], 3, (const uint32_t[][3]){{1, 2, 0}, {2, 3, 0}, {3, 4, 0}});
    scene_destroy(s);
}

static void indices_of_each_size_are_read(void **state)
{
    (void)state;
    static const uint8_t u8[6] = {4, 0, 2, 1, 2, 3};
    static const uint16_t u16[6] = {4, 0, 2, 1, 2, 3};
    static const uint32_t u32[6] = {4, 0, 2, 1, 2, 3};
    gltf_builder b = {0};
    add_row(&b);
    add_array(&b, "SCALAR", 5121, 6, u8, sizeof u8, "");
    add_array(&b, "SCALAR", 5123, 6, u16, sizeof u16, "");
    add_array(&b, "SCALAR", 5125, 6, u32, sizeof u32, "");
    for (int accessor = 1; accessor <= 3; accessor++) {
        char primitive[80];
        snprintf(primitive, sizeof primitive, "{\"attributes\":{\"POSITION\":0},\"indices\":%d}", accessor);
        scene *s = load_primitive(&b, primitive);
        expect_triangles(&s->meshes[0], 2, (const uint32_t[][3]){{4, 0, 2}, {1, 2, 3}});
        scene_destroy(s);
    }
}

static void indices_out_of_range_and_restarts_are_refused(void **state)
{
    (void)state;
    static const uint8_t outside[3] = {0, 1, 5}, restart[3] = {0, 255, 1};
    static const char primitive[] = "{\"attributes\":{\"POSITION\":0},\"indices\":1}";
    static const char place[] = "meshes[0].primitives[0].indices";
    gltf_builder b = {0}, c = {0};
    add_row(&b);
    add_row(&c);
    add_array(&b, "SCALAR", 5121, 3, outside, 3, "");
    add_array(&c, "SCALAR", 5121, 3, restart, 3, "");
    facet_error why = refuse_primitive(&b, primitive);
    expect_error(&why, place, "index 2 is 5, but there are 5 vertices");
    why = refuse_primitive(&c, primitive);
    expect_error(&why, place, "restart");
}

static void points_and_lines_are_left_out_with_a_warning(void **state)
{
    (void)state;
    gltf_builder b = {0};
    add_row(&b);
    for (int mode = 0; mode < 4; mode++) {
        char primitive[64];
        snprintf(primitive, sizeof primitive, "{\"attributes\":{\"POSITION\":0},\"mode\":%d}", mode);
        scene *s = load_primitive(&b, primitive);
        assert_int_equal(s->n_meshes, 0);
        assert_int_equal(s->n_instances, 0);
        assert_non_null(strstr(gltf_warnings, "meshes[0].primitives[0]: "));
        assert_non_null(strstr(gltf_warnings, "left out"));
        scene_destroy(s);
    }
    const facet_error why = refuse_primitive(&b, "{\"attributes\":{\"POSITION\":0},\"mode\":7}");
    expect_error(&why, "meshes[0].primitives[0].mode", "must be from 0 to 6");
}

/* ---- Accessors ------------------------------------------------------------------------------------ */

static void normalized_integers_follow_the_specification(void **state)
{
    (void)state;
    static const uint8_t u8[6] = {0, 255, 51, 1, 2, 3};
    static const uint16_t u16[6] = {0, 65535, 13107, 1, 2, 3};
    static const int8_t i8[8] = {-128, -127, 127, 0, 1, 64, 0, 0};
    gltf_builder b = {0};
    add_triangle(&b);
    add_array(&b, "VEC2", 5121, 3, u8, sizeof u8, "\"normalized\":true");
    add_array(&b, "VEC2", 5123, 3, u16, sizeof u16, "\"normalized\":true");
    scene *s = load_primitive(&b, "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1,\"TEXCOORD_1\":2}}");
    EXPECT_FLOATS(s->meshes[0].uv[0], 6, 0, 1, 51/255.0f, 1/255.0f, 2/255.0f, 3/255.0f);
    EXPECT_FLOATS(s->meshes[0].uv[1], 6, 0, 1, 13107/65535.0f, 1/65535.0f, 2/65535.0f, 3/65535.0f);
    scene_destroy(s);
    gltf_builder c = {0};
    add_triangle(&c);
    add_array(&c, "VEC2", 5120, 3, i8, 6, "\"normalized\":true");
    s = load_primitive(&c, "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1}}");
    EXPECT_FLOATS(s->meshes[0].uv[0], 6, -1, -1, 1, 0, 1/127.0f, 64/127.0f);
    scene_destroy(s);
}

static void quantized_positions_and_normals_are_read(void **state)
{
    (void)state;
    static const int16_t positions[12] = {-5, 300, 7, 0, 32767, -32768, 1, 0, 0, 0, 2, 0};
    static const int8_t normals[12] = {0, 0, 127, 0, 127, 0, 0, 0, -128, 0, 0, 0};
    gltf_builder b = {0};
    const int p = add_view(&b, positions, sizeof positions, "\"byteStride\":8");
    const int n = add_view(&b, normals, sizeof normals, "\"byteStride\":4");
    assert_int_equal(p, 0);
    assert_int_equal(n, 1);
    add_accessor(&b, "\"bufferView\":0,\"type\":\"VEC3\",\"componentType\":5122,\"count\":3");
    add_accessor(&b, "\"bufferView\":1,\"type\":\"VEC3\",\"componentType\":5120,\"count\":3,\"normalized\":true");
    scene *s = load_primitive(&b, "{\"attributes\":{\"POSITION\":0,\"NORMAL\":1}}");
    EXPECT_FLOATS(s->meshes[0].positions, 9, -5, 300, 7, 32767, -32768, 1, 0, 0, 2);
    EXPECT_FLOATS(s->meshes[0].normals, 9, 0, 0, 1, 1, 0, 0, -1, 0, 0);
    scene_destroy(s);
}

static void interleaved_and_offset_accessors_are_read(void **state)
{
    (void)state;
    static const float data[16] = {99, 0, 0, 0, 7, 1, 0, 0, 8, 0, 1, 0, 9, 0, 0, 0};
    gltf_builder b = {0};
    add_view(&b, data, 13*sizeof *data, "\"byteStride\":16");
    add_accessor(&b, "\"bufferView\":0,\"byteOffset\":4,\"type\":\"VEC3\",\"componentType\":5126,\"count\":3");
    scene *s = load_primitive(&b, "{\"attributes\":{\"POSITION\":0}}");
    EXPECT_FLOATS(s->meshes[0].positions, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    scene_destroy(s);
    gltf_builder c = {0};
    add_view(&c, data, 11*sizeof *data, "\"byteStride\":16"); /* one float too short */
    add_accessor(&c, "\"bufferView\":0,\"byteOffset\":4,\"type\":\"VEC3\",\"componentType\":5126,\"count\":3");
    const facet_error why = refuse_primitive(&c, "{\"attributes\":{\"POSITION\":0}}");
    expect_error(&why, "accessors[0]", "do not fit into bufferViews[0] of 44 bytes");
}

static void sparse_accessors_replace_elements_with_and_without_a_base(void **state)
{
    (void)state;
    static const float base[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, values[6] = {5, 6, 7, 8, 9, 10};
    static const uint8_t indices[2] = {0, 2}, falling[2] = {2, 0};
    static const char *const bases[] = {"\"bufferView\":0,", ""};
    const float expected[2][9] = {{5, 6, 7, 1, 0, 0, 8, 9, 10}, {5, 6, 7, 0, 0, 0, 8, 9, 10}};
    for (int i = 0; i < 3; i++) {
        gltf_builder b = {0};
        char members[256];
        add_view(&b, base, sizeof base, "");
        add_view(&b, i == 2 ? falling : indices, 2, "");
        add_view(&b, values, sizeof values, "");
        snprintf(members, sizeof members,
                 "%s\"type\":\"VEC3\",\"componentType\":5126,\"count\":3,\"sparse\":{\"count\":2,\"indices\":"
                 "{\"bufferView\":1,\"componentType\":5121},\"values\":{\"bufferView\":2}}",
                 bases[i%2]);
        add_accessor(&b, members);
        if (i == 2) {
            const facet_error why = refuse_primitive(&b, "{\"attributes\":{\"POSITION\":0}}");
            expect_error(&why, "meshes[0].primitives[0].attributes.POSITION", "must grow");
            continue;
        }
        scene *s = load_primitive(&b, "{\"attributes\":{\"POSITION\":0}}");
        expect_floats((const float *)s->meshes[0].positions, expected[i], 9, bases[i]);
        scene_destroy(s);
    }
}

static void zeros_from_nothing_are_capped(void **state)
{
    (void)state;
    gltf_builder b = {0};
    add_accessor(&b, "\"type\":\"VEC3\",\"componentType\":5126,\"count\":1000000000000");
    const facet_error why = refuse_primitive(&b, "{\"attributes\":{\"POSITION\":0}}");
    assert_int_equal(why.status, FACET_UNSUPPORTED);
}

static void positions_must_be_finite_vec3(void **state)
{
    (void)state;
    static const char place[] = "meshes[0].primitives[0].attributes.POSITION";
    const float bad[9] = {0, 0, 0, 1, NAN, 0, 0, 1, 0};
    gltf_builder b = {0}, c = {0};
    add_floats(&b, "VEC3", 3, bad, 9);
    facet_error why = refuse_primitive(&b, "{\"attributes\":{\"POSITION\":0}}");
    expect_error(&why, place, "element 1, component 1 is NaN");
    add_floats(&c, "VEC2", 3, bad, 6);
    why = refuse_primitive(&c, "{\"attributes\":{\"POSITION\":0}}");
    expect_error(&why, place, "VEC2");
}

/* ---- Attributes ----------------------------------------------------------------------------------- */

static void normals_are_made_unit_and_mended(void **state)
{
    (void)state;
    const float normals[9] = {0, 0, 4, 0, 0, 0, INFINITY, 0, 0};
    gltf_builder b = {0};
    add_triangle(&b);
    add_floats(&b, "VEC3", 3, normals, 9);
    scene *s = load_primitive(&b, "{\"attributes\":{\"POSITION\":0,\"NORMAL\":1}}");
    EXPECT_FLOATS(s->meshes[0].normals, 9, 0, 0, 1, 0, 0, 1, 0, 0, 1);
    scene_destroy(s);
}

static void tangents_are_unit_with_handedness_and_need_normals(void **state)
{
    (void)state;
    static const float normals[9] = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    const float tangents[12] = {3, 0, 0, -2, 0, 0, 0, 1, 0, 0.5f, 0, 1};
    gltf_builder b = {0};
    add_triangle(&b);
    add_floats(&b, "VEC3", 3, normals, 9);
    add_floats(&b, "VEC4", 3, tangents, 12);
    scene *s = load_primitive(&b, "{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TANGENT\":2}}");
    float(*const t)[4] = s->meshes[0].tangents;
    EXPECT_FLOATS(t[0], 4, 1, 0, 0, -1);
    EXPECT_FLOATS(t[2], 4, 0, 1, 0, 1);
    /* a tangent of zero becomes any that is unit and at right angles to the normal: exact for +z */
    assert_true(t[1][2] == 0 && t[1][0]*t[1][0] + t[1][1]*t[1][1] == 1 && t[1][3] == 1);
    scene_destroy(s);
    s = load_primitive(&b, "{\"attributes\":{\"POSITION\":0,\"TANGENT\":2}}");
    assert_null(s->meshes[0].tangents);
    scene_destroy(s);
}

static void vertex_colours_are_rgba_in_range(void **state)
{
    (void)state;
    static const float rgb[9] = {0.5f, 2, -1, 1, 1, 1, 0, 0, 0};
    static const uint16_t rgba[12] = {65535, 0, 0, 32768, 0, 0, 0, 0, 0, 0, 0, 65535};
    gltf_builder b = {0};
    add_triangle(&b);
    add_floats(&b, "VEC3", 3, rgb, 9);
    add_array(&b, "VEC4", 5123, 3, rgba, sizeof rgba, "\"normalized\":true");
    scene *s = load_primitive(&b, "{\"attributes\":{\"POSITION\":0,\"COLOR_0\":1}}");
    EXPECT_FLOATS(s->meshes[0].colors, 12, 0.5f, 1, 0, 1, 1, 1, 1, 1, 0, 0, 0, 1);
    scene_destroy(s);
    s = load_primitive(&b, "{\"attributes\":{\"POSITION\":0,\"COLOR_0\":2}}");
    EXPECT_FLOATS(s->meshes[0].colors, 4, 1, 0, 0, 32768/65535.0f);
    scene_destroy(s);
}

static void texture_coordinates_without_a_fraction_are_clipped(void **state)
{
    (void)state;
    static const float uv[6] = {3e38f, -3e38f, 0.25f, -7.5f, 1e7f, 0};
    gltf_builder b = {0};
    add_triangle(&b);
    add_floats(&b, "VEC2", 3, uv, 6);
    scene *s = load_primitive(&b, "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1}}");
    EXPECT_FLOATS(s->meshes[0].uv[0], 6, 16777216, -16777216, 0.25f, -7.5f, 1e7f, 0);
    scene_destroy(s);
}

static void attributes_of_another_length_are_refused(void **state)
{
    (void)state;
    static const float uv[4] = {0, 0, 1, 1};
    gltf_builder b = {0};
    add_triangle(&b);
    add_floats(&b, "VEC2", 2, uv, 4);
    const facet_error why = refuse_primitive(&b, "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1}}");
    expect_error(&why, "meshes[0].primitives[0].attributes.TEXCOORD_0", "has 2 elements, but POSITION has 3");
}

/* ---- Morph targets and skins ---------------------------------------------------------------------- */

static void morph_targets_are_applied_at_their_default_weights(void **state)
{
    (void)state;
    static const float up[9] = {0, 0, 4, 0, 0, 4, 0, 0, 4}, side[9] = {8, 0, 0, 0, 0, 0, 0, 0, 0};
    static const char morphing[] = "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":"
                                   "[{\"POSITION\":1},{\"POSITION\":2}]}],\"weights\":[0.5,0.25]}],";
    gltf_builder b = {0};
    char rest[512];
    add_triangle(&b);
    add_floats(&b, "VEC3", 3, up, 9);
    add_floats(&b, "VEC3", 3, side, 9);
    snprintf(rest, sizeof rest, "%s\"nodes\":[{\"mesh\":0},{\"mesh\":0},{\"mesh\":0,\"weights\":[0,1]}]", morphing);
    scene *s = load(&b, rest);
    /* two nodes share the mesh's weights, the third has its own */
    assert_int_equal(s->n_meshes, 2);
    assert_int_equal(s->n_instances, 3);
    assert_int_equal(s->instances[1].mesh, 0);
    EXPECT_FLOATS(s->meshes[0].positions, 9, 2, 0, 2, 1, 0, 2, 0, 1, 2);
    EXPECT_FLOATS(s->meshes[1].positions, 9, 8, 0, 0, 1, 0, 0, 0, 1, 0);
    scene_destroy(s);
    snprintf(rest, sizeof rest, "%s\"nodes\":[{\"mesh\":0,\"weights\":[1]}]", morphing);
    const facet_error why = refuse(&b, rest);
    expect_error(&why, "nodes[0].weights", "has 1 weights for 2 morph targets");
}

static void skinned_vertices_go_where_their_joints_are(void **state)
{
    (void)state;
    static const uint8_t joints[12] = {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0};
    static const float weights[12] = {1, 0, 0, 0, 2, 0, 0, 0, 0.5f, 0.5f, 0, 0};
    static const float binds[32] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                                    1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1};
    static const char rest[] =
        "\"nodes\":[{\"mesh\":0,\"skin\":0,\"translation\":[100,100,100]},{\"translation\":[0,0,3],\"children\":[2]},"
        "{\"scale\":[2,2,2]}],\"skins\":[{\"joints\":[1,2],\"inverseBindMatrices\":3}],\"meshes\":[{\"primitives\":"
        "[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":2}}]}]";
    gltf_builder b = {0};
    add_triangle(&b);
    add_array(&b, "VEC4", 5121, 3, joints, sizeof joints, "");
    add_floats(&b, "VEC4", 3, weights, 12);
    add_floats(&b, "MAT4", 2, binds, 32);
    scene *s = load(&b, rest);
    /* joint 0 moves by z 3; joint 1 maps p to 2(p - x) + 3z; the node's own transform does not count, and
     * weights that add up to 2 are divided by their sum */
    EXPECT_FLOATS(s->meshes[0].positions, 9, 0, 0, 3, 0, 0, 3, -1, 1.5f, 3);
    EXPECT_FLOATS(s->instances[0].to_world, 12, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0);
    scene_destroy(s);
    static const uint8_t outside[12] = {2};
    gltf_builder c = {0};
    add_triangle(&c);
    add_array(&c, "VEC4", 5121, 3, outside, sizeof outside, "");
    add_floats(&c, "VEC4", 3, weights, 12);
    add_floats(&c, "MAT4", 2, binds, 32);
    const facet_error why = refuse(&c, rest);
    expect_error(&why, "meshes[0].primitives[0].attributes.JOINTS_0", "uses joint 2 of 2");
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)
    const struct CMUnitTest tests[] = {
        TEST(triangles_without_indices_take_vertices_in_order),
        TEST(strips_and_fans_become_the_triangles_of_the_specification),
        TEST(indices_of_each_size_are_read),
        TEST(indices_out_of_range_and_restarts_are_refused),
        TEST(points_and_lines_are_left_out_with_a_warning),
        TEST(normalized_integers_follow_the_specification),
        TEST(quantized_positions_and_normals_are_read),
        TEST(interleaved_and_offset_accessors_are_read),
        TEST(sparse_accessors_replace_elements_with_and_without_a_base),
        TEST(zeros_from_nothing_are_capped),
        TEST(positions_must_be_finite_vec3),
        TEST(normals_are_made_unit_and_mended),
        TEST(tangents_are_unit_with_handedness_and_need_normals),
        TEST(vertex_colours_are_rgba_in_range),
        TEST(texture_coordinates_without_a_fraction_are_clipped),
        TEST(attributes_of_another_length_are_refused),
        TEST(morph_targets_are_applied_at_their_default_weights),
        TEST(skinned_vertices_go_where_their_joints_are),
    };
    return cmocka_run_group_tests_name("glTF geometry", tests, NULL, NULL);
}
