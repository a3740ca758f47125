/* denoiser.h: Intel Open Image Denoise, of major version 2 or 1, loaded where it is asked for.
 *
 * The library is no part of the build: Debian 12 does not have it, but a release of its authors or a package of the
 * Python registry can be pointed at.  Its results may differ in the last bits from machine to machine.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "facet/facet.h"
#include "render/image.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct denoiser denoiser;

/* Loads the library of that path, or, with NULL, the one that the system finds.  The error's place is empty. */
facet_status denoiser_load(const char *path, denoiser **result, facet_error *why);
void denoiser_destroy(denoiser *d);

/* "Open Image Denoise 2.5.1" */
const char *denoiser_name(const denoiser *d);

/* The picture without its noise, by the help of the albedo and the normals of what it shows: F32 of three channels and
 * the same size.  *result is the caller's to destroy. */
facet_status denoiser_run(const denoiser *d, const image *picture, const image *albedo, const image *normal,
                          image *result, facet_error *why);

#ifdef __cplusplus
}
#endif
