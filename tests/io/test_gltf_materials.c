/* test_gltf_materials.c: materials, textures and images of glTF, and what is said about those not rendered.
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

#include "io/image_file.h"
#include "tests/gltf_builder.h"

/* Reads a file with one triangle of the given material and more top-level members. */
static char *with_material(const char *members, const char *more)
{
    gltf_builder b = {0};
    char rest[4096];
    add_triangle(&b);
    snprintf(rest, sizeof rest,
             "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},"
             "\"material\":0}]}],\"materials\":[{%s}]%s",
             members, more);
    return gltf_text(&b, rest);
}

static scene *load_material(const char *members, const char *more)
{
    char *const text = with_material(members, more);
    scene *const s = load_text(text);
    free(text);
    assert_int_equal(s->n_materials, 1);
    return s;
}

static facet_error refuse_material(const char *members, const char *more)
{
    char *const text = with_material(members, more);
    const facet_error why = refuse_text(text);
    free(text);
    return why;
}

/* A 1 x 1 PNG called "dot.png" in the test's folder. */
static void write_dot(void)
{
    unsigned char pixel[3] = {255, 128, 0};
    const image dot = {1, 1, 3, PIXEL_U8, pixel};
    assert_int_equal(png_write(gltf_test_path("dot.png"), &dot, NULL, 0, NULL), FACET_OK);
}

static void defaults_are_those_of_the_specification(void **state)
{
    (void)state;
    scene *s = load_material("", "");
    const material *const m = &s->materials[0];
    assert_string_equal(m->name, "material0");
    assert_int_equal(m->kind, SURFACE_METALLIC_ROUGHNESS);
    EXPECT_FLOATS(m->base_color, 4, 1, 1, 1, 1);
    EXPECT_FLOATS(&m->metallic, 1, 1);
    EXPECT_FLOATS(&m->roughness, 1, 1);
    EXPECT_FLOATS(&m->ior, 1, 1.5f);
    EXPECT_FLOATS(m->emission, 3, 0, 0, 0);
    assert_int_equal(m->alpha, ALPHA_OPAQUE);
    assert_false(m->is_double_sided || m->is_thin);
    assert_true(m->base_color_texture.texture == NONE);
    scene_destroy(s);
}

static void factors_are_read(void **state)
{
    (void)state;
    scene *s = load_material(
        "\"name\":\"paint\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.1,0.2,0.3,0.4],\"metallicFactor\":0.5,"
        "\"roughnessFactor\":0.25},\"alphaMode\":\"MASK\",\"alphaCutoff\":0.75,\"doubleSided\":true,\"emissiveFactor\":"
        "[1,0.5,0],\"extensions\":{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":8},\"KHR_materials_ior\":"
        "{\"ior\":1.25},\"KHR_materials_specular\":{\"specularFactor\":0.5,\"specularColorFactor\":[1,2,3]}}",
        "");
    const material *const m = &s->materials[0];
    assert_string_equal(m->name, "paint");
    EXPECT_FLOATS(m->base_color, 4, 0.1f, 0.2f, 0.3f, 0.4f);
    EXPECT_FLOATS(&m->metallic, 1, 0.5f);
    EXPECT_FLOATS(&m->roughness, 1, 0.25f);
    EXPECT_FLOATS(m->emission, 3, 8, 4, 0);
    EXPECT_FLOATS(&m->ior, 1, 1.25f);
    EXPECT_FLOATS(&m->specular, 1, 0.5f);
    EXPECT_FLOATS(m->specular_color, 3, 1, 2, 3);
    EXPECT_FLOATS(&m->alpha_cutoff, 1, 0.75f);
    assert_int_equal(m->alpha, ALPHA_MASK);
    assert_true(m->is_double_sided);
    assert_string_equal(gltf_warnings, "");
    scene_destroy(s);
}

