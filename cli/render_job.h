/* render_job.h: the parts of `facet render`: its options, the scene that it prepares, the files it writes.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>

#include "cli/options.h"
#include "render/crew.h"
#include "render/render.h"
#include "render/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct render_options {
    text_list outputs, materials;
    uint64_t spp, depth, threads, seed;
    size_t size[2], crop[4];
    const char *camera, *env, *strategy, *sampler, *gradients, *isa, *view;
    const char *checkpoint, *resume, *shard, *events, *mpi;
    const char *aov, *oidn;
    option_number env_scale, time, noise, exposure, checkpoint_interval;
    uint64_t max_memory;             /* 0: the default */
    const char *serve, *serve_token; /* serve: "" for its default */
    bool half, quiet, json, denoise, allow_outside, serve_stay;
    const struct layer_choice *layers; /* what --aov and --denoise lead to */
    /* what the command line as a whole leads to */
    const char *scene_path; /* NULL: the demo scene */
    char *default_output;   /* owned; NULL when outputs were named */
    char *command_line;     /* owned; quoted for a shell; of a resumed render, that of its first run */
    const crew *crew;       /* processes that render this together; NULL: this one alone */
} render_options;

/* Warnings, kept for --json after they were printed. */
typedef struct warning_list {
    char **items;
    size_t n, n_dropped;
    struct event_log *events; /* told of each; may be NULL */
} warning_list;

/* Prints a warning and keeps it; beyond a cap it is only counted. */
void keep_warning(warning_list *list, const char *format, ...) __attribute__((format(printf, 2, 3)));
void warning_list_destroy(warning_list *list);

/* A gltf_warning that keeps: user points to a warning_source. */
typedef struct warning_source {
    warning_list *list;
    const char *path;
    const render_options *options; /* for what is done with the scene besides; may be NULL */
    const char *lost;              /* an output that is a file of the scene; NULL: none so far */
} warning_source;
void keep_gltf_warning(void *user, const char *text);

/* Loads the scene and applies camera, environment and material options; *i_camera is the one to use.  Returns
 * 0 or the exit status of the error that it printed; *result is the caller's to destroy in both cases. */
int prepare_scene(const render_options *o, warning_list *warnings, scene **result, size_t *i_camera);

/* All settings but the callbacks.  Returns 0 or the exit status of the error that it printed. */
int prepare_settings(const render_options *o, const scene *s, size_t i_camera, render_settings *r);

/* Refuses an output that is the file of an input, by whatever names; input may be NULL. */
int check_spares(const char *output, const char *input);

/* Refuses pictures, --checkpoint and --events that are one file, or one of the inputs, which may be NULL, or --resume:
 * but for a checkpoint, which goes on in its own file. */
int check_apart(const render_options *o, const char *const *inputs, size_t n_inputs);

/* Refuses outputs that could not be written at the end: unknown kinds, missing folders, names that are too long.  What
 * killed runs have left beside them is removed. */
int check_outputs(const render_options *o);

/* The same for a checkpoint, and refuses to replace a file that is none. */
int check_checkpoint(const char *path);

/* Writes all outputs with their provenance.  One that fails does not keep the others from being written. */
struct provenance;
struct picture_set;
int write_outputs(const render_options *o, const struct provenance *p, const struct picture_set *pictures);

/* The render's summary as one JSON object on stdout. */
void print_render_json(const render_options *o, const render_settings *settings, const render_result *result,
                       const warning_list *warnings, bool is_interrupted);

#ifdef __cplusplus
}
#endif
