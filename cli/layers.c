/* layers.c: the pictures that a render is developed into.
 * SPDX-License-Identifier: MIT */
#include "cli/layers.h"

#include <stdlib.h>
#include <string.h>

#include "cli/report.h"
#include "core/error.h"

/* ---- What --aov may name ------------------------------------------------------------------------- */

enum { NOISY = -1 }; /* the picture before denoising, in place of a film_layer */

static const struct {
    const char *name;
    const char *channels[4];
    int layer;
    bool keeps_precision; /* float in spite of --half */
} aovs[MOST_AOVS] = {
    {"albedo", {"albedo.R", "albedo.G", "albedo.B"}, FILM_ALBEDO, false},
    {"normal", {"normal.X", "normal.Y", "normal.Z"}, FILM_NORMAL, false},
    {"distance", {"distance.Z"}, FILM_DISTANCE, true},
    {"samples", {"samples.Y"}, FILM_SAMPLES, true},
    {"noisy", {"noisy.R", "noisy.G", "noisy.B"}, NOISY, false},
};

static bool is_wanted(const layer_choice *choice, int i)
{
    return choice->wanted >> i & 1;
}

static int parse_names(const char *list, unsigned *wanted)
{
    for (const char *p = list; *p;) {
        const size_t length = strcspn(p, ",");
        int found = -1;
        for (int i = 0; i < MOST_AOVS; i++)
            if (strlen(aovs[i].name) == length && strncmp(aovs[i].name, p, length) == 0) found = i;
        if (found < 0)
            return fail(EXIT_USAGE, NULL, "--aov",
                        "`%.*s` is none of albedo, normal, distance, samples and noisy; give some of them with commas",
                        (int)(length < 100 ? length : 100), p);
        *wanted |= 1u << found;
        p += length + (p[length] == ',');
    }
    return 0;
}

/* ---- Before rendering ---------------------------------------------------------------------------- */

int load_denoiser(const render_options *o, layer_choice *choice)
{
    facet_error why = {0};
    const char *variable = getenv("FACET_OIDN"), *path = o->oidn ? o->oidn : variable && *variable ? variable : NULL;
    if (!choice->is_denoised || denoiser_load(path, &choice->denoiser, &why) == FACET_OK) return 0;
    if (path) return fail(EXIT_WORLD, path, NULL, "%s; give --oidn the path of libOpenImageDenoise.so.2", why.text);
    return fail(EXIT_WORLD, NULL, "--denoise",
                "Open Image Denoise %s; after `pip download pyoidn` and unzip, --oidn "
                "pyoidn/oidn/lib/libOpenImageDenoise.so.2 names it",
                why.text);
}

int choose_layers(const render_options *o, layer_choice *choice)
{
    *choice = (layer_choice){.is_denoised = o->denoise};
    int status = o->aov ? parse_names(o->aov, &choice->wanted) : 0;
    if (!status && o->oidn && !o->denoise)
        status = fail(EXIT_USAGE, NULL, "--oidn", "is the library of --denoise, which is not given");
    for (int i = 0; i < MOST_AOVS && !status; i++)
        if (is_wanted(choice, i) && aovs[i].layer == NOISY && !o->denoise)
            status = fail(EXIT_USAGE, NULL, "--aov", "noisy is the picture before --denoise, which is not given");
    return status;
}

void layer_choice_destroy(layer_choice *choice)
{
    denoiser_destroy(choice->denoiser);
    *choice = (layer_choice){0};
}

bool layers_need_features(const layer_choice *choice)
{
    bool needs = choice->is_denoised;
    for (int i = 0; i < MOST_AOVS; i++)
        needs |= is_wanted(choice, i) && aovs[i].layer != FILM_SAMPLES && aovs[i].layer != NOISY;
    return needs;
}

/* ---- After rendering ----------------------------------------------------------------------------- */

static facet_status denoise(const layer_choice *choice, const film *f, const image *picture, picture_set *set,
                            facet_error *why)
{
    image albedo = {0}, normal = {0};
    facet_status status = film_develop_layer(f, FILM_ALBEDO, &albedo);
    if (!status) status = film_develop_layer(f, FILM_NORMAL, &normal);
    if (status) facet_error_set(why, status, "", "no memory for the pictures that denoising needs");
    else status = denoiser_run(choice->denoiser, picture, &albedo, &normal, &set->denoised, why);
    image_destroy(&albedo);
    image_destroy(&normal);
    if (!status) {
        set->shown = &set->denoised;
        set->denoiser = denoiser_name(choice->denoiser);
    }
    return status;
}

static void add_layer(picture_set *set, const image *picture, const char *const channels[4], exr_precision precision)
{
    exr_layer *added = &set->layers[set->n_layers++];
    *added = (exr_layer){.picture = picture, .precision = precision};
    memcpy(added->channels, channels, sizeof added->channels);
}

int picture_set_create(const render_options *o, const film *f, const image *picture, picture_set *set)
{
    const layer_choice *choice = o->layers;
    static const char *const rgb[4] = {"R", "G", "B"};
    const exr_precision precision = o->half ? EXR_HALF : EXR_FLOAT;
    facet_error why = {0};
    *set = (picture_set){.shown = picture};
    if (choice->denoiser && (why.status = denoise(choice, f, picture, set, &why)) != FACET_OK)
        return fail_with(FROM_OUTPUT, NULL, &why);
    add_layer(set, set->shown, rgb, precision);
    for (int i = 0; i < MOST_AOVS; i++) {
        if (!is_wanted(choice, i)) continue;
        const bool is_noisy = aovs[i].layer == NOISY;
        if (!is_noisy && film_develop_layer(f, (film_layer)aovs[i].layer, &set->aovs[i])) return fail_memory();
        add_layer(set, is_noisy ? picture : &set->aovs[i], aovs[i].channels,
                  aovs[i].keeps_precision ? EXR_FLOAT : precision);
    }
    return 0;
}

void picture_set_destroy(picture_set *set)
{
    image_destroy(&set->denoised);
    for (int i = 0; i < MOST_AOVS; i++) image_destroy(&set->aovs[i]);
    *set = (picture_set){0};
}
