/* gltf.c: reading a glTF file, from its first byte to a scene.
 *
 * The order: container, JSON, version and required extensions, everything that the file declares, then
 * the scene from its nodes down, which loads buffers, images, materials and meshes as it meets them.
 * SPDX-License-Identifier: MIT */
#include "io/gltf.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/error.h"
#include "io/file.h"
#include "io/gltf_internal.h"
#include "io/image_file.h"

void gltf_warn(gltf *g, const json_place *place, const char *format, ...)
{
    if (!g->warning || g->n_warnings > GLTF_WARNING_CAP) return;
    if (g->n_warnings++ == GLTF_WARNING_CAP) {
        g->warning(g->user, "more warnings of this file are left out");
        return;
    }
    char text[512];
    json_path(place, text, 160);
    size_t length = strlen(text);
    if (length) length += (size_t)snprintf(text + length, sizeof text - length, ": ");
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + length, sizeof text - length, format, arguments);
    va_end(arguments);
    g->warning(g->user, text);
}

bool gltf_read_extension(const json_place *object, const char *name, gltf_extension *e)
{
    *e = (gltf_extension){0};
    const bool is_read = json_read_object(object, "extensions", &e->list);
    e->body = json_member(&e->list, name);
    return is_read && json_want_object(&e->body);
}

bool gltf_no_memory(const json_place *place)
{
    return json_fail(place, FACET_NO_MEMORY, "out of memory");
}

size_t gltf_memory_left(const gltf *g)
{
    return g->most_memory - g->memory;
}

bool gltf_claim(gltf *g, const json_place *place, size_t count, size_t size)
{
    if (size && count > gltf_memory_left(g)/size)
        return json_fail(place, FACET_UNSUPPORTED,
                         "brings the scene above %zu MiB of memory; --max-memory SIZE sets another limit",
                         g->most_memory >> 20);
    g->memory += count*size;
    return true;
}

bool gltf_take_input(gltf *g, const json_place *place, const unsigned char *bytes, size_t size)
{
    if (!gltf_claim(g, place, size, 1)) return false;
    g->input_size += size;
    scene_hash_bytes(g->scene, bytes, size);
    return true;
}

bool gltf_charge(gltf *g, const json_place *place, size_t count, size_t size)
{
    const size_t cap = GLTF_GEOMETRY_FLOOR + GLTF_GEOMETRY_FACTOR*g->input_size;
    if (!g->has_own_cap && size && count > (cap - g->geometry_size)/size)
        return json_fail(place, FACET_UNSUPPORTED,
                         "brings the geometry above %zu MiB (%zu MiB plus %zu times the %zu bytes read); "
                         "--max-memory SIZE sets another limit",
                         cap >> 20, GLTF_GEOMETRY_FLOOR >> 20, GLTF_GEOMETRY_FACTOR, g->input_size);
    if (!gltf_claim(g, place, count, size)) return false;
    g->geometry_size += count*size;
    return true;
}

void *gltf_alloc(gltf *g, const json_place *place, size_t count, size_t size)
{
    if (!gltf_charge(g, place, count, size)) return NULL;
    void *memory = calloc(count ? count : 1, size);
    if (!memory) gltf_no_memory(place);
    return memory;
}

/* ---- The file's own claims ----------------------------------------------------------------------- */

/* Splits "major.minor" into two numbers below 10000. */
static bool parse_version(const char *text, int *major, int *minor)
{
    int length = 0;
    return sscanf(text, "%4d.%4d%n", major, minor, &length) == 2 && text[length] == 0 && *major >= 0 && *minor >= 0;
}

/* asset.version, section 3.2: any 2.x is read, unless minVersion asks for more than 2.0. */
static bool check_version(gltf *g)
{
    json_place asset;
    const char *version = NULL, *least = NULL;
    int major, minor;
    if (!json_read_object(&g->root, "asset", &asset) || !json_want_present(&asset)) return false;
    if (!json_read_string(&asset, "version", &version)) return false;
    if (!json_read_string(&asset, "minVersion", &least)) return false;
    const json_place version_place = json_member(&asset, "version"), least_place = json_member(&asset, "minVersion");
    if (!json_want_present(&version_place)) return false;
    if (!parse_version(version, &major, &minor))
        return json_fail(&version_place, FACET_BAD_FILE, "is \"%s\"; must be \"2.0\"", version);
    if (major != 2)
        return json_fail(&version_place, FACET_UNSUPPORTED, "glTF %s is not supported; convert it to glTF 2.0",
                         version);
    if (!least) return true;
    int least_major, least_minor;
    if (!parse_version(least, &least_major, &least_minor))
        return json_fail(&least_place, FACET_BAD_FILE, "is \"%s\"; must be \"2.0\"", least);
    if (least_major > major || (least_major == major && least_minor > minor))
        return json_fail(&least_place, FACET_BAD_FILE, "is %s, above the file's own version %s", least, version);
    if (least_major != 2 || least_minor > 0)
        return json_fail(&least_place, FACET_UNSUPPORTED, "asks for glTF %s; only 2.0 is supported", least);
    return true;
}

