/* render.h: a scene and settings in, a picture out.
 *
 * The picture is a pure function of scene and settings: the same bits for any number of threads, however often the
 * render was stopped and continued, and however its samples were divided into shards, on one Embree instruction set
 * (settings.isa; render_state.isa tells which was used).
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "facet/facet.h"
#include "render/film.h"
#include "render/image.h"
#include "render/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How light is found: by rays towards lights, by rays that happen to hit lights, or by both, weighted by
 * the power heuristic.  All three converge to the same picture; lights that no ray can hit (point, spot,
 * directional) are always sampled explicitly. */
typedef enum strategy { STRATEGY_MIS, STRATEGY_EXPLICIT, STRATEGY_IMPLICIT } strategy;

typedef enum sampler_kind { SAMPLER_SOBOL, SAMPLER_RANDOM } sampler_kind;

/* Whether neighbouring pixels share light (stage_gradients.c): less noise, the same mean; not with half-transparent
 * materials.  By default where it pays (pilot.h). */
typedef enum gradients { GRADIENTS_AUTO, GRADIENTS_ON, GRADIENTS_OFF } gradients;

typedef struct render_progress {
    uint64_t samples_done, samples_total; /* pixel samples; the total as far as the noise target lets it be known */
    double seconds;                       /* since the start of rendering */
    double samples_per_second;
    double noise;     /* estimated relative standard error of the picture; negative while unknown */
    double time_left; /* [s], to the nearest of the limits; negative while unknown */
} render_progress;

#define RENDER_MAX_REPORTED 8

/* A sample whose radiance was not finite: it was counted as black. */
typedef struct bad_sample {
    uint32_t x, y, sample;
} bad_sample;

/* All that a render has done, from which it can be continued.  Everything adds up over parts of a render. */
typedef struct render_state {
    struct film
        film; /* of crop_w x crop_h; its samples are the first of the shard's share, the same number in all of a tile */
    uint64_t n_paths, n_rays, n_shadow_rays;
    uint64_t n_bad; /* samples that were NaN or infinite */
    bad_sample bad[RENDER_MAX_REPORTED];
    double seconds;        /* rendering alone, wall clock */
    double cpu_seconds;    /* of the whole process while rendering */
    double mean_luminance; /* of the picture when its noise was first estimated, which noise targets of tiles go by; 0
                              before and without one */
    uint32_t spp; /* whole passes over the picture, in samples per pixel; tiles may be further, or have ended before */
    const char *isa; /* what Embree used; static storage */
} render_state;

typedef struct render_settings {
    size_t width, height;                  /* of the whole picture [pixel] */
    size_t crop_x, crop_y, crop_w, crop_h; /* the part to render; crop_w == 0: all of it */
    size_t camera;                         /* index into scene.cameras */
    uint32_t spp;                          /* samples per pixel, >= 1 */
    uint32_t depth;                        /* most scattering events on a path; 0: lights seen directly */
    uint32_t n_threads;                    /* 0: one per processor */
    uint32_t seed;
    enum strategy strategy;
    sampler_kind sampler;
    enum gradients gradients;
    uint32_t shard, n_shards; /* render the samples of the shard-th of n_shards, from 1; n_shards == 0: all of them */
    const char *isa;     /* Embree's instruction set: "sse2", "sse4.2", "avx", "avx2", "avx512"; NULL: avx2 where there
                        is one, else the best, or none at all for a small scene ("any") */
    double time_limit;   /* [s], with what a continued render took before; 0: none.  Checked between passes */
    double noise_target; /* stop at this film_noise, and leave tiles that are quiet enough before; 0: none */
    bool keeps_features; /* albedo, normal and distance of what is seen first, beside the radiance */
    /* Called on the calling thread about ten times a second; false asks for an early end.  May be NULL. */
    bool (*progress)(void *user, const render_progress *state);
    /* Called on the calling thread every save_interval [s], when wants_save says so (asked about ten times a second;
     * may be NULL), and when rendering ends, while no thread works.  May be NULL. */
    void (*save)(void *user, const render_state *state);
    double save_interval;
    bool (*wants_save)(void *user);
    void *user;
    const struct crew *crew; /* processes that share this render (crew.h); NULL: this one alone */
} render_settings;

void render_settings_defaults(render_settings *settings);

typedef struct render_result {
    image picture;    /* F32 RGB, crop_w x crop_h, linear radiance */
    uint32_t spp;     /* samples per pixel reached, in tiles that did not end before */
    double mean_spp;  /* of all pixels */
    bool is_complete; /* all of settings.spp; false after time, noise or a requested end */
    bool is_stopped;  /* the end was requested, by progress, here or on another rank */
    uint64_t n_paths, n_rays, n_shadow_rays;
    uint64_t n_bad; /* samples that were NaN or infinite */
    bad_sample bad[RENDER_MAX_REPORTED];
    uint64_t n_clamped;   /* samples beyond FILM_MOST */
    double seconds;       /* rendering alone, wall clock */
    double cpu_seconds;   /* of the whole process while rendering */
    double setup_seconds; /* acceleration structure, light tables and pilot */
    bool has_gradients;   /* light was shared */
    double noise;         /* as in render_progress */
    const char *isa;      /* what Embree used; static storage */
} render_result;

/* Renders.  On success *result holds the picture, which render_result_destroy frees. */
facet_status render(const scene *s, const render_settings *settings, render_result *result, facet_error *why);
void render_result_destroy(render_result *result);

/* Renders what is left to do: all, if *state is zero, else what a state of the same scene and settings leaves.  The
 * state remains the caller's to destroy.  FACET_BAD_VALUE for one that these settings cannot have made.  In a crew all
 * but the leader begin with a zero state and end with an empty result. */
facet_status render_continue(const scene *s, const render_settings *settings, render_state *state,
                             render_result *result, facet_error *why);
void render_state_destroy(render_state *state);

/* Adds another shard's state of the same render. */
void render_state_merge(render_state *state, const render_state *other);

/* What has been rendered, without the figures of a run: setup_seconds, has_gradients and is_complete. */
facet_status render_develop(const render_state *state, render_result *result, facet_error *why);

/* The samples of each pixel that are a shard's: *n from *first on. */
void render_share(uint32_t spp, uint32_t shard, uint32_t n_shards, uint32_t *first, uint32_t *n);

/* world_to_camera and world_to_ndc (x and y in [-1,1]) of a camera for a picture of that shape, as row
 * vectors times 4x4 matrices, for the picture's metadata. */
void camera_matrices(const camera *c, size_t width, size_t height, float world_to_camera[16], float world_to_ndc[16]);

#ifdef __cplusplus
}
#endif
