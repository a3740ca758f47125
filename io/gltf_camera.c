/* gltf_camera.c: cameras and punctual lights.  [gltf, sections 3.10, 5.12 to 5.14]; KHR_lights_punctual.
 *
 * Both look and shine along the node's -z.  Units are radiometric: candela are read as W/sr, lux as W/m^2.
 * SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/gltf_internal.h"

static const double PI = 3.14159265358979323846;

/* Scales v to unit length; false if it has no direction. */
static bool normalize(double v[3])
{
    const double length = sqrt(v[0]*v[0] + v[1]*v[1] + v[2]*v[2]);
    if (!(length > 0) || !isfinite(length)) return false;
    for (int k = 0; k < 3; k++) v[k] /= length;
    return true;
}

/* A direction at right angles to the unit vector z, nearest to y; false if y is along z.  Below 1e-6 the
 * rest is rounding noise of single precision input. */
static bool reject(const double z[3], double y[3])
{
    if (!normalize(y)) return false;
    const double along = y[0]*z[0] + y[1]*z[1] + y[2]*z[2];
    for (int k = 0; k < 3; k++) y[k] -= along*z[k];
    return y[0]*y[0] + y[1]*y[1] + y[2]*y[2] > 1e-12 && normalize(y);
}

/* The node's axes made orthonormal and right-handed: z keeps its direction, y stays next to it.  An axis
 * that a zero scale has collapsed becomes any that fits. */
static void orthonormal_axes(gltf_matrix world, double x[3], double y[3], double z[3])
{
    for (int k = 0; k < 3; k++) z[k] = world[k][2];
    if (!normalize(z)) {
        z[0] = z[1] = 0;
        z[2] = 1;
    }
    const double candidates[3][3] = {{world[0][1], world[1][1], world[2][1]}, {0, 1, 0}, {1, 0, 0}};
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) y[k] = candidates[i][k];
        if (reject(z, y)) break;
    }
    for (int k = 0; k < 3; k++) x[k] = y[(k + 1)%3]*z[(k + 2)%3] - y[(k + 2)%3]*z[(k + 1)%3];
}

/* ---- Cameras -------------------------------------------------------------------------------------- */

static bool read_perspective(const json_place *place, camera *c)
{
    json_place perspective;
    if (!json_read_object(place, "perspective", &perspective) || !json_want_present(&perspective) ||
        !json_read_float(&perspective, "yfov", 0, PI, &c->yfov) ||
        !json_read_float(&perspective, "aspectRatio", 1/GLTF_ASPECT_CAP, GLTF_ASPECT_CAP, &c->aspect))
        return false;
    const json_place yfov = json_member(&perspective, "yfov");
    if (!json_want_present(&yfov)) return false;
    if (!(c->yfov > 0 && c->yfov < (float)PI))
        return json_fail(&yfov, FACET_BAD_VALUE, "is %.9g; must be above 0 and below pi", (double)c->yfov);
    return true;
}

/* Magnifications may be negative, which mirrors the picture in some viewers; the size alone counts here. */
static bool read_orthographic(gltf *g, const json_place *place, camera *c)
{
    static const char *const keys[] = {"xmag", "ymag"};
    json_place orthographic;
    float mag[2] = {0, 0};
    c->is_orthographic = true;
    if (!json_read_object(place, "orthographic", &orthographic) || !json_want_present(&orthographic)) return false;
    for (int k = 0; k < 2; k++) {
        const json_place mag_place = json_member(&orthographic, keys[k]);
        if (!json_want_present(&mag_place)) return false;
        if (!json_read_float(&orthographic, keys[k], -GLTF_EXTENT_CAP, GLTF_EXTENT_CAP, &mag[k])) return false;
        if (mag[k] == 0) return json_fail(&mag_place, FACET_BAD_VALUE, "is 0; must be above 0");
        if (mag[k] < 0) gltf_warn(g, &mag_place, "is negative: its size is used");
        mag[k] = fabsf(mag[k]);
    }
    c->ymag = mag[1];
    c->aspect = mag[0]/mag[1];
    if (!(c->aspect >= 1/GLTF_ASPECT_CAP && c->aspect <= GLTF_ASPECT_CAP))
        return json_fail(&orthographic, FACET_BAD_VALUE, "xmag/ymag is %g; must be from %g to %g", (double)c->aspect,
                         1/GLTF_ASPECT_CAP, GLTF_ASPECT_CAP);
    return true;
}

/* The camera's own name, else the node's, else a number; numbered further if that is taken already. */
static bool name_camera(gltf *g, const json_place *node, const json_place *place, size_t number, camera *c)
{
    const char *own = "", *nodes = "";
    char text[200];
    if (!json_read_string(place, "name", &own) || !json_read_string(node, "name", &nodes)) return false;
    const char *name = own[0] && scene_find_camera(g->scene, own) == NONE ? own : nodes;
    if (name[0] == 0 || scene_find_camera(g->scene, name) != NONE) {
        const char *const stem = own[0] ? own : "camera";
        if (own[0]) snprintf(text, sizeof text, "%.160s#%zu", stem, g->scene->n_cameras);
        else snprintf(text, sizeof text, "%s%zu", stem, number);
        if (scene_find_camera(g->scene, text) != NONE)
            snprintf(text, sizeof text, "%.120s#%zu", stem, g->scene->n_cameras);
        name = text;
    }
    c->name = malloc(strlen(name) + 1);
    if (!c->name) return gltf_no_memory(place);
    memcpy(c->name, name, strlen(name) + 1);
    return true;
}

