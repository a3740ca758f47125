/* demo_scene.c: a row of shader balls in a small studio: one material model each, on a floor with an engraved grid
 * that rises into a backdrop, under four soft boxes.  Everything is computed here; a ball has radius 1.
 * SPDX-License-Identifier: MIT */
#include "render/demo_scene.h"

#include <stdlib.h>
#include <string.h>

#include "core/error.h"
#include "render/demo_mesh.h"
#include "render/geometry.h"

#define COUNT(array) (sizeof(array)/sizeof *(array))

/* ---- What stands where --------------------------------------------------------------------------- */

/* A shader ball: a shell with a round opening, a core inside it, a foot below it. */
typedef struct ball {
    const char *name, *spec; /* the shell's material */
    float x, z;              /* where it stands */
    float yaw;               /* to which side of +z the opening looks [turns], positive to +x */
    const char *core;        /* the core's material, from `looks` */
} ball;

/* Light reaches what is inside or behind glass only by scattered rays that chance upon a soft box.  So the glass
 * stands last, where its noisy shadow leaves the picture, and has a polished core, which mirrors the light that a
 * matt one would have to find. */
static const ball balls[] = {
    {"plastic", "beckmann alpha=.12 ior=1.5 kd=.015,.11,.30", -4.15f, -1.7f, .07f, "ivory"},
    {"brushed-steel", "ggx alpha_x=.09 alpha_y=.38 ks=.62,.61,.59", -2.15f, 0, .035f, "ivory"},
    {"gold", "ggx alpha=.13 ks=.96,.68,.30", 0, 1.3f, 0, "ivory"},
    {"lacquer", "ggx alpha=.03 ior=1.55 kd=.42,.018,.022", 2.15f, 0, -.035f, "ivory"},
    {"glass", "glass ior=1.5", 4.15f, -1.7f, -.07f, "bronze"},
};

/* Other materials. */
typedef struct look {
    const char *name, *spec;
} look;

static const look looks[] = {
    {"ivory", "lambert kd=.72,.68,.60"},
    {"bronze", "ggx alpha=.1 ks=.86,.55,.26"},
    {"foot", "ggx alpha=.25 ior=1.5 kd=.035,.036,.04"},
    {"clay", "lambert kd=.55,.24,.14"},
    {"jade", "phong exponent=400 ior=1.5 kd=.06,.30,.16"},
    {"copper", "metallic_roughness base_color=.95,.60,.46 metallic=1 roughness=.42"},
    {"mirror", "ggx alpha=.003 ks=.93,.93,.92"},
    {"slate", "beckmann alpha=.35 ks=.2,.22,.26 kd=.03,.035,.045"},
    {"cream", "metallic_roughness base_color=.80,.72,.55 metallic=0 roughness=.3"},
};

/* A plain sphere on the floor. */
typedef struct bead {
    const char *look;
    float x, z, radius;
} bead;

static const bead beads[] = {
    {"clay", -3.05f, 1.15f, .42f}, {"jade", -1.95f, 2.0f, .36f}, {"mirror", -1.0f, 2.75f, .30f},
    {"copper", 1.0f, 2.75f, .30f}, {"cream", 1.95f, 2.0f, .36f}, {"slate", 3.05f, 1.15f, .42f},
};

/* A rectangle that shines towards a point.  All are large and of low radiance: what a path that finds one by chance
 * brings too much, and so the noise, grows with the radiance. */
typedef struct soft_box {
    const char *name;
    float center[3], target[3];
    float half_width, half_height;
    float radiance[3];
} soft_box;

static const soft_box soft_boxes[] = {
    {"key light", {-7.5f, 7, 7}, {0, .5f, 0}, 4.4f, 4, {7.2f, 7, 6.7f}},
    {"fill light", {9, 3.8f, 5}, {0, 1, 0}, 1.4f, 3.2f, {3.6f, 4.2f, 5.2f}},
    {"top light", {0, 7.5f, -.8f}, {0, 0, .4f}, 5.5f, 2.2f, {4.5f, 4.5f, 4.5f}},
    {"rim light", {-9.5f, 4, -4}, {0, 1, 0}, 2, 2.4f, {9, 5.4f, 2.8f}},
};

/* The shell, and its opening around the axis [turns of the outline]. */
#define OUTER_RADIUS 1.0f
#define INNER_RADIUS 0.9f
#define OPENING 0.1f
#define CORE_RADIUS 0.6f
#define SHELL_HEIGHT 1.19f /* of its centre above the floor, so that it sits in the foot */
#define SHELL_TILT 0.13f   /* of the opening's axis towards the viewer [turns] */

enum { SHELL_SIDES = 144, FOOT_SIDES = 96 };