static void factors_out_of_range_name_material_and_range(void **state)
{
    (void)state;
    static const struct {
        const char *members, *place, *text;
    } cases[] = {
        {"\"pbrMetallicRoughness\":{\"roughnessFactor\":-1}", "pbrMetallicRoughness.roughnessFactor",
         "is -1; must be from 0 to 1"},
        {"\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,2]}", "pbrMetallicRoughness.baseColorFactor[3]",
         "must be from 0 to 1"},
        {"\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1]}", "pbrMetallicRoughness.baseColorFactor",
         "must have 4"},
        {"\"emissiveFactor\":[2,0,0]", "emissiveFactor[0]", "must be from 0 to 1"},
        {"\"alphaMode\":\"GLASS\"", "alphaMode", "must be OPAQUE, MASK or BLEND"},
        {"\"extensions\":{\"KHR_materials_ior\":{\"ior\":0.5}}", "extensions.KHR_materials_ior.ior", "at least 1"},
        {"\"extensions\":{\"KHR_materials_volume\":{\"attenuationDistance\":0}}",
         "extensions.KHR_materials_volume.attenuationDistance", "must be above 0"},
        {"\"extensions\":{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":1e30}}",
         "extensions.KHR_materials_emissive_strength.emissiveStrength", "must be from 0 to 1e+18"},
    };
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        char place[96];
        snprintf(place, sizeof place, "materials[0].%s", cases[i].place);
        const facet_error why = refuse_material(cases[i].members, "");
        assert_int_equal(why.status, i == 2 ? FACET_BAD_FILE : FACET_BAD_VALUE);
        expect_error(&why, place, cases[i].text);
    }
}

static void an_ior_of_zero_reflects_everything(void **state)
{
    (void)state;
    scene *s = load_material("\"extensions\":{\"KHR_materials_ior\":{\"ior\":0},\"KHR_materials_specular\":"
                             "{\"specularColorFactor\":[0.5,1,2]}}",
                             "");
    const float ior = s->materials[0].ior, root = (ior - 1)/(ior + 1);
    EXPECT_FLOATS(&root, 1, 1);
    EXPECT_FLOATS(s->materials[0].specular_color, 3, 0.5f, 1, 1);
    scene_destroy(s);
}

static void transmission_is_thin_without_thickness(void **state)
{
    (void)state;
    scene *s = load_material("\"pbrMetallicRoughness\":{\"roughnessFactor\":0},\"extensions\":"
                             "{\"KHR_materials_transmission\":{\"transmissionFactor\":0.5}}",
                             "");
    EXPECT_FLOATS(&s->materials[0].transmission, 1, 0.5f);
    assert_true(s->materials[0].is_thin);
    assert_string_equal(gltf_warnings, "");
    scene_destroy(s);
    s = load_material("\"pbrMetallicRoughness\":{\"roughnessFactor\":0},\"extensions\":{\"KHR_materials_transmission\":"
                      "{\"transmissionFactor\":1,\"transmissionTexture\":{\"index\":0}},\"KHR_materials_volume\":"
                      "{\"thicknessFactor\":2,\"attenuationDistance\":3,\"attenuationColor\":[1,0.5,1]}}",
                      "");
    assert_false(s->materials[0].is_thin);
    assert_non_null(strstr(gltf_warnings, "materials[0]: KHR_materials_volume's attenuation is not supported"));
    assert_non_null(strstr(gltf_warnings, "transmissionTexture is not supported"));
    scene_destroy(s);
    s = load_material("\"pbrMetallicRoughness\":{\"roughnessFactor\":0.5},\"extensions\":"
                      "{\"KHR_materials_transmission\":{\"transmissionFactor\":1}}",
                      "");
    EXPECT_FLOATS(&s->materials[0].roughness, 1, 0.5f);
    assert_string_equal(gltf_warnings, "");
    scene_destroy(s);
}

static void unlit_and_bsdf_materials_are_told_apart(void **state)
{
    (void)state;
    scene *s = load_material("\"extensions\":{\"KHR_materials_unlit\":{}}", "");
    assert_int_equal(s->materials[0].kind, SURFACE_UNLIT);
    scene_destroy(s);
    s = load_material(
        "\"extensions\":{\"FACET_materials_bsdf\":{\"model\":\"ggx\",\"alpha\":0.25,\"ks\":[0.9,0.7,0.3]}}", "");
    assert_int_equal(s->materials[0].kind, SURFACE_BSDF);
    facet_material expected = {.struct_size = sizeof expected};
    facet_bsdf bsdf;
    assert_int_equal(facet_material_parse("ggx alpha=.25 ks=.9,.7,.3", &expected, NULL), FACET_OK);
    assert_int_equal(facet_bsdf_prepare(&expected, &bsdf, NULL), FACET_OK);
    const float wi[3] = {0.6f, 0, 0.8f}, wo[3] = {0, 0.6f, 0.8f};
    float f[2][3];
    facet_bsdf_eval(&s->materials[0].bsdf, wi, wo, f[0]);
    facet_bsdf_eval(&bsdf, wi, wo, f[1]);
    assert_true(f[0][0] > 0);
    expect_floats(f[0], f[1], 3, "f of the material and of its text form");
    scene_destroy(s);
}

