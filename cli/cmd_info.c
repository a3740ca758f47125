/* cmd_info.c: `facet info`, what is in a scene, a picture or a checkpoint.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/json_writer.h"
#include "cli/render_job.h"
#include "cli/report.h"
#include "io/checkpoint.h"
#include "io/file.h"
#include "io/gltf.h"
#include "io/image_file.h"

typedef struct settings {
    bool json, allow_outside;
    uint64_t max_memory; /* 0: the default */
} settings;

/* ---- Pictures ---------------------------------------------------------------------------------- */

typedef struct channel_summary {
    double mean, low, high; /* over the finite values */
    size_t n_nan, n_infinite;
} channel_summary;

/* Value i as the file has it: integers scaled to [0,1], not decoded. */
static double file_value(const image *picture, size_t i)
{
    switch (picture->type) {
    case PIXEL_U8: return ((const uint8_t *)picture->pixels)[i]/255.0;
    case PIXEL_U16: return ((const uint16_t *)picture->pixels)[i]/65535.0;
    case PIXEL_F32: break;
    }
    return ((const float *)picture->pixels)[i];
}

static channel_summary summarise(const image *picture, size_t channel)
{
    channel_summary c = {0, INFINITY, -INFINITY, 0, 0};
    size_t n_finite = 0;
    for (size_t i = 0; i < picture->width*picture->height; i++) {
        const double value = file_value(picture, i*picture->n_channels + channel);
        if (isnan(value)) c.n_nan++;
        else if (isinf(value)) c.n_infinite++;
        else {
            c.mean += value;
            c.low = fmin(c.low, value);
            c.high = fmax(c.high, value);
            n_finite++;
        }
    }
    c.mean /= (double)n_finite;
    return c;
}

/* As the file has the pixels: OpenEXR's are always read as floats. */
static const char *type_name(const image *picture, const image_notes *notes)
{
    for (size_t i = 0; i < notes->n; i++)
        if (notes->items[i].is_channel &&
            (strcmp(notes->items[i].key, "R") == 0 || strcmp(notes->items[i].key, "Y") == 0))
            return notes->items[i].value;
    return picture->type == PIXEL_U8 ? "8 bit" : picture->type == PIXEL_U16 ? "16 bit" : "float";
}

static void print_picture(const char *path, const image *picture, const image_notes *notes)
{
    static const char *const names[] = {"Y", "YA", "RGB", "RGBA"};
    printf("%s: picture, %zu x %zu pixels, %zu channel%s, %s\n", path, picture->width, picture->height,
           picture->n_channels, picture->n_channels == 1 ? "" : "s", type_name(picture, notes));
    printf("channel  mean          min           max           NaN       infinite\n");
    for (size_t k = 0; k < picture->n_channels; k++) {
        const channel_summary c = summarise(picture, k);
        printf("%c        %-13.7g %-13.7g %-13.7g %-9zu %zu\n", names[picture->n_channels - 1][k], c.mean, c.low,
               c.high, c.n_nan, c.n_infinite);
    }
}

/* What a file says, without what would move a terminal's cursor. */
static void print_plain(const char *text)
{
    for (; *text; text++) putchar((unsigned char)*text < ' ' || *text == 0x7f ? '?' : *text);
}

static void print_notes(const image_notes *notes)
{
    for (size_t i = 0; i < notes->n; i++) {
        char key[64];
        snprintf(key, sizeof key, "%s%s", notes->items[i].is_channel ? "channel " : "", notes->items[i].key);
        printf("  ");
        print_plain(key);
        printf("%*s ", strlen(key) < 22 ? (int)(22 - strlen(key)) : 0, "");
        print_plain(notes->items[i].value);
        putchar('\n');
    }
}

static void write_notes(json_writer *j, const image_notes *notes, bool of_channels)
{
    json_put_open(j, of_channels ? "types" : "texts", '{');
    for (size_t i = 0; i < notes->n; i++)
        if (notes->items[i].is_channel == of_channels) json_put_text(j, notes->items[i].key, notes->items[i].value);
    json_put_close(j, '}');
}

static void write_picture(json_writer *j, const image *picture, const image_notes *notes)
{
    json_put_text(j, "kind", "picture");
    json_put_integer(j, "width", picture->width);
    json_put_integer(j, "height", picture->height);
    json_put_text(j, "type", type_name(picture, notes));
    json_put_open(j, "channels", '[');
    for (size_t k = 0; k < picture->n_channels; k++) {
        const channel_summary c = summarise(picture, k);
        json_put_open(j, NULL, '{');
        json_put_number(j, "mean", c.mean);
        json_put_number(j, "min", c.low);
        json_put_number(j, "max", c.high);
        json_put_integer(j, "nan", c.n_nan);
        json_put_integer(j, "infinite", c.n_infinite);
        json_put_close(j, '}');
    }
    json_put_close(j, ']');
}

