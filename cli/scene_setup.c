/* scene_setup.c: the scene that `facet render` renders: loaded, then changed as the options ask.
 * SPDX-License-Identifier: MIT */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/events.h"
#include "cli/render_job.h"
#include "cli/report.h"
#include "cli/suggest.h"
#include "io/file.h"
#include "io/gltf.h"
#include "io/image_file.h"
#include "render/demo_scene.h"
#include "render/view.h"

/* ---- Warnings ---------------------------------------------------------------------------------- */

enum { MAX_WARNINGS = 50 };

void keep_warning(warning_list *list, const char *format, ...)
{
    char text[768];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (!list->items) list->items = calloc(MAX_WARNINGS, sizeof *list->items);
    if (!list->items || list->n == MAX_WARNINGS) {
        list->n_dropped++;
        return;
    }
    warn("%s", text);
    if (list->events) events_warning(list->events, text);
    list->items[list->n] = strdup(text);
    if (list->items[list->n]) list->n++;
}

void warning_list_destroy(warning_list *list)
{
    for (size_t i = 0; i < list->n; i++) free(list->items[i]);
    free(list->items);
    *list = (warning_list){0};
}

void keep_gltf_warning(void *user, const char *text)
{
    const warning_source *source = user;
    keep_warning(source->list, "%s: %s", source->path, text);
}

/* ---- Names ------------------------------------------------------------------------------------- */

/* An error for a name that the scene does not have, with the nearest one and the list of all. */
static int fail_name(const char *place, const char *what, const char *name, size_t n,
                     const char *(*name_at)(const scene *, size_t), const scene *s)
{
    char list[512] = "", suggested[128] = "";
    size_t length = 0;
    suggestion near = suggestion_start(name);
    for (size_t i = 0; i < n; i++) {
        const char *other = name_at(s, i);
        suggestion_offer(&near, other);
        if (length + strlen(other) + 8 < sizeof list)
            length += (size_t)snprintf(list + length, sizeof list - length, "%s`%s`", i ? ", " : "", other);
        else if (length < sizeof list - 5 && list[length - 1] != '.')
            length += (size_t)snprintf(list + length, sizeof list - length, " ...");
    }
    if (n == 0) return fail(EXIT_USAGE, NULL, place, "the scene has no %s `%s`; it has none at all", what, name);
    if (suggestion_get(&near)) snprintf(suggested, sizeof suggested, "did you mean `%.60s`? ", suggestion_get(&near));
    return fail(EXIT_USAGE, NULL, place, "the scene has no %s `%s`; %sit has %s", what, name, suggested, list);
}

static const char *camera_name(const scene *s, size_t i)
{
    return s->cameras[i].name;
}

static const char *material_name(const scene *s, size_t i)
{
    return s->materials[i].name;
}

/* ---- Steps ------------------------------------------------------------------------------------- */

/* Files of the scene that an output would replace, such as box.png, the default picture of box.gltf. */
static void check_file(void *user, const char *path)
{
    warning_source *source = user;
    const render_options *o = source->options;
    for (size_t i = 0; i < o->outputs.n && !source->lost; i++)
        if (file_is_same(o->outputs.items[i], path)) source->lost = o->outputs.items[i];
}

static int load(const render_options *o, warning_list *warnings, scene **result)
{
    facet_error why = {0};
    if (!o->scene_path) return demo_scene_create(result, &why) ? fail_with(FROM_INPUT, "demo", &why) : 0;
    warning_source source = {.list = warnings, .path = o->scene_path, .options = o};
    const gltf_options options = {keep_gltf_warning, &source, o->allow_outside, o->max_memory, check_file};
    if (gltf_read_with(o->scene_path, &options, result, &why)) return fail_with(FROM_INPUT, o->scene_path, &why);
    if (!source.lost) return 0;
    return fail(EXIT_USAGE, source.lost, NULL, "is a file of the scene, and would be lost; name another output by -o");
}

