/* fake_oidn.c: a library with the functions of Open Image Denoise that facet calls, for tests of what is handed over.
 *
 * A filter of one picture copies it; one of all three gives color + 2 albedo + 4 normal.  What the real library would
 * complain about is an error here, too, as is a picture 13 pixels wide.
 * SPDX-License-Identifier: MIT */
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#pragma GCC visibility push(default)

typedef struct fake_device {
    const char *message;
    bool is_committed;
} fake_device;

typedef struct fake_filter {
    fake_device *device;
    float *color, *albedo, *normal, *output;
    size_t n_pixels;
    bool is_hdr, is_clean, is_committed;
} fake_filter;

/* No header declares them: facet knows them by name alone. */
void *oidnNewDevice(int type);
void oidnCommitDevice(fake_device *d);
void oidnReleaseDevice(fake_device *d);
int oidnGetDeviceError(fake_device *d, const char **message);
int oidnGetDeviceInt(fake_device *d, const char *name);
void *oidnNewFilter(fake_device *d, const char *type);
void oidnSetSharedFilterImage(fake_filter *f, const char *name, void *pixels, int format, size_t width, size_t height,
                              size_t offset, size_t pixel_stride, size_t row_stride);
void oidnSetFilterBool(fake_filter *f, const char *name, bool value);
void oidnCommitFilter(fake_filter *f);
void oidnExecuteFilter(fake_filter *f);
void oidnReleaseFilter(fake_filter *f);

void *oidnNewDevice(int type)
{
    return type == 1 ? calloc(1, sizeof(fake_device)) : NULL;
}

void oidnCommitDevice(fake_device *d)
{
    d->is_committed = true;
}

void oidnReleaseDevice(fake_device *d)
{
    free(d);
}

int oidnGetDeviceError(fake_device *d, const char **message)
{
    *message = d->message;
    return d->message ? 1 : 0;
}

int oidnGetDeviceInt(fake_device *d, const char *name)
{
    return d->is_committed && strcmp(name, "version") == 0 ? 20399 : 0;
}

void *oidnNewFilter(fake_device *d, const char *type)
{
    fake_filter *f = calloc(1, sizeof *f);
    if (f) f->device = d;
    if (strcmp(type, "RT") != 0) d->message = "no such filter";
    return f;
}

void oidnSetSharedFilterImage(fake_filter *f, const char *name, void *pixels, int format, size_t width, size_t height,
                              size_t offset, size_t pixel_stride, size_t row_stride)
{
    float **to = strcmp(name, "color") == 0    ? &f->color
                 : strcmp(name, "albedo") == 0 ? &f->albedo
                 : strcmp(name, "normal") == 0 ? &f->normal
                                               : &f->output;
    if (format != 3 || offset || pixel_stride || row_stride) f->device->message = "not packed floats";
    if (f->n_pixels && f->n_pixels != width*height) f->device->message = "different sizes";
    if (width == 13) f->device->message = "thirteen";
    f->n_pixels = width*height;
    *to = pixels;
}

void oidnSetFilterBool(fake_filter *f, const char *name, bool value)
{
    if (strcmp(name, "hdr") == 0) f->is_hdr = value;
    if (strcmp(name, "cleanAux") == 0) f->is_clean = value;
}

void oidnCommitFilter(fake_filter *f)
{
    f->is_committed = true;
}

void oidnExecuteFilter(fake_filter *f)
{
    const bool is_whole = f->color && f->albedo && f->normal && f->is_hdr && f->is_clean;
    const bool is_part = !f->color && !f->albedo != !f->normal && !f->is_hdr && !f->is_clean;
    if (!f->is_committed || !f->output || !(is_whole || is_part))
        f->device->message = "not a filter that facet asks for";
    if (f->device->message) return;
    for (size_t i = 0; i < 3*f->n_pixels; i++)
        f->output[i] = is_whole    ? f->color[i] + 2*f->albedo[i] + 4*f->normal[i]
                       : f->albedo ? f->albedo[i]
                                   : f->normal[i];
}

void oidnReleaseFilter(fake_filter *f)
{
    free(f);
}
