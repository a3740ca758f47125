/* camera.c: a camera's matrices, for other programs.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "render/geometry.h"
#include "render/render.h"

/* c = a b, 4x4, row vectors: p' = p M. */
static void multiply(const float a[16], const float b[16], float c[16])
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            double sum = 0;
            for (int k = 0; k < 4; k++) sum += (double)a[4*i + k]*(double)b[4*k + j];
            c[4*i + j] = (float)sum;
        }
}

void camera_matrices(const camera *c, size_t width, size_t height, float world_to_camera[16], float world_to_ndc[16])
{
    /* The inverse of a rigid motion: the transpose, and the origin seen from the camera. */
    const real3 origin = map_column(c->to_world, 3);
    for (int j = 0; j < 3; j++) {
        const real3 axis = map_column(c->to_world, j);
        world_to_camera[j] = axis.x;
        world_to_camera[4 + j] = axis.y;
        world_to_camera[8 + j] = axis.z;
        world_to_camera[12 + j] = -dot3(origin, axis);
    }
    for (int i = 0; i < 4; i++) world_to_camera[4*i + 3] = i == 3 ? 1.0f : 0.0f;
    const float aspect = (float)width/(float)height;
    float projection[16] = {0};
    if (c->is_orthographic) {
        projection[0] = 1/(aspect*c->ymag);
        projection[5] = 1/c->ymag;
        projection[10] = -1;
        projection[15] = 1;
    } else {
        const float tan = tanf(0.5f*c->yfov);
        projection[0] = 1/(aspect*tan);
        projection[5] = 1/tan;
        projection[10] = -1;
        projection[11] = -1; /* w = -z */
    }
    multiply(world_to_camera, projection, world_to_ndc);
}
