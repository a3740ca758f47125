/* denoiser.c: Intel Open Image Denoise, loaded at run time.  The functions and numbers below are those of its C API.
 * SPDX-License-Identifier: MIT */
#include "render/denoiser.h"

#include <dlfcn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/error.h"

typedef void *oidn_device;
typedef void *oidn_filter;

enum { OIDN_CPU = 1, OIDN_FLOAT3 = 3 };

/* The functions that are called, of version 2; version 1 calls the last two otherwise. */
typedef struct oidn_api {
    oidn_device (*new_device)(int type);
    void (*commit_device)(oidn_device device);
    void (*release_device)(oidn_device device);
    int (*device_error)(oidn_device device, const char **message);
    oidn_filter (*new_filter)(oidn_device device, const char *type);
    void (*set_image)(oidn_filter filter, const char *name, void *pixels, int format, size_t width, size_t height,
                      size_t offset, size_t pixel_stride, size_t row_stride);
    void (*commit_filter)(oidn_filter filter);
    void (*execute_filter)(oidn_filter filter);
    void (*release_filter)(oidn_filter filter);
    int (*device_number)(oidn_device device, const char *name);
    void (*set_flag)(oidn_filter filter, const char *name, bool value);
} oidn_api;

struct denoiser {
    void *library;
    oidn_api api;
    oidn_device device;
    char name[64];
};

/* Looks a function up by either of its names; false if there is none. */
static bool find(void *library, const char *name, const char *other, void *function)
{
    void *symbol = dlsym(library, name);
    if (!symbol && other) symbol = dlsym(library, other);
    *(void **)function = symbol;
    return symbol;
}

static bool find_all(void *library, oidn_api *api)
{
    return find(library, "oidnNewDevice", NULL, &api->new_device) &&
           find(library, "oidnCommitDevice", NULL, &api->commit_device) &&
           find(library, "oidnReleaseDevice", NULL, &api->release_device) &&
           find(library, "oidnGetDeviceError", NULL, &api->device_error) &&
           find(library, "oidnNewFilter", NULL, &api->new_filter) &&
           find(library, "oidnSetSharedFilterImage", NULL, &api->set_image) &&
           find(library, "oidnCommitFilter", NULL, &api->commit_filter) &&
           find(library, "oidnExecuteFilter", NULL, &api->execute_filter) &&
           find(library, "oidnReleaseFilter", NULL, &api->release_filter) &&
           find(library, "oidnGetDeviceInt", "oidnGetDevice1i", &api->device_number) &&
           find(library, "oidnSetFilterBool", "oidnSetFilter1b", &api->set_flag);
}

static void *open_library(const char *path)
{
    static const char *const names[] = {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1"};
    if (path) return dlopen(path, RTLD_NOW | RTLD_LOCAL);
    void *library = NULL;
    for (size_t i = 0; i < sizeof names/sizeof *names && !library; i++)
        library = dlopen(names[i], RTLD_NOW | RTLD_LOCAL);
    return library;
}

/* What the loader has to say, without the path that it begins with. */
static const char *loader_error(const char *path)
{
    const char *text = dlerror();
    const size_t length = path ? strlen(path) : 0;
    return length && strncmp(text, path, length) == 0 && text[length] == ':' ? text + length + 2 : text;
}

/* The device's last error as ours, if there is one. */
static facet_status check_device(const denoiser *d, facet_error *why)
{
    const char *message = NULL;
    if (d->device && d->api.device_error(d->device, &message) == 0) return FACET_OK;
    return facet_error_set(why, FACET_UNSUPPORTED, "", "Open Image Denoise: %s",
                           message ? message : "it makes no device");
}

facet_status denoiser_load(const char *path, denoiser **result, facet_error *why)
{
    denoiser *d = calloc(1, sizeof *d);
    if (!d) return facet_error_set(why, FACET_NO_MEMORY, "", "no memory for a denoiser");
    facet_status status = FACET_OK;
    d->library = open_library(path);
    if (!d->library) status = facet_error_set(why, FACET_IO, "", "cannot be loaded: %s", loader_error(path));
    else if (!find_all(d->library, &d->api))
        status = facet_error_set(why, FACET_BAD_FILE, "", "is not Open Image Denoise: %s", loader_error(path));
    if (!status) {
        d->device = d->api.new_device(OIDN_CPU);
        if (d->device) d->api.commit_device(d->device);
        status = check_device(d, why);
    }
    if (status) {
        denoiser_destroy(d);
        return status;
    }
    const int version = d->api.device_number(d->device, "version"); /* 20501 is 2.5.1 */
    snprintf(d->name, sizeof d->name, "Open Image Denoise %d.%d.%d", version/10000, version/100%100,
             version%100);
    *result = d;
    return FACET_OK;
}

/* The library stays loaded: its threads may live on. */
void denoiser_destroy(denoiser *d)
{
    if (d && d->device) d->api.release_device(d->device);
    free(d);
}

const char *denoiser_name(const denoiser *d)
{
    return d->name;
}

enum { COLOR, ALBEDO, NORMAL, N_INPUTS };
static const char *const input_names[N_INPUTS] = {"color", "albedo", "normal"};

/* Runs one filter from pictures of w x h pixels, of which those that are NULL are not used. */
static void run_filter(const denoiser *d, float *const inputs[N_INPUTS], bool is_clean, size_t w, size_t h,
                       float *output)
{
    const oidn_api *api = &d->api;
    oidn_filter filter = api->new_filter(d->device, "RT");
    if (!filter) return; /* the device has an error */
    for (int i = 0; i < N_INPUTS; i++)
        if (inputs[i]) api->set_image(filter, input_names[i], inputs[i], OIDN_FLOAT3, w, h, 0, 0, 0);
    api->set_image(filter, "output", output, OIDN_FLOAT3, w, h, 0, 0, 0);
    if (inputs[COLOR]) api->set_flag(filter, "hdr", true);
    if (is_clean) api->set_flag(filter, "cleanAux", true);
    api->commit_filter(filter);
    api->execute_filter(filter);
    api->release_filter(filter);
}

facet_status denoiser_run(const denoiser *d, const image *picture, const image *albedo, const image *normal,
                          image *result, facet_error *why)
{
    const size_t w = picture->width, h = picture->height;
    float *clean_albedo = calloc(w*h, 3*sizeof(float)), *clean_normal = calloc(w*h, 3*sizeof(float)),
          *pixels = calloc(w*h, 3*sizeof(float));
    facet_status status = FACET_OK;
    if (clean_albedo && clean_normal && pixels) {
        /* Albedo and normal are noisy, too: they are denoised on their own, so that their edges can be trusted. */
        run_filter(d, (float *[N_INPUTS]){[ALBEDO] = albedo->pixels}, false, w, h, clean_albedo);
        run_filter(d, (float *[N_INPUTS]){[NORMAL] = normal->pixels}, false, w, h, clean_normal);
        run_filter(d, (float *[N_INPUTS]){picture->pixels, clean_albedo, clean_normal}, true, w, h, pixels);
        status = check_device(d, why);
    } else {
        status = facet_error_set(why, FACET_NO_MEMORY, "", "no memory for the denoised picture");
    }
    if (!status) {
        *result = (image){.width = w, .height = h, .n_channels = 3, .type = PIXEL_F32, .pixels = pixels};
        pixels = NULL;
    }
    free(pixels);
    free(clean_normal);
    free(clean_albedo);
    return status;
}
