/* settings_setup.c: the settings that `facet render` renders with: the options', completed.
 * SPDX-License-Identifier: MIT */
#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/render_job.h"
#include "cli/report.h"

/* Where --time or --noise is to end the render and --spp does not say more. */
enum { DEFAULT_SPP = 64, UNLIMITED_SPP = 65536, DEFAULT_HEIGHT = 540, MAX_SIDE = 65536 };

/* Size from --size, else from the camera's aspect; crop within it. */
static int choose_size(const render_options *o, const camera *c, render_settings *r)
{
    const double aspect = c->aspect > 0 ? c->aspect : 16.0/9;
    r->height = o->size[1] ? o->size[1] : DEFAULT_HEIGHT;
    r->width = o->size[0] ? o->size[0] : (size_t)fmin(fmax(round(DEFAULT_HEIGHT*aspect), 1), MAX_SIDE);
    if (r->width > MAX_SIDE || r->height > MAX_SIDE || r->width > IMAGE_PIXEL_CAP/r->height)
        return fail(EXIT_USAGE, NULL, "--size",
                    "%zux%zu is too large; a picture has at most %d pixels a side and %zu in all", r->width, r->height,
                    MAX_SIDE, IMAGE_PIXEL_CAP);
    const size_t *crop = o->crop;
    if (crop[2] &&
        (crop[0] >= r->width || crop[2] > r->width - crop[0] || crop[1] >= r->height || crop[3] > r->height - crop[1]))
        return fail(EXIT_USAGE, NULL, "--crop", "%zu,%zu,%zu,%zu does not lie inside the picture of %zux%zu pixels",
                    crop[0], crop[1], crop[2], crop[3], r->width, r->height);
    r->crop_x = crop[0];
    r->crop_y = crop[1];
    r->crop_w = crop[2];
    r->crop_h = crop[3];
    return 0;
}

/* --shard K/N */
static int parse_shard(const render_options *o, render_settings *r)
{
    char *end, *last = NULL;
    if (!o->shard) return 0;
    const unsigned long shard = strtoul(o->shard, &end, 10), n_shards = *end == '/' ? strtoul(end + 1, &last, 10) : 0;
    if (!last || *last || !isdigit((unsigned char)o->shard[0]) || !isdigit((unsigned char)end[1]) || shard < 1 ||
        shard > n_shards)
        return fail(EXIT_USAGE, NULL, "--shard", "`%s` is not K/N with K from 1 to N, such as 3/16", o->shard);
    if (n_shards > r->spp)
        return fail(EXIT_USAGE, NULL, "--shard", "%lu shards for %" PRIu32 " samples per pixel; give at most as many",
                    n_shards, r->spp);
    r->shard = (uint32_t)shard;
    r->n_shards = (uint32_t)n_shards;
    return 0;
}

int prepare_settings(const render_options *o, const scene *s, size_t i_camera, render_settings *r)
{
    render_settings_defaults(r);
    const bool has_limit = o->time.is_given || o->noise.is_given;
    r->camera = i_camera;
    r->spp = o->spp ? (uint32_t)o->spp : has_limit ? UNLIMITED_SPP : DEFAULT_SPP;
    r->depth = (uint32_t)o->depth;
    r->n_threads = (uint32_t)o->threads;
    r->seed = (uint32_t)o->seed;
    r->strategy = strcmp(o->strategy, "explicit") == 0   ? STRATEGY_EXPLICIT
                  : strcmp(o->strategy, "implicit") == 0 ? STRATEGY_IMPLICIT
                                                         : STRATEGY_MIS;
    r->sampler = strcmp(o->sampler, "random") == 0 ? SAMPLER_RANDOM : SAMPLER_SOBOL;
    r->gradients = strcmp(o->gradients, "on") == 0    ? GRADIENTS_ON
                   : strcmp(o->gradients, "off") == 0 ? GRADIENTS_OFF
                                                      : GRADIENTS_AUTO;
    r->isa = o->isa;
    r->time_limit = o->time.value;
    r->noise_target = o->noise.value;
    const int status = choose_size(o, &s->cameras[i_camera], r);
    return status ? status : parse_shard(o, r);
}