/* --env FILE or R,G,B, and --env-scale.  What options change enters the scene's hash, too. */
static int set_environment(const render_options *o, scene *s)
{
    environment *e = &s->environment;
    double constant[3];
    if (o->env && parse_numbers(o->env, constant, 3)) {
        image_destroy(&e->map);
        for (int k = 0; k < 3; k++) {
            if (!(constant[k] >= 0 && constant[k] <= 1e30))
                return fail(EXIT_USAGE, NULL, "--env", "`%s` is not a radiance; its numbers are from 0 to 1e30",
                            o->env);
            e->scale[k] = (float)constant[k];
        }
    } else if (o->env) {
        const size_t most = o->max_memory ? o->max_memory : FILE_MEMORY_DEFAULT;
        facet_error why = {0};
        image raw = {0}, linear = {0};
        const facet_status read = image_read_within(o->env, most, &raw, &why);
        if (read == FACET_IO && strchr(o->env, ','))
            return fail(EXIT_USAGE, NULL, "--env", "`%s` is neither a file nor a radiance R,G,B of three numbers",
                        o->env);
        if (read) return fail_with(FROM_INPUT, o->env, &why);
        facet_status status = raw.type == PIXEL_F32 ? image_to_linear(&raw, &linear, &why) : FACET_OK;
        const bool is_radiance = raw.type == PIXEL_F32;
        image_destroy(&raw);
        if (!is_radiance)
            return fail(EXIT_INPUT, o->env, NULL, "is not a picture of radiance; use an .hdr or .exr file");
        if (status) return fail_with(FROM_INPUT, o->env, &why);
        image_destroy(&e->map);
        e->map = linear;
        for (int k = 0; k < 3; k++) e->scale[k] = 1;
        scene_hash_bytes(s, &e->map.width, sizeof e->map.width);
        scene_hash_bytes(s, e->map.pixels, e->map.width*e->map.height*e->map.n_channels*sizeof(float));
    }
    for (int k = 0; k < 3 && o->env_scale.is_given; k++) e->scale[k] *= (float)o->env_scale.value;
    return 0;
}

/* --material NAME='SPEC': the reflection of every material of that name; emission and textures of
 * normals stay. */
static int set_material(const char *assignment, scene *s)
{
    const char *equals = strchr(assignment, '=');
    if (!equals || equals == assignment)
        return fail(EXIT_USAGE, NULL, "--material", "`%s` is not NAME='SPEC', such as --material body='ggx alpha=.2'",
                    assignment);
    char place[128], *name = strndup(assignment, (size_t)(equals - assignment));
    if (!name) return fail_memory();
    facet_bsdf bsdf;
    int status = 0;
    if (scene_find_material(s, name) == NONE)
        status = fail_name("--material", "material", name, s->n_materials, material_name, s);
    snprintf(place, sizeof place, "--material %s", name);
    if (!status) status = prepare_bsdf(equals + 1, place, &bsdf);
    for (size_t i = 0; !status && i < s->n_materials; i++) {
        if (strcmp(s->materials[i].name, name) != 0) continue;
        s->materials[i].kind = SURFACE_BSDF;
        s->materials[i].bsdf = bsdf;
    }
    if (!status) scene_hash_bytes(s, assignment, strlen(assignment));
    free(name);
    return status;
}

static bool has_light(const scene *s)
{
    if (s->n_lights) return true;
    for (int k = 0; k < 3; k++)
        if (s->environment.scale[k] > 0) return true;
    for (size_t i = 0; i < s->n_materials; i++)
        for (int k = 0; k < 3; k++)
            if (s->materials[i].emission[k] > 0) return true;
    return false;
}

static int choose_camera(const render_options *o, scene *s, size_t *i_camera)
{
    *i_camera = 0;
    if (o->camera) {
        *i_camera = scene_find_camera(s, o->camera);
        return *i_camera == NONE ? fail_name("--camera", "camera", o->camera, s->n_cameras, camera_name, s) : 0;
    }
    if (s->n_cameras) return 0;
    if (!o->quiet) note("the scene has no camera; rendering from one that takes in the whole scene");
    return scene_add_framing_camera(s, i_camera) ? fail_memory() : 0;
}

int prepare_scene(const render_options *o, warning_list *warnings, scene **result, size_t *i_camera)
{
    int status;
    *result = NULL;
    if ((status = load(o, warnings, result))) return status;
    scene *s = *result;
    if (warnings->n_dropped) warn("%s: %zu more warnings are not shown", o->scene_path, warnings->n_dropped);
    for (size_t i = 0; i < o->materials.n; i++)
        if ((status = set_material(o->materials.items[i], s))) return status;
    if ((status = set_environment(o, s))) return status;
    if (!o->env && !has_light(s)) {
        if (!o->quiet) note("the scene has no light; lit by a uniform white environment of radiance 1 (see --env)");
        for (int k = 0; k < 3; k++) s->environment.scale[k] = o->env_scale.is_given ? (float)o->env_scale.value : 1;
    }
    if (o->env || o->env_scale.is_given) scene_hash_bytes(s, s->environment.scale, sizeof s->environment.scale);
    return choose_camera(o, s, i_camera);
}