bool gltf_add_camera(gltf *g, const json_place *node, size_t camera_number, gltf_matrix world)
{
    const json_place place = json_element(&g->cameras, camera_number), type_place = json_member(&place, "type");
    const char *type;
    camera c = {0};
    double x[3], y[3], z[3];
    if (!json_want_present(&type_place) || !json_string_here(&type_place, &type)) return false;
    if (strcmp(type, "perspective") == 0) {
        if (!read_perspective(&place, &c)) return false;
    } else if (strcmp(type, "orthographic") == 0) {
        if (!read_orthographic(g, &place, &c)) return false;
    } else {
        return json_fail(&type_place, FACET_BAD_VALUE, "is \"%.20s\"; must be perspective or orthographic", type);
    }
    orthonormal_axes(world, x, y, z);
    for (int r = 0; r < 3; r++) {
        const double row[4] = {x[r], y[r], z[r], world[r][3]};
        for (int k = 0; k < 4; k++) c.to_world[r][k] = (float)row[k];
    }
    if (g->scene->n_cameras >= GLTF_CAMERA_CAP)
        return json_fail(node, FACET_UNSUPPORTED, "brings the cameras above %zu", GLTF_CAMERA_CAP);
    if (!name_camera(g, node, &place, camera_number, &c)) return false;
    if (!scene_add_camera(g->scene, &c, NULL)) return true;
    free(c.name);
    return gltf_no_memory(node);
}

/* ---- Lights --------------------------------------------------------------------------------------- */

static bool read_kind(const json_place *place, light_kind *kind)
{
    const json_place type_place = json_member(place, "type");
    const char *type;
    if (!json_want_present(&type_place) || !json_string_here(&type_place, &type)) return false;
    if (strcmp(type, "point") == 0) *kind = LIGHT_POINT;
    else if (strcmp(type, "spot") == 0) *kind = LIGHT_SPOT;
    else if (strcmp(type, "directional") == 0) *kind = LIGHT_DIRECTIONAL;
    else return json_fail(&type_place, FACET_BAD_VALUE, "is \"%.20s\"; must be point, spot or directional", type);
    return true;
}

static bool read_cone(const json_place *place, punctual_light *light)
{
    json_place spot;
    double inner = 0, outer = PI/4;
    if (!json_read_object(place, "spot", &spot) || !json_want_present(&spot) ||
        !json_read_number(&spot, "innerConeAngle", 0, PI/2, &inner) ||
        /* pi/2 as written in single precision is a little above pi/2 */
        !json_read_number(&spot, "outerConeAngle", 0, (double)(float)(PI/2), &outer))
        return false;
    if (!(inner < outer))
        return json_fail(&spot, FACET_BAD_VALUE, "innerConeAngle %g must be below outerConeAngle %g", inner, outer);
    light->cos_inner = (float)cos(inner);
    light->cos_outer = outer < PI/2 ? (float)cos(outer) : 0.0f;
    return true;
}

bool gltf_add_light(gltf *g, const json_place *node, gltf_matrix world)
{
    gltf_extension e;
    size_t number = NONE;
    if (!gltf_read_extension(node, "KHR_lights_punctual", &e)) return false;
    if (!e.body.value) return true;
    const json_place index_place = json_member(&e.body, "light");
    if (!json_want_present(&index_place) || !json_index_here(&index_place, json_count(&g->lights), "lights", &number))
        return false;
    const json_place place = json_element(&g->lights, number);
    punctual_light light = {0};
    float color[3] = {1, 1, 1}, intensity = 1, range = 0;
    if (!json_want_object(&place) || !read_kind(&place, &light.kind) ||
        !json_read_floats(&place, "color", 3, 0, 1, color) ||
        !json_read_float(&place, "intensity", 0, GLTF_RADIANCE_CAP, &intensity) ||
        !json_read_float(&place, "range", 0, FLT_MAX, &range) ||
        (light.kind == LIGHT_SPOT && !read_cone(&place, &light)))
        return false;
    if (json_member(&place, "range").value && light.kind != LIGHT_DIRECTIONAL)
        gltf_warn(g, &place, "range %g is ignored: light falls off with the square of the distance alone",
                  (double)range);
    double x[3], y[3], z[3];
    orthonormal_axes(world, x, y, z);
    for (int k = 0; k < 3; k++) {
        light.position[k] = (float)world[k][3];
        light.direction[k] = (float)-z[k];
        light.intensity[k] = color[k]*intensity;
    }
    if (g->scene->n_lights >= GLTF_INSTANCE_CAP)
        return json_fail(node, FACET_UNSUPPORTED, "brings the lights above %zu", GLTF_INSTANCE_CAP);
    return !scene_add_light(g->scene, &light, NULL) || gltf_no_memory(node);
}