/* The floor's picture, which darkens lines and polishes every second tile: FLOOR_TILES squares on a side. */
enum { FLOOR_PIXELS = 2048, FLOOR_TILES = 40 };
#define FLOOR_SIZE 40.0f

/* ---- Materials ----------------------------------------------------------------------------------- */

static facet_status no_memory(facet_error *why, const char *what)
{
    return facet_error_set(why, FACET_NO_MEMORY, what, "no memory for this part of the demo scene");
}

static facet_status add_bsdf(scene *s, const char *name, const char *spec, size_t *index, facet_error *why)
{
    facet_material parsed;
    facet_bsdf bsdf;
    facet_status status = facet_material_parse(spec, &parsed, why);
    if (!status) status = facet_bsdf_prepare(&parsed, &bsdf, why);
    if (status) return status;
    material m;
    if (material_default(name, &m)) return no_memory(why, name);
    m.kind = SURFACE_BSDF;
    m.bsdf = bsdf;
    if (!scene_add_material(s, &m, index)) return FACET_OK;
    material_destroy(&m);
    return no_memory(why, name);
}

/* ---- Meshes -------------------------------------------------------------------------------------- */

/* Adds the mesh, which becomes the scene's or is destroyed, and one instance of it. */
static facet_status place_mesh(scene *s, mesh *m, const float to_world[3][4], const char *name, facet_error *why)
{
    instance in;
    if (scene_add_mesh(s, m, &in.mesh)) {
        mesh_destroy(m);
        return no_memory(why, name);
    }
    memcpy(in.to_world, to_world, sizeof in.to_world);
    return scene_add_instance(s, &in, NULL) ? no_memory(why, name) : FACET_OK;
}