static void bsdf_materials_are_checked_by_the_parameter_table(void **state)
{
    (void)state;
    static const struct {
        const char *object, *place, *text;
    } cases[] = {
        {"{\"alpha\":1}", ".model", "missing"},
        {"{\"model\":\"paint\"}", ".model", ""},
        {"{\"model\":\"ggx\",\"gloss\":1}", ".gloss", "ggx has no such parameter; it has alpha, "},
        {"{\"model\":\"ggx\",\"alpha\":-1}", ".alpha", ""},
        {"{\"model\":\"ggx\",\"alpha\":\"low\"}", ".alpha", "is a string; must be a number"},
        {"{\"model\":\"ggx\",\"ks\":[1,2]}", ".ks", "must have 1 or 3"},
        {"{\"model\":\"ggx\",\"g2\":\"maybe\"}", ".g2", "is not one of"},
        {"{\"model\":\"ggx\",\"g2\":1}", ".g2", "must be a name: one of correlated|separable"},
        {"{\"model\":\"ggx\",\"metal\":3}", ".metal", "must be a name: one of "},
        {"{\"model\":\"ggx\",\"energy\":[1,1,1]}", ".energy", "must be a name: one of "},
    };
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        char members[256], place[96];
        snprintf(members, sizeof members, "\"extensions\":{\"FACET_materials_bsdf\":%s}", cases[i].object);
        snprintf(place, sizeof place, "materials[0].extensions.FACET_materials_bsdf%s", cases[i].place);
        const facet_error why = refuse_material(members, "");
        expect_error(&why, place, cases[i].text);
    }
}

static void what_is_not_rendered_is_reported_once_with_its_count(void **state)
{
    (void)state;
    static const char sheen[] = "{\"extensions\":{\"KHR_materials_sheen\":{\"sheenColorFactor\":[0,0,1]}}}";
    gltf_builder b = {0};
    char rest[2048];
    add_triangle(&b);
    snprintf(rest, sizeof rest,
             "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":2},"
             "{\"attributes\":{\"POSITION\":0},\"material\":1},{\"attributes\":{\"POSITION\":0},\"material\":0}]}],"
             "\"extensionsUsed\":[\"KHR_materials_sheen\",\"VENDOR_thing\"],\"materials\":[%s,{\"extensions\":"
             "{\"KHR_materials_clearcoat\":{\"clearcoatRoughnessFactor\":1}}},%s]",
             sheen, sheen);
    scene *s = load(&b, rest);
    assert_string_equal(gltf_warnings,
                        "extensionsUsed[1]: VENDOR_thing is not supported: ignored\n"
                        "materials[2] and 1 more: KHR_materials_sheen is not supported: rendered without sheen\n");
    scene_destroy(s);
}

/* ---- Textures ------------------------------------------------------------------------------------- */

#define DOT                                                                                                            \
    ",\"images\":[{\"uri\":\"missing.png\"},{\"uri\":\"dot.png\"}],\"textures\":[{\"source\":1,\"sampler\":0}],"       \
    "\"samplers\":[{\"magFilter\":9728,\"wrapS\":33071,\"wrapT\":33648}]"

static void textures_are_shared_per_use_and_unused_images_not_read(void **state)
{
    (void)state;
    write_dot();
    scene *s = load_material(
        "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},\"metallicRoughnessTexture\":"
        "{\"index\":0,\"texCoord\":1}},\"emissiveTexture\":{\"index\":0},\"normalTexture\":"
        "{\"index\":0,\"scale\":0.5}",
        DOT);
    const material *const m = &s->materials[0];
    assert_int_equal(s->n_images, 1);
    assert_int_equal(s->n_textures, 2);
    assert_int_equal(m->base_color_texture.texture, m->emissive_texture.texture);
    assert_int_equal(m->metallic_roughness_texture.texture, m->normal_texture.texture);
    assert_int_equal(m->metallic_roughness_texture.uv_set, 1);
    EXPECT_FLOATS(&m->normal_scale, 1, 0.5f);
    const texture *const colour = &s->textures[m->base_color_texture.texture];
    assert_true(colour->is_srgb && !s->textures[m->normal_texture.texture].is_srgb);
    assert_true(colour->is_nearest && colour->wrap_u == WRAP_CLAMP && colour->wrap_v == WRAP_MIRROR);
    scene_destroy(s);
}

