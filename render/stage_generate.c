/* stage_generate.c: camera rays.
 * SPDX-License-Identifier: MIT */
#include "render/stages.h"

#include <math.h>

/* The camera's ray through a point of the picture; x and y in pixels of the whole picture.  tan: of half the field of
 * view. */
static void camera_ray(const path_context *c, float tan, float x, float y, uint32_t seed, ray_array *r, uint32_t i)
{
    const camera *cam = c->camera;
    const float w = (float)c->settings->width, h = (float)c->settings->height;
    const float right = (2*x/w - 1)*w/h, up = 1 - 2*y/h;
    if (cam->is_orthographic) {
        const real3 origin = map_point(cam->to_world, make3(right*cam->ymag, up*cam->ymag, 0));
        set_ray(r, i, origin, normalize3(map_vector(cam->to_world, make3(0, 0, -1))), INFINITY, seed);
    } else {
        const real3 local = make3(right*tan, up*tan, -1);
        set_ray(r, i, map_column(cam->to_world, 3), normalize3(map_vector(cam->to_world, local)), INFINITY, seed);
    }
}

/* One path per pixel of the tile. */
void stage_generate(path_batch *batch, const path_context *c, tile where, uint32_t sample)
{
    path_list *list = &batch->lists[0];
    uint32_t n = 0;
    for (uint32_t y = where.y0; y < where.y1; y++)
        for (uint32_t x = where.x0; x < where.x1; x++, n++) {
            const uint32_t px = x + (uint32_t)c->settings->crop_x, py = y + (uint32_t)c->settings->crop_y;
            const sample_stream stream = sampler_start(&c->sampler, px, py, sample);
            list->slot[n] = n;
            list->pixel[n] = stream.pixel;
            list->index[n] = stream.index;
            list->eta_scale[n] = 1;
            list->lobe[n] = 0;
            set3(&list->throughput, n, splat3(1));
            set3(&batch->radiance, n, splat3(0));
        }
    list->n = n;
    if (c->keeps_features) feature_start(batch, n);
    uint32_t *const u[3] = {batch->chance[0], batch->chance[1], batch->chance[2]};
    render_loops_chosen()->points(&c->sampler, n, list->pixel, list->index, GROUP_CAMERA, u);
    const float tan = tanf(0.5f*c->camera->yfov);
    const uint32_t width = where.x1 - where.x0;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t px = where.x0 + i%width + (uint32_t)c->settings->crop_x,
                       py = where.y0 + i/width + (uint32_t)c->settings->crop_y;
        camera_ray(c, tan, (float)px + fraction(u[0][i]), (float)py + fraction(u[1][i]), u[2][i], &list->ray, i);
    }
}