static const float identity[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

static facet_status make_shell(size_t i_material, mesh *m)
{
    outline o = {0};
    const float rim = 0.25f - OPENING;
    const real2 d = kcossin_turn(rim);
    const float middle = 0.5f*(OUTER_RADIUS + INNER_RADIUS);
    const grooved_arc a = {.radius = OUTER_RADIUS,
                           .from = -0.25f,
                           .to = rim,
                           .groove_from = .028f,
                           .groove_to = .062f,
                           .wall = .008f,
                           .depth = .045f,
                           .n_steps = 110,
                           .n_wall_steps = 10};
    outline_grooved_arc(&o, &a);
    outline_arc(&o, middle*d.x, middle*d.y, 0.5f*(OUTER_RADIUS - INNER_RADIUS), rim, rim + 0.5f, 20);
    outline_arc(&o, 0, 0, INNER_RADIUS, rim, -0.25f, 90);
    return mesh_turn(&o, SHELL_SIDES, i_material, m);
}

static facet_status make_foot(size_t i_material, mesh *m)
{
    outline o = {0};
    outline_line(&o, 0, 0, .58f, 0, 4);
    outline_arc(&o, .58f, .04f, .04f, -0.25f, 0.25f, 16);
    outline_arc(&o, .58f, .26f, .18f, -0.25f, -0.5f, 24);
    outline_line(&o, .40f, .26f, .40f, .285f, 1);
    outline_line(&o, .40f, .285f, 0, .285f, 4);
    return mesh_turn(&o, FOOT_SIDES, i_material, m);
}

static facet_status add_ball(scene *s, const ball *b, size_t foot_mesh, facet_error *why)
{
    size_t i_material;
    mesh m;
    const facet_status status = add_bsdf(s, b->name, b->spec, &i_material, why);
    if (status) return status;
    if (make_shell(i_material, &m)) return no_memory(why, b->name);
    const real2 tilt = kcossin_turn(SHELL_TILT), yaw = kcossin_turn(b->yaw);
    const float shell[3][4] = {{yaw.x, yaw.y*tilt.y, yaw.y*tilt.x, b->x},
                               {0, tilt.x, -tilt.y, SHELL_HEIGHT},
                               {-yaw.y, yaw.x*tilt.y, yaw.x*tilt.x, b->z}};
    if (place_mesh(s, &m, shell, b->name, why)) return FACET_NO_MEMORY;
    const instance foot = {.mesh = foot_mesh, .to_world = {{1, 0, 0, b->x}, {0, 1, 0, 0}, {0, 0, 1, b->z}}};
    const sphere core = {
        .center = {b->x, SHELL_HEIGHT, b->z}, .radius = CORE_RADIUS, .material = scene_find_material(s, b->core)};
    if (scene_add_instance(s, &foot, NULL) || scene_add_sphere(s, &core, NULL)) return no_memory(why, b->name);
    return FACET_OK;
}

static facet_status add_things(scene *s, facet_error *why)
{
    for (size_t i = 0; i < COUNT(looks); i++) {
        const facet_status status = add_bsdf(s, looks[i].name, looks[i].spec, NULL, why);
        if (status) return status;
    }
    mesh foot;
    size_t foot_mesh;
    if (make_foot(scene_find_material(s, "foot"), &foot)) return no_memory(why, "foot");
    if (scene_add_mesh(s, &foot, &foot_mesh)) {
        mesh_destroy(&foot);
        return no_memory(why, "foot");
    }
    for (size_t i = 0; i < COUNT(balls); i++) {
        const facet_status status = add_ball(s, &balls[i], foot_mesh, why);
        if (status) return status;
    }
    for (size_t i = 0; i < COUNT(beads); i++) {
        const bead *b = &beads[i];
        const sphere shape = {
            .center = {b->x, b->radius, b->z}, .radius = b->radius, .material = scene_find_material(s, b->look)};
        if (scene_add_sphere(s, &shape, NULL)) return no_memory(why, b->look);
    }
    return FACET_OK;
}

/* ---- Studio -------------------------------------------------------------------------------------- */

/* One pixel of the floor's picture, as reflectance relative to the floor's; x and z from the centre. */
static float floor_value(float x, float z)
{
    const float tile = FLOOR_SIZE/FLOOR_TILES;
    const float u = x/tile, v = z/tile;
    const float to_line = tile*kmin(kabs(u - kround(u)), kabs(v - kround(v)));
    const bool is_odd = ((int)kfloor(u) + (int)kfloor(v)) & 1;
    /* The pattern fades into the backdrop. */
    const float fade = 1 - ksaturate((ksqrt(x*x + z*z) - 4)/4);
    const float line = ksaturate(1 - (to_line - .005f)/.02f);
    return 1 - fade*((is_odd ? .12f : 0) + .3f*line*(is_odd ? .8f : 1));
}

static facet_status add_floor_texture(scene *s, size_t *index, facet_error *why)
{
    uint8_t *pixels = malloc((size_t)FLOOR_PIXELS*FLOOR_PIXELS);
    if (!pixels) return no_memory(why, "floor");
    const float step = FLOOR_SIZE/FLOOR_PIXELS;
    for (size_t i = 0; i < FLOOR_PIXELS; i++)
        for (size_t j = 0; j < FLOOR_PIXELS; j++) {
            const float value = floor_value(((float)j + .5f)*step - FLOOR_SIZE/2,
                                            ((float)i + .5f)*step - FLOOR_SIZE/2);
            pixels[i*FLOOR_PIXELS + j] = (uint8_t)(255*value + .5f);
        }
    image picture = {
        .width = FLOOR_PIXELS, .height = FLOOR_PIXELS, .n_channels = 1, .type = PIXEL_U8, .pixels = pixels};
    texture t = {.wrap_u = WRAP_CLAMP, .wrap_v = WRAP_CLAMP};
    if (scene_add_image(s, &picture, &t.image)) {
        image_destroy(&picture);
        return no_memory(why, "floor");
    }
    return scene_add_texture(s, &t, index) ? no_memory(why, "floor") : FACET_OK;
}

static facet_status add_backdrop(scene *s, facet_error *why)
{
    static const float color[3] = {.27f, .27f, .275f};
    size_t picture, index;
    const facet_status status = add_floor_texture(s, &picture, why);
    if (status) return status;
    material floor;
    if (material_default("floor", &floor)) return no_memory(why, "floor");
    memcpy(floor.base_color, color, sizeof color);
    floor.metallic = 0;
    floor.roughness = .45f;
    floor.base_color_texture.texture = picture;
    floor.metallic_roughness_texture.texture = picture;
    if (scene_add_material(s, &floor, &index)) {
        material_destroy(&floor);
        return no_memory(why, "floor");
    }
    outline o = {0};
    outline_line(&o, 9, 0, -4.5f, 0, 1);
    outline_arc(&o, -4.5f, 4.5f, 4.5f, -0.25f, -0.5f, 48);
    outline_line(&o, -9, 4.5f, -9, 7, 1);
    mesh m;
    if (mesh_sweep(&o, 11, FLOOR_SIZE, index, &m)) return no_memory(why, "floor");
    return place_mesh(s, &m, identity, "floor", why);
}

static facet_status add_soft_box(scene *s, const soft_box *box, facet_error *why)
{
    material glow;
    size_t index;
    if (material_default(box->name, &glow)) return no_memory(why, box->name);
    memcpy(glow.emission, box->radiance, sizeof glow.emission);
    for (int k = 0; k < 3; k++) glow.base_color[k] = 0;
    glow.metallic = 0;
    if (scene_add_material(s, &glow, &index)) {
        material_destroy(&glow);
        return no_memory(why, box->name);
    }
    const real3 n = normalize3(sub3(vector_of(box->target), vector_of(box->center)));
    const frame f = frame_around(n, make3(n.z, 0, -n.x), 1);
    const float u[3] = {box->half_width*f.t.x, box->half_width*f.t.y, box->half_width*f.t.z};
    const float v[3] = {box->half_height*f.b.x, box->half_height*f.b.y, box->half_height*f.b.z};
    mesh m;
    if (mesh_rectangle(box->center, u, v, index, &m)) return no_memory(why, box->name);
    return place_mesh(s, &m, identity, box->name, why);
}

/* A dim sky: dark below, warm at the horizon, cool above. */
static facet_status add_sky(scene *s, facet_error *why)
{
    enum { WIDTH = 64, HEIGHT = 32 };
    static const float below[3] = {.02f, .018f, .016f}, horizon[3] = {.20f, .19f, .18f}, zenith[3] = {.04f, .05f, .07f};
    float(*pixels)[3] = malloc(sizeof *pixels*WIDTH*HEIGHT);
    if (!pixels) return no_memory(why, "environment");
    for (size_t i = 0; i < HEIGHT; i++) {
        const float height = kcos(PI*((float)i + .5f)/HEIGHT);
        const float share = kexp(height > 0 ? -3*height : 8*height);
        for (size_t j = 0; j < WIDTH; j++)
            for (int k = 0; k < 3; k++)
                pixels[i*WIDTH + j][k] = mix(height > 0 ? zenith[k] : below[k], horizon[k], share);
    }
    s->environment.map = (image){
        .width = WIDTH, .height = HEIGHT, .n_channels = 3, .type = PIXEL_F32, .pixels = pixels};
    for (int k = 0; k < 3; k++) s->environment.scale[k] = 1;
    return FACET_OK;
}

static facet_status add_camera(scene *s, facet_error *why)
{
    static const float eye[3] = {0, 4.9f, 20}, target[3] = {0, 1.0f, 0};
    static const char name[] = "studio";
    const real3 back = normalize3(sub3(vector_of(eye), vector_of(target)));
    const real3 side = normalize3(make3(back.z, 0, -back.x)), up = cross3(back, side);
    camera c = {
        .to_world = {{side.x, up.x, back.x, eye[0]}, {side.y, up.y, back.y, eye[1]}, {side.z, up.z, back.z, eye[2]}},
        .yfov = .278f,
        .aspect = 16/9.0f};
    c.name = malloc(sizeof name);
    if (!c.name) return no_memory(why, name);
    memcpy(c.name, name, sizeof name);
    if (!scene_add_camera(s, &c, NULL)) return FACET_OK;
    free(c.name);
    return no_memory(why, name);
}

/* Shapes, places, materials, lights and view into the scene's hash, so that pictures of another version are told
 * apart. */
static void hash_content(scene *s)
{
    for (size_t i = 0; i < s->n_meshes; i++) {
        scene_hash_bytes(s, s->meshes[i].positions, s->meshes[i].n_vertices*sizeof s->meshes[i].positions[0]);
        scene_hash_bytes(s, s->meshes[i].triangles, s->meshes[i].n_triangles*sizeof s->meshes[i].triangles[0]);
    }
    for (size_t i = 0; i < s->n_instances; i++)
        scene_hash_bytes(s, s->instances[i].to_world, sizeof s->instances[i].to_world);
    for (size_t i = 0; i < s->n_spheres; i++) {
        scene_hash_bytes(s, s->spheres[i].center, sizeof s->spheres[i].center);
        scene_hash_bytes(s, &s->spheres[i].radius, sizeof s->spheres[i].radius);
    }
    for (size_t i = 0; i < s->n_materials; i++) {
        scene_hash_bytes(s, &s->materials[i].bsdf, sizeof s->materials[i].bsdf);
        scene_hash_bytes(s, s->materials[i].emission, sizeof s->materials[i].emission);
    }
    const image *const sky = &s->environment.map;
    scene_hash_bytes(s, sky->pixels, sky->width*sky->height*sky->n_channels*sizeof(float));
    scene_hash_bytes(s, s->cameras[0].to_world, sizeof s->cameras[0].to_world);
}

static facet_status fill(scene *s, facet_error *why)
{
    facet_status status = add_things(s, why);
    if (!status) status = add_backdrop(s, why);
    for (size_t i = 0; i < COUNT(soft_boxes) && !status; i++) status = add_soft_box(s, &soft_boxes[i], why);
    if (!status) status = add_sky(s, why);
    if (!status) status = add_camera(s, why);
    if (!status) hash_content(s);
    return status;
}

facet_status demo_scene_create(scene **result, facet_error *why)
{
    scene *s = scene_create();
    if (!s) return no_memory(why, "");
    const facet_status status = fill(s, why);
    if (status) scene_destroy(s);
    else *result = s;
    return status;
}
