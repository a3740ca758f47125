/* scene_builder.h: small scenes made in a test, and what a picture of them says about a radiance.
 *
 * A fault while building ends the test.  Materials are libfacet's text form with a grey emission.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>

#include "render/render.h"
#include "render/scene.h"
#include "render/surface.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Instrumented and unoptimised builds take this fraction of the samples. */
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(undefined_behavior_sanitizer)
#define SCENE_BUILDER_IS_SLOW 1
#endif
#endif
#if defined(SCENE_BUILDER_IS_SLOW) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) ||                 \
    !defined(__OPTIMIZE__)
enum { SAMPLE_DIVISOR = 16 };
#else
enum { SAMPLE_DIVISOR = 1 };
#endif

scene *build_scene(void);

/* A material of kind SURFACE_BSDF; returns its index. */
size_t build_material(scene *s, const char *spec, float emission, bool is_double_sided);

/* glTF's own material with these factors. */
size_t build_gltf_material(scene *s, float base, float metallic, float roughness);

/* A mesh that no instance uses yet; the arrays are copied. */
size_t build_mesh(scene *s, size_t mat, const float (*positions)[3], size_t n_vertices, const uint32_t (*triangles)[3],
                  size_t n_triangles);

/* to_world: 3x4, NULL for identity. */
void build_instance(scene *s, size_t mesh_index, const float (*to_world)[4]);

/* corner + [0,1] u + [0,1] v, with texture coordinates (0,0) at the corner; its front is where u x v points.
 * Returns the mesh, which has one instance. */
size_t build_quad(scene *s, size_t mat, const float corner[3], const float u[3], const float v[3]);

/* Twelve triangles that face outwards, as a mesh without instance. */
size_t build_box(scene *s, size_t mat, const float low[3], const float high[3]);

/* A horizontal disc of n triangles around `center`; faces down.  An instance of its own. */
void build_disc(scene *s, size_t mat, const float center[3], float radius, unsigned n);

/* The part of a unit sphere around the origin between two cosines from +y, in n_up bands of equal height by
 * n_around sectors; faces inwards or outwards.  Vertices lie on the sphere.  A mesh without instance. */
size_t build_zone(scene *s, size_t mat, float cos_from, float cos_to, unsigned n_up, unsigned n_around, bool is_inward);

void build_sphere(scene *s, size_t mat, float x, float y, float z, float radius);

/* surface_find for one hit; its bsdf is NULL. */
surface surface_of_hit(const scene *s, const ray *r, const hit *h, real3 wo);

/* A camera at `eye` looking at `target`. */
void build_camera(scene *s, const float eye[3], const float target[3], float yfov);

/* An orthographic camera: the picture is 2 half_height high. */
void build_orthographic(scene *s, const float eye[3], const float target[3], float half_height);

/* An RGBA texture of 8-bit texels, linear data, repeated; returns the index of the texture. */
size_t build_texture(scene *s, size_t width, size_t height, const unsigned char *rgba, bool is_nearest);

/* A quad of a material by its specification. */
void build_wall(scene *s, const char *spec, const float corner[3], const float u[3], const float v[3]);

/* A quad from (x,.1,z) up, of glTF's own material, whose base colour is a 2 x 2 texture with holes. */
void build_veil(scene *s, alpha_mode alpha, float x, float z);

/* An environment map; the texels [height][width][3] are copied. */
void build_sky(scene *s, size_t width, size_t height, const float *texels);

/* A ball on a floor under a small lamp and a dim sky, with a camera: noise of several kinds, in less than a second. */
scene *build_ball_and_lamp(void);

/* width x height pixels, spp/SAMPLE_DIVISOR independent random samples each, on two threads. */
render_settings random_settings(size_t width, size_t height, uint32_t spp);

/* Renders; the picture is the caller's to destroy.  Fails the test if a sample was not finite. */
image render_picture(const scene *s, const render_settings *settings);

/* The mean luminance of a picture and its standard error, both absolute. */
typedef struct estimate {
    double mean, error;
} estimate;

/* Renders; the samples must be independent (random_settings) for the error to be right.  Fails the test if a
 * sample was not finite. */
estimate measure(const scene *s, const render_settings *settings);

/* Whether the estimate allows this truth: no further off than four standard errors and what single precision may
 * cost, 2e-5 of the truth (an event of a path rounds its weight by some 1e-6). */
bool estimate_agrees(estimate e, double truth);

/* Fails the test unless the estimate agrees and is precise: a standard error of an eighth of a percent, so that a
 * deviation of half a percent would have been found.  (SAMPLE_DIVISOR times fewer samples: so much wider.) */
void expect_estimate(const char *what, estimate e, double truth);

#ifdef __cplusplus
}
#endif
