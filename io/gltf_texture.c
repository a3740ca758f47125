/* gltf_texture.c: images, samplers, textures and their use by materials.
 * [gltf, sections 3.8, 5.18, 5.26, 5.29, 5.30]; KHR_texture_transform.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "io/gltf_internal.h"
#include "io/image_file.h"

/* The encoded bytes of an image, from its uri or its buffer view; *owned is to be freed. */
static bool image_bytes(gltf *g, const json_place *place, const unsigned char **bytes, size_t *size,
                        unsigned char **owned)
{
    const json_place uri = json_member(place, "uri"), view_place = json_member(place, "bufferView");
    size_t view = NONE;
    *owned = NULL;
    if (!json_read_index(place, "bufferView", g->n_views, "bufferViews", &view)) return false;
    if ((uri.value != NULL) == (view_place.value != NULL))
        return json_fail(place, FACET_BAD_FILE, "must have either a uri or a bufferView");
    if (uri.value) {
        if (!gltf_read_uri(g, &uri, owned, size)) return false;
        *bytes = *owned;
        return true;
    }
    *size = g->view[view].size;
    return gltf_view_bytes(g, view, bytes);
}

static bool use_image(gltf *g, size_t number, size_t *index)
{
    *index = g->image_index[number];
    if (*index != NONE) return true;
    const json_place place = json_element(&g->images, number);
    const unsigned char *bytes;
    unsigned char *owned;
    size_t size;
    if (!image_bytes(g, &place, &bytes, &size, &owned)) return false;
    image picture = {0};
    facet_error problem = {0};
    const facet_status status = image_decode_within(bytes, size, gltf_memory_left(g), &picture, &problem);
    free(owned);
    if (status) return json_fail(&place, status, "%s%s%s", problem.place, problem.place[0] ? ": " : "", problem.text);
    if (!gltf_claim(g, &place, image_byte_count(&picture), 1) || scene_add_image(g->scene, &picture, index)) {
        image_destroy(&picture);
        return gltf_no_memory(&place);
    }
    g->image_index[number] = *index;
    return true;
}

static bool read_wrap(const json_place *sampler, const char *key, texture_wrap *wrap)
{
    size_t number = 10497;
    const json_place place = json_member(sampler, key);
    if (!json_read_size(sampler, key, SIZE_MAX, &number)) return false;
    switch (number) {
    case 10497: *wrap = WRAP_REPEAT; return true;
    case 33648: *wrap = WRAP_MIRROR; return true;
    case 33071: *wrap = WRAP_CLAMP; return true;
    default: return json_fail(&place, FACET_BAD_VALUE, "is %zu; must be 10497, 33648 or 33071", number);
    }
}

/* The filter for magnification decides; minification is left to the renderer's many samples. */
static bool read_sampler(gltf *g, const json_place *texture_place, texture *t)
{
    size_t number = NONE, filter = 9729;
    if (!json_read_index(texture_place, "sampler", json_count(&g->samplers), "samplers", &number)) return false;
    if (number == NONE) return true;
    const json_place sampler = json_element(&g->samplers, number), filter_place = json_member(&sampler, "magFilter");
    if (!json_read_size(&sampler, "magFilter", SIZE_MAX, &filter)) return false;
    if (filter != 9728 && filter != 9729)
        return json_fail(&filter_place, FACET_BAD_VALUE, "is %zu; must be 9728 or 9729", filter);
    t->is_nearest = filter == 9728;
    return read_wrap(&sampler, "wrapS", &t->wrap_u) && read_wrap(&sampler, "wrapT", &t->wrap_v);
}

/* The image of a texture, or NONE if it has none; an image in a format that is not read is passed over
 * for the PNG or JPEG beside it. */
static bool read_source(gltf *g, const json_place *place, size_t *source)
{
    static const char *const formats[] = {"KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif",
                                          "MSFT_texture_dds"};
    *source = NONE;
    if (!json_read_index(place, "source", json_count(&g->images), "images", source)) return false;
    for (size_t i = 0; i < sizeof formats/sizeof *formats; i++) {
        gltf_extension e;
        if (!gltf_read_extension(place, formats[i], &e)) return false;
        if (!e.body.value) continue;
        if (*source == NONE)
            return json_fail(place, FACET_UNSUPPORTED, "%s is not supported, and there is no PNG or JPEG beside it",
                             formats[i]);
        gltf_warn(g, place, "%s is not supported: images[%zu] is used instead", formats[i], *source);
    }
    return true;
}

static bool use_texture(gltf *g, size_t number, bool is_srgb, size_t *index)
{
    *index = g->texture_index[number][is_srgb];
    if (*index != NONE) return true;
    const json_place place = json_element(&g->textures, number);
    texture t = {0};
    size_t source;
    if (!read_source(g, &place, &source)) return false;
    if (source == NONE) {
        gltf_warn(g, &place, "has no image: rendered without it");
        return true;
    }
    if (!read_sampler(g, &place, &t) || !use_image(g, source, &t.image)) return false;
    /* The sRGB curve is for integer pixels; floats are linear already. */
    t.is_srgb = is_srgb && g->scene->images[t.image].type != PIXEL_F32;
    if (scene_add_texture(g->scene, &t, index)) return gltf_no_memory(&place);
    g->texture_index[number][is_srgb] = *index;
    return true;
}

/* KHR_texture_transform: uv' = T R S uv, with R turning uv by `rotation` counter-clockwise as seen on the
 * image, whose v runs down: u' = u cos + v sin, v' = -u sin + v cos. */
static bool read_transform(const json_place *info, size_t *uv_set, float transform[2][3])
{
    gltf_extension e;
    float offset[2] = {0, 0}, scale[2] = {1, 1};
    double rotation = 0;
    if (!gltf_read_extension(info, "KHR_texture_transform", &e)) return false;
    if (!json_read_floats(&e.body, "offset", 2, -GLTF_UV_CAP, GLTF_UV_CAP, offset) ||
        !json_read_floats(&e.body, "scale", 2, -GLTF_UV_CAP, GLTF_UV_CAP, scale) ||
        !json_read_number(&e.body, "rotation", -INFINITY, INFINITY, &rotation) ||
        !json_read_size(&e.body, "texCoord", SIZE_MAX, uv_set))
        return false;
    const float c = (float)cos(rotation), s = (float)sin(rotation);
    const float rows[2][3] = {{c*scale[0], s*scale[1], offset[0]}, {-s*scale[0], c*scale[1], offset[1]}};
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 3; j++) transform[i][j] = rows[i][j];
    return true;
}

bool gltf_read_texture(gltf *g, const json_place *object, const char *key, bool is_srgb, size_t material_number,
                       texture_use *use)
{
    json_place info;
    size_t number = NONE, uv_set = 0, index;
    float transform[2][3];
    if (!json_read_object(object, key, &info)) return false;
    if (!info.value) return true;
    const json_place index_place = json_member(&info, "index");
    if (!json_want_present(&index_place) ||
        !json_read_index(&info, "index", json_count(&g->textures), "textures", &number) ||
        !json_read_size(&info, "texCoord", SIZE_MAX, &uv_set) || !read_transform(&info, &uv_set, transform))
        return false;
    if (uv_set > 1) {
        gltf_note_material(g, material_number, "texture coordinates beyond TEXCOORD_1 are",
                           "rendered without the textures that use them");
        return true;
    }
    if (!use_texture(g, number, is_srgb, &index)) return false;
    use->texture = index;
    use->uv_set = (unsigned)uv_set;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 3; j++) use->transform[i][j] = transform[i][j];
    return true;
}
