/* offscreen.h: runs fragment shaders without a window, through EGL and Mesa's software renderer, on textures of floats.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { OFFSCREEN_WIDTH = 64, OFFSCREEN_INPUTS = 3, OFFSCREEN_OUTPUTS = 4 };

typedef enum shader_language { GLSL_ES_300, GLSL_450 } shader_language;

/* Makes a context of the language current.  NULL, or why there is none; static storage. */
const char *offscreen_open(shader_language language);
void offscreen_close(void);

/* The renderer's name; static storage of the driver. */
const char *offscreen_renderer(void);

/* Compiles and links a fragment shader given in pieces.  0 and a message in log[size] on failure. */
int offscreen_compile(const char *const *pieces, int n_pieces, char *log, size_t size);

/* The three input textures, RGBA, 64 wide and `height` high, by the names of their samplers. */
void offscreen_inputs(const char *const names[OFFSCREEN_INPUTS], const float *const texels[OFFSCREEN_INPUTS],
                      int height);

/* Draws with the uniform uvec4 array `name` filled, and reads the four outputs, RGBA each.  0 on an error of GL. */
int offscreen_draw(const char *name, const uint32_t *words, int n_vectors, int height,
                   float *const outputs[OFFSCREEN_OUTPUTS]);

#ifdef __cplusplus
}
#endif