/* ---- Scenes ------------------------------------------------------------------------------------ */

static uint64_t n_placed_triangles(const scene *s)
{
    uint64_t n = 0;
    for (size_t i = 0; i < s->n_instances; i++) n += s->meshes[s->instances[i].mesh].n_triangles;
    return n;
}

static const char *surface_name(const material *m)
{
    return m->kind == SURFACE_BSDF ? "FACET_materials_bsdf" : m->kind == SURFACE_UNLIT ? "unlit" : "metallic-roughness";
}

static const char *light_name(const punctual_light *light)
{
    return light->kind == LIGHT_POINT ? "point" : light->kind == LIGHT_SPOT ? "spot" : "directional";
}

static bool is_emissive(const material *m)
{
    return m->emission[0] > 0 || m->emission[1] > 0 || m->emission[2] > 0;
}

static void print_scene(const char *path, const scene *s)
{
    float low[3], high[3];
    printf("%s: scene\n", path);
    printf("  meshes      %zu, placed %zu times: %llu triangles\n", s->n_meshes, s->n_instances,
           (unsigned long long)n_placed_triangles(s));
    printf("  spheres     %zu\n  textures    %zu from %zu images\n", s->n_spheres, s->n_textures, s->n_images);
    if (scene_bounds(s, low, high))
        printf("  bounds      (%g, %g, %g) to (%g, %g, %g) m\n", (double)low[0], (double)low[1], (double)low[2],
               (double)high[0], (double)high[1], (double)high[2]);
    printf("  cameras     %zu\n", s->n_cameras);
    for (size_t i = 0; i < s->n_cameras; i++)
        printf("    %-24s %s\n", s->cameras[i].name, s->cameras[i].is_orthographic ? "orthographic" : "perspective");
    printf("  materials   %zu\n", s->n_materials);
    for (size_t i = 0; i < s->n_materials; i++)
        printf("    %-24s %s%s\n", s->materials[i].name, surface_name(&s->materials[i]),
               is_emissive(&s->materials[i]) ? ", emissive" : "");
    printf("  lights      %zu\n", s->n_lights);
    for (size_t i = 0; i < s->n_lights; i++) printf("    %s\n", light_name(&s->lights[i]));
    printf("  hash        %016llx\n", (unsigned long long)s->hash);
}

static void write_scene(json_writer *j, const scene *s, const warning_list *warnings)
{
    float low[3], high[3];
    char hash[20];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)s->hash);
    json_put_text(j, "kind", "scene");
    json_put_integer(j, "meshes", s->n_meshes);
    json_put_integer(j, "instances", s->n_instances);
    json_put_integer(j, "triangles", n_placed_triangles(s));
    json_put_integer(j, "spheres", s->n_spheres);
    json_put_integer(j, "textures", s->n_textures);
    json_put_integer(j, "images", s->n_images);
    if (scene_bounds(s, low, high)) {
        json_put_numbers(j, "bounds_low", (const double[3]){low[0], low[1], low[2]}, 3);
        json_put_numbers(j, "bounds_high", (const double[3]){high[0], high[1], high[2]}, 3);
    }
    json_put_open(j, "cameras", '[');
    for (size_t i = 0; i < s->n_cameras; i++) json_put_text(j, NULL, s->cameras[i].name);
    json_put_close(j, ']');
    json_put_open(j, "materials", '[');
    for (size_t i = 0; i < s->n_materials; i++) {
        json_put_open(j, NULL, '{');
        json_put_text(j, "name", s->materials[i].name);
        json_put_text(j, "kind", surface_name(&s->materials[i]));
        json_put_bool(j, "emissive", is_emissive(&s->materials[i]));
        json_put_close(j, '}');
    }
    json_put_close(j, ']');
    json_put_open(j, "lights", '[');
    for (size_t i = 0; i < s->n_lights; i++) json_put_text(j, NULL, light_name(&s->lights[i]));
    json_put_close(j, ']');
    json_put_text(j, "hash", hash);
    json_put_open(j, "warnings", '[');
    for (size_t i = 0; i < warnings->n; i++) json_put_text(j, NULL, warnings->items[i]);
    json_put_close(j, ']');
}

/* ---- The command ------------------------------------------------------------------------------- */

/* True for glTF by name, for .glb also by its first bytes. */
static bool is_scene(const char *path)
{
    return has_extension(path, "gltf") || has_extension(path, "glb") || file_begins_with(path, "glTF");
}

static void start_json(json_writer *j, const char *path)
{
    *j = json_put_start(stdout);
    json_put_open(j, NULL, '{');
    json_put_text(j, "file", path);
}

