/* layers.h: the pictures that a render is developed into: the one to be seen, and those of --aov beside it.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "cli/render_job.h"
#include "io/image_file.h"
#include "render/denoiser.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { MOST_AOVS = 5 };

/* --aov as a set of bits, and the denoiser of --denoise. */
typedef struct layer_choice {
    unsigned wanted; /* bit i: the i-th name of the list in layers.c */
    bool is_denoised;
    denoiser *denoiser; /* NULL until it is loaded */
} layer_choice;

/* Reads --aov, --denoise and --oidn.  Returns 0 or the exit status of the error that it printed; *choice is the
 * caller's to destroy in both cases. */
int choose_layers(const render_options *o, layer_choice *choice);

/* Loads the denoiser if there shall be one, for picture_set_create: before anything is rendered, so that nothing is
 * rendered in vain.  Returns as choose_layers. */
int load_denoiser(const render_options *o, layer_choice *choice);
void layer_choice_destroy(layer_choice *choice);

/* Whether the film must keep features for it. */
bool layers_need_features(const layer_choice *choice);

typedef struct picture_set {
    const image *shown; /* what .png files show */
    image denoised, aovs[MOST_AOVS];
    exr_layer layers[1 + MOST_AOVS];
    size_t n_layers;
    const char *denoiser; /* its name, or NULL */
} picture_set;

/* All pictures of a film whose developed picture is given; borrowed until picture_set_destroy.  Returns 0 or the exit
 * status of the error that it printed; *set is the caller's to destroy in both cases. */
int picture_set_create(const render_options *o, const film *f, const image *picture, picture_set *set);
void picture_set_destroy(picture_set *set);

#ifdef __cplusplus
}
#endif