/* The numbers of the Khronos TextureTransformTest: its arrow's tip at (0.778, 0.778) must appear where its
 * green marker lies. */
static void texture_transforms_scale_then_turn_then_move(void **state)
{
    (void)state;
    write_dot();
    scene *s = load_material(
        "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,\"texCoord\":0,\"extensions\":"
        "{\"KHR_texture_transform\":{\"offset\":[0.25,0.5],\"scale\":[2,4],\"texCoord\":1,"
        "\"rotation\":0.39269908169872414}}}}",
        DOT);
    const texture_use *const use = &s->materials[0].base_color_texture;
    const float c = (float)cos(0.39269908169872414), n = (float)sin(0.39269908169872414);
    EXPECT_FLOATS(use->transform, 6, c*2, n*4, 0.25f, -n*2, c*4, 0.5f);
    assert_int_equal(use->uv_set, 1);
    scene_destroy(s);
    const float u = 0.5f - 0.07904822f, v = 0.5f + 0.51626749f;
    assert_true(fabsf(u*c + v*n - 0.7778175f) < 1e-6f && fabsf(v*c - u*n - 0.7778175f) < 1e-6f);
}

static void images_that_cannot_be_had_are_named(void **state)
{
    (void)state;
    static const char use[] = "\"emissiveTexture\":{\"index\":0}";
    facet_error why = refuse_material(use, ",\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"gone.png\"}]");
    expect_error(&why, "images[0].uri", "\"gone.png\"");
    why = refuse_material(use, ",\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"data:image/png;base64,AAAA\"}]");
    expect_error(&why, "images[0]", "");
    why = refuse_material(use, ",\"textures\":[{\"source\":0}],\"images\":[{}]");
    expect_error(&why, "images[0]", "either a uri or a bufferView");
    why = refuse_material("\"emissiveTexture\":{\"index\":1}", ",\"textures\":[{}]");
    expect_error(&why, "materials[0].emissiveTexture.index", "the number of textures is 1");
}

static void other_codecs_need_a_fallback(void **state)
{
    (void)state;
    static const char use[] = "\"emissiveTexture\":{\"index\":0}";
    write_dot();
    scene *s = load_material(use,
                             ",\"images\":[{\"uri\":\"dot.png\"},{\"uri\":\"dot.webp\"}],\"textures\":[{\"source\":0,"
                             "\"extensions\":{\"EXT_texture_webp\":{\"source\":1}}}]");
    assert_int_equal(s->n_images, 1);
    assert_string_equal(gltf_warnings, "textures[0]: EXT_texture_webp is not supported: images[0] is used instead\n");
    scene_destroy(s);
    const facet_error why = refuse_material(use, ",\"images\":[{\"uri\":\"dot.ktx2\"}],\"textures\":[{\"extensions\":"
                                                 "{\"KHR_texture_basisu\":{\"source\":0}}}]");
    assert_int_equal(why.status, FACET_UNSUPPORTED);
    expect_error(&why, "textures[0]", "KHR_texture_basisu is not supported");
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)
    const struct CMUnitTest tests[] = {
        TEST(defaults_are_those_of_the_specification),
        TEST(factors_are_read),
        TEST(factors_out_of_range_name_material_and_range),
        TEST(an_ior_of_zero_reflects_everything),
        TEST(transmission_is_thin_without_thickness),
        TEST(unlit_and_bsdf_materials_are_told_apart),
        TEST(bsdf_materials_are_checked_by_the_parameter_table),
        TEST(what_is_not_rendered_is_reported_once_with_its_count),
        TEST(textures_are_shared_per_use_and_unused_images_not_read),
        TEST(texture_transforms_scale_then_turn_then_move),
        TEST(images_that_cannot_be_had_are_named),
        TEST(other_codecs_need_a_fallback),
    };
    return cmocka_run_group_tests_name("glTF materials", tests, NULL, NULL);
}