/* How far an extension is supported. */
typedef enum support {
    SUPPORT_FULL,     /* may be required */
    SUPPORT_MATERIAL, /* reported with the materials that use it */
    SUPPORT_FALLBACK, /* reported where the fallback is taken */
    SUPPORT_NONE
} support;

static support extension_support(const char *name)
{
    static const char *const full[] = {
        "KHR_mesh_quantization",
        "KHR_texture_transform",
        "KHR_lights_punctual",
        "KHR_materials_unlit",
        "KHR_materials_ior",
        "KHR_materials_specular",
        "KHR_materials_transmission",
        "KHR_materials_volume",
        "KHR_materials_emissive_strength",
        "KHR_materials_variants",
        "KHR_xmp",
        "KHR_xmp_json_ld",
        "EXT_mesh_gpu_instancing",
        "FACET_materials_bsdf",
        "FACET_shape",
    };
    static const char *const fallback[] = {
        "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression", "KHR_texture_basisu",
        "EXT_texture_webp",           "EXT_texture_avif",        "MSFT_texture_dds",
    };
    for (size_t i = 0; i < sizeof full/sizeof *full; i++)
        if (strcmp(name, full[i]) == 0) return SUPPORT_FULL;
    for (size_t i = 0; i < sizeof fallback/sizeof *fallback; i++)
        if (strcmp(name, fallback[i]) == 0) return SUPPORT_FALLBACK;
    return strncmp(name, "KHR_materials_", 14) == 0 ? SUPPORT_MATERIAL : SUPPORT_NONE;
}

static bool check_extensions(gltf *g)
{
    json_place required, used;
    const char *name;
    if (!json_read_array(&g->root, "extensionsRequired", &required)) return false;
    if (!json_read_array(&g->root, "extensionsUsed", &used)) return false;
    for (size_t i = 0; i < json_count(&required); i++) {
        const json_place place = json_element(&required, i);
        if (!json_string_here(&place, &name)) return false;
        if (extension_support(name) != SUPPORT_FULL)
            return json_fail(&place, FACET_UNSUPPORTED, "the file requires %s, which is not supported", name);
    }
    for (size_t i = 0; i < json_count(&used); i++) {
        const json_place place = json_element(&used, i);
        if (!json_string_here(&place, &name)) return false;
        if (extension_support(name) == SUPPORT_NONE) gltf_warn(g, &place, "%s is not supported: ignored", name);
    }
    return true;
}

/* ---- From bytes to a scene ------------------------------------------------------------------------ */

static bool open_file(gltf *g)
{
    unsigned char *bytes = NULL;
    size_t size = 0;
    facet_error problem = {0};
    const facet_status status = file_read_within(g->path, g->most_memory, &bytes, &size, &problem);
    if (status) {
        facet_error_set(&g->error, status, problem.place, "%s%s", problem.text,
                        status == FACET_UNSUPPORTED ? "; --max-memory SIZE sets another limit" : "");
        return false;
    }
    g->file = bytes;
    g->root = (json_place){.why = &g->error};
    if (!gltf_take_input(g, &g->root, bytes, size)) return false;
    const unsigned char *json = bytes;
    size_t json_size = size;
    if (gltf_is_glb(bytes, size) && !gltf_open_glb(g, bytes, size, &json, &json_size)) return false;
    if (json_size > GLTF_JSON_CAP)
        return json_fail(&g->root, FACET_UNSUPPORTED, "has %zu MiB of JSON; at most %zu MiB are read", json_size >> 20,
                         GLTF_JSON_CAP >> 20);
    if (image_is_known(bytes, size))
        return json_fail(&g->root, FACET_BAD_FILE, "is a picture, not a scene; give a .gltf or .glb");
    if (!gltf_claim(g, &g->root, json_memory(json, json_size), 1)) return false;
    if (!json_parse(json, json_size, &g->root, &g->error)) return false;
    return json_want_object(&g->root);
}

