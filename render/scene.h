/* scene.h: what there is to render, as plain data: meshes, instances, spheres, materials, textures,
 * lights, cameras, environment.  Filled by io/gltf.c or by demo_scene.c, read by the rest of render/.
 *
 * Right-handed, y up, metres, as glTF 2.0.  Every array is owned by the scene; indices refer to the
 * scene's own arrays, NONE means absent.  Nothing here is checked again later: whoever fills a scene
 * guarantees that every index is in range and every number finite.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "facet/facet.h"
#include "render/image.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NONE ((size_t)-1)

typedef enum texture_wrap { WRAP_REPEAT, WRAP_MIRROR, WRAP_CLAMP } texture_wrap;

/* A picture with the way to look it up.  Texel centres lie at (i + 1/2)/n; v = 0 is the top row. */
typedef struct texture {
    size_t image; /* index into scene.images */
    texture_wrap wrap_u, wrap_v;
    bool is_nearest; /* nearest texel instead of bilinear */
    bool is_srgb;    /* RGB (never alpha) is decoded from the sRGB curve; 8 and 16 bit images only */
} texture;

/* A use of a texture: which coordinates, and KHR_texture_transform as uv' = M uv + t. */
typedef struct texture_use {
    size_t texture;  /* index into scene.textures, or NONE */
    unsigned uv_set; /* 0 or 1 */
    float transform[2][3];
} texture_use;

typedef enum surface_kind {
    SURFACE_METALLIC_ROUGHNESS, /* glTF's own, from factors and textures, prepared per point */
    SURFACE_BSDF,               /* any libfacet model, from FACET_materials_bsdf or --material */
    SURFACE_UNLIT               /* KHR_materials_unlit: base colour as radiance towards the camera only */
} surface_kind;

typedef enum alpha_mode { ALPHA_OPAQUE, ALPHA_MASK, ALPHA_BLEND } alpha_mode;

typedef struct material {
    char *name; /* owned; never NULL */
    surface_kind kind;
    facet_bsdf bsdf; /* SURFACE_BSDF */
    /* SURFACE_METALLIC_ROUGHNESS and SURFACE_UNLIT: factors, linear */
    float base_color[4];
    float metallic, roughness; /* perceptual roughness, alpha = roughness^2 */
    float ior;                 /* KHR_materials_ior, 1.5 */
    float specular;            /* KHR_materials_specular: factor, 1 */
    float specular_color[3];   /* and colour factor, 1,1,1 */
    float transmission;        /* KHR_materials_transmission factor, 0; glass when > 0 */
    bool is_thin;              /* transmission without KHR_materials_volume: no refraction */
    float normal_scale;        /* 1 */
    float emission[3];         /* emissiveFactor * emissiveStrength: radiance [W/(m^2 sr)] */
    texture_use base_color_texture, metallic_roughness_texture, normal_texture, emissive_texture;
    alpha_mode alpha;
    float alpha_cutoff;
    bool is_double_sided;
} material;

/* glTF's default material, with the given name (copied).  FACET_NO_MEMORY. */
facet_status material_default(const char *name, material *m);

/* Triangles that share one material.  Arrays but positions and triangles may be NULL. */
typedef struct mesh {
    size_t n_vertices, n_triangles;
    float (*positions)[3];
    float (*normals)[3];  /* unit */
    float (*tangents)[4]; /* unit xyz, handedness w = +-1 */
    float (*uv[2])[2];
    float (*colors)[4]; /* linear RGBA, multiplied into the base colour */
    uint32_t (*triangles)[3];
    size_t material;
} mesh;

typedef struct instance {
    size_t mesh;
    float to_world[3][4]; /* p' = M (p,1); may mirror; singular ones are dropped by the tracer */
} instance;

typedef struct sphere {
    float center[3], radius; /* world space, [m], radius > 0 */
    size_t material;
} sphere;

typedef enum light_kind { LIGHT_POINT, LIGHT_SPOT, LIGHT_DIRECTIONAL } light_kind;

/* KHR_lights_punctual.  Point and spot: intensity [W/sr]; directional: irradiance [W/m^2]. */
typedef struct punctual_light {
    light_kind kind;
    float position[3], direction[3]; /* direction: unit, the way the light shines */
    float intensity[3];
    float cos_inner, cos_outer; /* spot: full inside inner, 0 outside outer */
} punctual_light;

typedef struct camera {
    char *name; /* owned; never NULL */
    bool is_orthographic;
    float to_world[3][4]; /* looks along -z, y up; columns orthonormal */
    float yfov;           /* [rad] */
    float ymag;           /* orthographic: half height [m] */
    float aspect;         /* width/height that the file asks for; 0: any */
} camera;

/* Radiance from infinity.  Latitude-longitude image: u = 0.5 looks to +x, u = 0.75 to +z, v = 0 up;
 * texels are multiplied by `scale`.  Without an image, `scale` is the constant radiance. */
typedef struct environment {
    image map; /* PIXEL_F32 RGB, or empty */
    float scale[3];
} environment;

typedef struct scene {
    image *images;
    size_t n_images;
    texture *textures;
    size_t n_textures;
    material *materials;
    size_t n_materials;
    mesh *meshes;
    size_t n_meshes;
    instance *instances;
    size_t n_instances;
    sphere *spheres;
    size_t n_spheres;
    punctual_light *lights;
    size_t n_lights;
    camera *cameras;
    size_t n_cameras;
    struct environment environment; /* the tag keeps this valid C++ */
    uint64_t hash;                  /* of everything that was read, for provenance */
} scene;

/* Folds bytes into the scene's hash (FNV-1a, 64 bit): a name for the input, not a defence against forgery. */
void scene_hash_bytes(scene *s, const void *bytes, size_t n);

/* An empty scene with a black environment. */
scene *scene_create(void);
void scene_destroy(scene *s);

/* Appends *item, whose owned arrays move into the scene, and stores its index (index may be NULL).
 * On FACET_NO_MEMORY the item still belongs to the caller. */
facet_status scene_add_image(scene *s, const image *item, size_t *index);
facet_status scene_add_texture(scene *s, const texture *item, size_t *index);
facet_status scene_add_material(scene *s, const material *item, size_t *index);
facet_status scene_add_mesh(scene *s, const mesh *item, size_t *index);
facet_status scene_add_instance(scene *s, const instance *item, size_t *index);
facet_status scene_add_sphere(scene *s, const sphere *item, size_t *index);
facet_status scene_add_light(scene *s, const punctual_light *item, size_t *index);
facet_status scene_add_camera(scene *s, const camera *item, size_t *index);

void mesh_destroy(mesh *m);
void material_destroy(material *m);

/* The index of the material or camera called `name`, or NONE. */
size_t scene_find_material(const scene *s, const char *name);
size_t scene_find_camera(const scene *s, const char *name);

/* World-space box around all meshes and spheres; false if the scene has no extent at all. */
bool scene_bounds(const scene *s, float low[3], float high[3]);

/* Adds a camera that sees the whole scene from the front and a little above. */
facet_status scene_add_framing_camera(scene *s, size_t *index);

#ifdef __cplusplus
}
#endif