static int tell_scene(const char *path, const settings *o)
{
    facet_error why = {0};
    scene *s = NULL;
    warning_list warnings = {0};
    warning_source source = {.list = &warnings, .path = path};
    const gltf_options options = {keep_gltf_warning, &source, o->allow_outside, o->max_memory, NULL};
    int status = gltf_read_with(path, &options, &s, &why) ? fail_with(FROM_INPUT, path, &why) : 0;
    if (!status && o->json) {
        json_writer j;
        start_json(&j, path);
        write_scene(&j, s, &warnings);
        json_put_close(&j, '}');
    } else if (!status) {
        print_scene(path, s);
    }
    warning_list_destroy(&warnings);
    scene_destroy(s);
    return finish_stdout(status);
}

static int tell_picture(const char *path, const settings *o)
{
    const size_t most = o->max_memory ? o->max_memory : FILE_MEMORY_DEFAULT;
    facet_error why = {0};
    image picture = {0};
    image_notes notes = {0};
    unsigned char *bytes = NULL;
    size_t size = 0;
    facet_status status = file_read(path, &bytes, &size, &why);
    if (!status) status = image_decode_within(bytes, size, most, &picture, &why);
    if (!status) status = image_decode_notes(bytes, size, &notes, &why);
    free(bytes);
    if (!status && o->json) {
        json_writer j;
        start_json(&j, path);
        write_picture(&j, &picture, &notes);
        write_notes(&j, &notes, true);
        write_notes(&j, &notes, false);
        json_put_close(&j, '}');
    } else if (!status) {
        print_picture(path, &picture, &notes);
        print_notes(&notes);
    }
    image_notes_destroy(&notes);
    image_destroy(&picture);
    return status ? fail_with(FROM_INPUT, path, &why) : finish_stdout(0);
}

static int tell_checkpoint(const char *path, bool json)
{
    facet_error why = {0};
    checkpoint c;
    if (checkpoint_read(path, true, &c, &why)) return fail_with(FROM_INPUT, path, &why);
    const film *f = &c.state.film;
    if (json) {
        json_writer j;
        start_json(&j, path);
        json_put_text(&j, "kind", "checkpoint");
        json_put_integer(&j, "width", f->width);
        json_put_integer(&j, "height", f->height);
        json_put_number(&j, "noise", film_noise(f) >= 0 ? film_noise(f) : NAN);
        json_put_open(&j, "texts", '{');
        for (size_t i = 0; i < c.n_texts; i++) json_put_text(&j, c.texts[i].key, c.texts[i].value);
        json_put_close(&j, '}');
        json_put_close(&j, '}');
    } else {
        printf("%s: checkpoint, %zu x %zu pixels, whole\n", path, f->width, f->height);
        for (size_t i = 0; i < c.n_texts; i++) printf("  %-22s %s\n", c.texts[i].key, c.texts[i].value);
    }
    checkpoint_destroy(&c);
    return finish_stdout(0);
}

static int run(int argc, char **argv)
{
    settings s = {0};
    const char *path;
    const int status = options_parse(&info_command, argc, argv, &s, &path);
    if (status != PARSE_GO) return status;
    if (checkpoint_is_one(path)) return tell_checkpoint(path, s.json);
    return is_scene(path) ? tell_scene(path, &s) : tell_picture(path, &s);
}

static const option options[] = {
    {"json", 0, OPTION_FLAG, offsetof(settings, json), NULL, "print one JSON object", 0, 0, NULL},
    {"allow-outside", 0, OPTION_FLAG, offsetof(settings, allow_outside), NULL,
     "let a scene refer to files outside its own folder", 0, 0, NULL},
    {"max-memory", 0, OPTION_BYTES, offsetof(settings, max_memory), "SIZE",
     "refuse a scene or a picture that takes more memory to read, such as 512M (default 8G)", 0, 0, NULL},
};

const command info_command = {
    .name = "info",
    .summary = "tell what is in a scene, a picture or a checkpoint",
    .operands = "FILE",
    .min_operands = 1,
    .max_operands = 1,
    .description =
        "Scenes (.gltf, .glb): counts, cameras, materials, lights, bounds; what is not supported is warned of.\n"
        "Pictures (EXR, HDR, PNG, JPEG): size, and per channel mean, smallest, largest, NaN and infinite values, as\n"
        "the file has them (integers scaled to [0,1], not decoded from sRGB); the types of all of an EXR file's\n"
        "channels; how facet made it.\n"
        "Checkpoints: how the render was made and how far it is, after all of the file was found whole.\n",
    .examples = "  facet info scene.glb\n  facet info picture.exr --json\n",
    .options = options,
    .n_options = sizeof options/sizeof *options,
    .run = run,
};
