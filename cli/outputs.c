/* outputs.c: the files that `facet render` writes, and what they tell about how they were made.
 * SPDX-License-Identifier: MIT */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/json_writer.h"
#include "cli/layers.h"
#include "cli/provenance.h"
#include "cli/render_job.h"
#include "cli/report.h"
#include "io/checkpoint.h"
#include "io/file.h"
#include "io/image_file.h"
#include "render/view.h"

/* ---- Before rendering -------------------------------------------------------------------------- */

/* The folder must exist. */
static int check_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder = !slash ? strdup(".") : slash == path ? strdup("/") : strndup(path, (size_t)(slash - path));
    if (!folder) return fail_memory();
    struct stat information;
    int status = 0;
    if (stat(folder, &information) != 0)
        status = fail(EXIT_WORLD, path, NULL, "the folder `%s` cannot be used: %s; make it first", folder,
                      strerror(errno));
    else if (!S_ISDIR(information.st_mode)) status = fail(EXIT_WORLD, path, NULL, "`%s` is not a folder", folder);
    free(folder);
    return status;
}

/* A file is begun as it will be at the end, and given up: then its name is one that can be written.  Removes what
 * killed runs have left beside it. */
static int check_writable(const char *path)
{
    struct stat information;
    facet_error why = {0};
    file_writer writer;
    const int status = check_folder(path);
    if (status) return status;
    if (stat(path, &information) == 0 && !S_ISREG(information.st_mode))
        return fail(EXIT_WORLD, path, NULL, "exists and is not a regular file; name another output");
    file_remove_leftovers(path);
    if (file_writer_open(&writer, path, &why)) return fail_with(FROM_OUTPUT, path, &why);
    file_writer_discard(&writer);
    return 0;
}

int check_spares(const char *output, const char *input)
{
    if (!input || !file_is_same(output, input)) return 0;
    return fail(EXIT_USAGE, output, NULL, "is an input, too, and would be lost; name another output");
}

int check_apart(const render_options *o, const char *const *inputs, size_t n_inputs)
{
    const bool has_events = o->events && strcmp(o->events, "-") != 0;
    const char *files[MAX_LIST + 2];
    size_t n = 0;
    for (; n < o->outputs.n; n++) files[n] = o->outputs.items[n];
    if (o->checkpoint) files[n++] = o->checkpoint;
    if (has_events) files[n++] = o->events;
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < i; k++)
            if (file_is_same(files[i], files[k]))
                return fail(EXIT_USAGE, files[i], NULL, "is named twice as an output; name it once");
        for (size_t k = 0; k < n_inputs; k++) {
            const int status = check_spares(files[i], inputs[k]);
            if (status) return status;
        }
        if (files[i] != o->checkpoint && check_spares(files[i], o->resume)) return EXIT_USAGE;
    }
    return 0;
}

int check_outputs(const render_options *o)
{
    for (size_t i = 0; i < o->outputs.n; i++) {
        const char *path = o->outputs.items[i];
        if (!has_extension(path, "exr") && !has_extension(path, "png"))
            return fail(EXIT_USAGE, path, NULL, "is neither an .exr nor a .png file; name one of these");
        const int status = check_writable(path);
        if (status) return status;
    }
    return 0;
}

int check_checkpoint(const char *path)
{
    struct stat information;
    if (has_extension(path, "exr") || has_extension(path, "png"))
        return fail(EXIT_USAGE, "--checkpoint", NULL, "`%s` is named like a picture; name it FILE.ckpt", path);
    const bool is_file = stat(path, &information) == 0 && S_ISREG(information.st_mode);
    if (is_file && information.st_size > 0 && !checkpoint_is_one(path))
        return fail(EXIT_USAGE, "--checkpoint", NULL,
                    "`%s` is there and is not a checkpoint; name another file, or remove it", path);
    return check_writable(path);
}

/* ---- After rendering --------------------------------------------------------------------------- */

static int write_png(const char *path, const render_options *o, const image *picture, const provenance *p)
{
    facet_error why = {0};
    image shown = {0};
    view v = VIEW_FILMIC;
    view_find(o->view, &v);
    facet_status status = view_picture(v, (float)o->exposure.value, picture, PIXEL_U8, &shown, &why);
    if (!status) status = png_write(path, &shown, p->pairs, p->n, &why);
    image_destroy(&shown);
    return status ? fail_with(FROM_OUTPUT, path, &why) : 0;
}

int write_outputs(const render_options *o, const provenance *p, const picture_set *pictures)
{
    int status = 0;
    for (size_t i = 0; i < o->outputs.n; i++) {
        const char *path = o->outputs.items[i];
        int failed = 0;
        facet_error why = {0};
        if (has_extension(path, "png")) failed = write_png(path, o, pictures->shown, p);
        else if (exr_write_layers(path, pictures->layers, pictures->n_layers, p->pairs, p->n_exr, p->world_to_camera,
                                  p->world_to_ndc, &why))
            failed = fail_with(FROM_OUTPUT, path, &why);
        if (failed) status = failed;
    }
    return status;
}

void print_render_json(const render_options *o, const render_settings *settings, const render_result *result,
                       const warning_list *warnings, bool is_interrupted)
{
    json_writer j = json_put_start(stdout);
    json_put_open(&j, NULL, '{');
    json_put_text(&j, "version", facet_version());
    json_put_open(&j, "outputs", '[');
    for (size_t i = 0; i < o->outputs.n; i++) json_put_text(&j, NULL, o->outputs.items[i]);
    json_put_close(&j, ']');
    json_put_integer(&j, "width", result->picture.width);
    json_put_integer(&j, "height", result->picture.height);
    json_put_integer(&j, "spp", result->spp);
    json_put_number(&j, "mean_spp", result->mean_spp);
    json_put_integer(&j, "seed", settings->seed);
    json_put_integer(&j, "ranks", settings->crew ? settings->crew->n_ranks : 1);
    json_put_bool(&j, "complete", result->is_complete);
    json_put_bool(&j, "interrupted", is_interrupted);
    json_put_number(&j, "seconds", round(1e6*result->seconds)/1e6);
    json_put_number(&j, "setup_seconds", round(1e6*result->setup_seconds)/1e6);
    json_put_integer(&j, "paths", result->n_paths);
    json_put_integer(&j, "rays", result->n_rays);
    json_put_integer(&j, "shadow_rays", result->n_shadow_rays);
    json_put_number(&j, "noise", result->noise >= 0 ? result->noise : NAN);
    json_put_integer(&j, "bad_samples", result->n_bad);
    json_put_integer(&j, "clamped_samples", result->n_clamped);
    json_put_bool(&j, "gradients", result->has_gradients);
    json_put_text(&j, "isa", result->isa);
    json_put_open(&j, "warnings", '[');
    for (size_t i = 0; i < warnings->n; i++) json_put_text(&j, NULL, warnings->items[i]);
    json_put_close(&j, ']');
    json_put_close(&j, '}');
}
