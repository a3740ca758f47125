/* stage_generate.c: camera rays.
 * SPDX-License-Identifier: MIT */
#include "render/stages.h"

#include <math.h>

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
            batch->x[n] = (float)px;
            batch->y[n] = (float)py;
        }
    list->n = n;
    if (c->keeps_features) feature_start(batch, n);
    const render_loops *loops = render_loops_chosen();
    uint32_t *const u[3] = {batch->chance[0], batch->chance[1], batch->chance[2]};
    loops->points(&c->sampler, n, list->pixel, list->index, GROUP_CAMERA, u);
    const float extent = c->camera->is_orthographic ? c->camera->ymag : tanf(0.5f*c->camera->yfov);
    loops->view(c->camera, extent, (float)c->settings->width, (float)c->settings->height, n, batch->x, batch->y, u,
                &list->ray);
}