static bool find_arrays(gltf *g)
{
    const struct {
        const char *key;
        json_place *place;
    } arrays[] = {
        {"buffers", &g->buffers},   {"bufferViews", &g->views}, {"accessors", &g->accessors}, {"images", &g->images},
        {"samplers", &g->samplers}, {"textures", &g->textures}, {"materials", &g->materials}, {"meshes", &g->meshes},
        {"nodes", &g->nodes},       {"skins", &g->skins},       {"cameras", &g->cameras},     {"scenes", &g->scenes},
    };
    for (size_t i = 0; i < sizeof arrays/sizeof *arrays; i++) {
        if (!json_read_array(&g->root, arrays[i].key, arrays[i].place)) return false;
        for (size_t k = 0; k < json_count(arrays[i].place); k++) {
            const json_place element = json_element(arrays[i].place, k);
            if (!json_want_object(&element)) return false;
        }
    }
    return json_read_object(&g->root, "extensions", &g->root_extensions) &&
           json_read_object(&g->root_extensions, "KHR_lights_punctual", &g->lights_extension) &&
           json_read_array(&g->lights_extension, "lights", &g->lights);
}

/* The tables that say what has been loaded already. */
static bool make_tables(gltf *g)
{
    const size_t n_images = json_count(&g->images), n_textures = json_count(&g->textures),
                 n_materials = json_count(&g->materials);
    g->n_meshes = json_count(&g->meshes);
    g->image_index = malloc((n_images + 1)*sizeof *g->image_index);
    g->texture_index = malloc((n_textures + 1)*sizeof *g->texture_index);
    g->material_index = malloc((n_materials + 1)*sizeof *g->material_index);
    g->mesh = calloc(g->n_meshes + 1, sizeof *g->mesh);
    if (!g->image_index || !g->texture_index || !g->material_index || !g->mesh) return gltf_no_memory(&g->root);
    for (size_t i = 0; i < n_images; i++) g->image_index[i] = NONE;
    for (size_t i = 0; i < n_textures; i++) g->texture_index[i][0] = g->texture_index[i][1] = NONE;
    for (size_t i = 0; i < n_materials; i++) g->material_index[i] = NONE;
    g->default_material_index = NONE;
    return true;
}

static void close_file(gltf *g)
{
    for (size_t i = 0; g->buffer && i < g->n_buffers; i++) free(g->buffer[i].owned);
    for (size_t i = 0; g->mesh && i < g->n_meshes; i++) gltf_mesh_destroy(&g->mesh[i]);
    gltf_mesh_destroy(&g->deformed);
    free(g->buffer);
    free(g->view);
    free(g->accessor);
    free(g->node);
    free(g->mesh);
    free(g->image_index);
    free(g->texture_index);
    free(g->material_index);
    if (g->root.value) json_destroy(&g->root);
    free(g->file);
}

facet_status gltf_read(const char *path, gltf_warning *warning, void *user, scene **result, facet_error *why)
{
    return gltf_read_with(path, &(gltf_options){.warning = warning, .user = user}, result, why);
}

facet_status gltf_read_with(const char *path, const gltf_options *options, scene **result, facet_error *why)
{
    const char *slash = strrchr(path, '/');
    gltf g = {.path = path,
              .folder_length = slash ? (size_t)(slash - path) + 1 : 0,
              .warning = options->warning,
              .on_file = options->on_file,
              .user = options->user,
              .allows_outside = options->allows_outside,
              .has_own_cap = options->most_memory != 0,
              .most_memory = options->most_memory ? options->most_memory : FILE_MEMORY_DEFAULT,
              .scene = scene_create()};
    if (!g.scene) return facet_error_set(why, FACET_NO_MEMORY, "", "out of memory");
    const bool is_read = open_file(&g) && check_version(&g) && check_extensions(&g) && find_arrays(&g) &&
                         gltf_declare_buffers(&g) && gltf_declare_accessors(&g) && gltf_declare_nodes(&g) &&
                         make_tables(&g) && gltf_build_scene(&g);
    if (is_read) gltf_report_notes(&g);
    close_file(&g);
    if (!is_read) {
        scene_destroy(g.scene);
        return facet_error_set(why, g.error.status, g.error.place, "%s", g.error.text);
    }
    *result = g.scene;
    return FACET_OK;
}
