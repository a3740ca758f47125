/* gltf_internal.h: what the files of the glTF reader share.  Only io/gltf*.c include it.
 *
 * All state of one reading lives in a `gltf`.  Functions that return bool return false once they have
 * put the first error into gltf.error.  What the file declares (buffers, views, accessors, nodes) is
 * checked as a whole first; buffers, images, materials and meshes are loaded when something in the scene
 * first uses them, so that what nobody uses is never read.
 *
 * [gltf] Khronos Group, glTF 2.0 Specification, 2.0.1; section numbers are its own.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "facet/facet.h"
#include "io/gltf.h"
#include "io/json.h"
#include "render/scene.h"

/* ---- Limits, checked before memory is taken (docs/gltf.md lists them) --------------------------- */

/* JSON text [byte]. */
#define GLTF_JSON_CAP ((size_t)256 << 20)
/* Unless the user says how much memory there is, geometry may take this much, plus so many times the bytes read:
 * accessors can be shared or all zeros, so that a small file can ask for much. */
#define GLTF_GEOMETRY_FLOOR ((size_t)256 << 20)
#define GLTF_GEOMETRY_FACTOR ((size_t)64)
/* Mesh instances, spheres and lights, each. */
#define GLTF_INSTANCE_CAP ((size_t)1 << 22)
/* Cameras: each new name is compared with all. */
#define GLTF_CAMERA_CAP ((size_t)1 << 12)
/* Warnings passed on. */
#define GLTF_WARNING_CAP ((size_t)100)
/* Triangles over all meshes, instances not counted. */
#define GLTF_TRIANGLE_CAP ((size_t)1 << 29)
/* World coordinates beyond this are refused [m]: products of two still fit single precision. */
#define GLTF_EXTENT_CAP 1e18
/* Radiance and intensity, likewise; no light in the universe comes near. */
#define GLTF_RADIANCE_CAP 1e18
/* Texture coordinates are clipped to this: a float above has no fraction left to look up. */
#define GLTF_UV_CAP 16777216.0f
/* A camera's width/height, at most; its inverse is the least. */
#define GLTF_ASPECT_CAP 1e6

/* ---- Types --------------------------------------------------------------------------------------- */

/* Affine: p' = M (p, 1). */
typedef double gltf_matrix[3][4];

typedef struct gltf_buffer {
    size_t size;                /* byteLength */
    const unsigned char *bytes; /* NULL until it is used */
    unsigned char *owned;       /* what to free: a file or decoded text */
} gltf_buffer;

typedef struct gltf_view {
    size_t buffer, offset, size;
    size_t stride; /* 0: tight */
} gltf_view;

/* glTF's component types; others are refused. */
enum { GLTF_I8 = 5120, GLTF_U8 = 5121, GLTF_I16 = 5122, GLTF_U16 = 5123, GLTF_U32 = 5125, GLTF_F32 = 5126 };

typedef struct gltf_accessor {
    size_t view, offset, count; /* view NONE: zeros */
    size_t size, tight, stride; /* bytes of an element, from one to the next if packed, and as they are */
    size_t n_components;        /* 1 scalar, 2..4 vectors and MAT2, 9 MAT3, 16 MAT4 */
    const char *type;           /* "VEC3" */
    int component;
    bool is_normalized;
    size_t n_sparse; /* 0: not sparse */
    size_t sparse_index_view, sparse_index_offset, sparse_value_view, sparse_value_offset;
    int sparse_index_component;
} gltf_accessor;

typedef struct gltf_node {
    size_t parent; /* NONE: a root */
    gltf_matrix world;
    bool is_placed; /* its world matrix is known */
    bool is_listed; /* as a root of the scene */
} gltf_node;

/* The scene meshes made from those of a glTF mesh's primitives that have something to show. */
typedef struct gltf_part {
    size_t mesh;
    float extent; /* the largest coordinate, without sign */
} gltf_part;
typedef struct gltf_mesh {
    gltf_part *parts;
    size_t n_parts;
    bool is_built;
} gltf_mesh;

/* Something about materials that will look different, reported once for all of them. */
typedef struct gltf_note {
    char what[96];
    const char *effect;
    size_t first, count;
} gltf_note;

enum { GLTF_MAX_NOTES = 40 };

typedef struct gltf {
    facet_error error;
    gltf_warning *warning;
    gltf_file *on_file;
    void *user;
    size_t n_warnings;
    bool allows_outside, has_own_cap; /* has_own_cap: the user chose most_memory */
    size_t most_memory;
    const char *path;
    size_t folder_length; /* path[0..folder_length) is the folder with its slash */

    unsigned char *file;      /* the main file */
    const unsigned char *bin; /* the GLB's binary chunk, or NULL */
    size_t bin_size;
    size_t memory, input_size, geometry_size, n_triangles; /* running totals against the caps */

    json_place root, buffers, views, accessors, images, samplers, textures, materials, meshes, nodes, skins, cameras,
        scenes;
    json_place root_extensions, lights_extension, lights;

    gltf_buffer *buffer;
    gltf_view *view;
    gltf_accessor *accessor;
    size_t n_buffers, n_views, n_accessors, n_nodes, n_meshes;
    gltf_node *node;
    gltf_mesh *mesh;
    gltf_mesh deformed;            /* the latest mesh that is not shared */
    size_t *image_index;           /* glTF image to scene image, NONE until used */
    size_t (*texture_index)[2];    /* glTF texture to scene texture, [1] with sRGB decoding */
    size_t *material_index;        /* glTF material to scene material */
    size_t default_material_index; /* for primitives without one */

    gltf_note notes[GLTF_MAX_NOTES];
    size_t n_notes;
    struct scene *scene;
} gltf;

/* An extension object with the places that lead to it. */
typedef struct gltf_extension {
    json_place list, body; /* body absent: the object does not use the extension */
} gltf_extension;

/* ---- gltf.c --------------------------------------------------------------------------------------- */

void gltf_warn(gltf *g, const json_place *place, const char *format, ...) __attribute__((format(printf, 3, 4)));
/* Reads object.extensions.NAME; false if it is there and not an object.  e stays where it is while used. */
bool gltf_read_extension(const json_place *object, const char *name, gltf_extension *e);
bool gltf_no_memory(const json_place *place);
/* Counts count*size bytes against most_memory, before they are taken. */
bool gltf_claim(gltf *g, const json_place *place, size_t count, size_t size);
/* What is left of most_memory. */
size_t gltf_memory_left(const gltf *g);
/* Folds the bytes of a file into the scene's hash and counts them. */
bool gltf_take_input(gltf *g, const json_place *place, const unsigned char *bytes, size_t size);
/* Counts work on geometry, in bytes, against its cap. */
bool gltf_charge(gltf *g, const json_place *place, size_t count, size_t size);
/* Zeroed memory, charged; NULL after an error. */
void *gltf_alloc(gltf *g, const json_place *place, size_t count, size_t size);

/* ---- gltf_container.c: the GLB container ---------------------------------------------------------- */

bool gltf_is_glb(const unsigned char *bytes, size_t size);
/* Finds the JSON chunk and sets g->bin. */
bool gltf_open_glb(gltf *g, const unsigned char *bytes, size_t size, const unsigned char **json, size_t *json_size);

/* ---- gltf_uri.c: files and data URIs -------------------------------------------------------------- */

/* Reads what the URI string at `place` names.  *bytes is the caller's to free, one 0 byte follows it. */
bool gltf_read_uri(gltf *g, const json_place *place, unsigned char **bytes, size_t *size);

/* ---- gltf_buffer.c, gltf_accessor.c: binary data -------------------------------------------------- */

bool gltf_declare_buffers(gltf *g);
/* The bytes of a view, loading its buffer at first use. */
bool gltf_view_bytes(gltf *g, size_t view, const unsigned char **bytes);

bool gltf_declare_accessors(gltf *g);
/* Reads place's value as an accessor index and gives the accessor.  Absent is an error. */
bool gltf_find_accessor(gltf *g, const json_place *place, const gltf_accessor **a);
/* The elements as floats, normalised and sparse-substituted, n_components each; not finite is an error. */
bool gltf_read_floats(gltf *g, const json_place *place, const gltf_accessor *a, float **values);
/* The elements as unsigned integers, n_components each. */
bool gltf_read_uints(gltf *g, const json_place *place, const gltf_accessor *a, uint32_t **values);
/* As above, without the rule that every number is finite. */
bool gltf_read_any_floats(gltf *g, const json_place *place, const gltf_accessor *a, float **values);
/* The accessor is one of the listed types (names separated by blanks) and components; else an error. */
bool gltf_want_format(const json_place *place, const gltf_accessor *a, const char *types, unsigned components);
/* Bits for gltf_want_format; the normalised ones imply the flag is set, the plain ones that it is not. */
enum {
    GLTF_WANT_F32 = 1,
    GLTF_WANT_U8 = 2,
    GLTF_WANT_U16 = 4,
    GLTF_WANT_U32 = 8,
    GLTF_WANT_I8 = 16,
    GLTF_WANT_I16 = 32,
    GLTF_WANT_NORM_U8 = 64,
    GLTF_WANT_NORM_U16 = 128,
    GLTF_WANT_NORM_I8 = 256,
    GLTF_WANT_NORM_I16 = 512
};

/* ---- gltf_texture.c, gltf_material.c: appearance -------------------------------------------------- */

/* Reads textureInfo object.KEY; an absent one, or one that cannot be used, leaves `use` alone. */
bool gltf_read_texture(gltf *g, const json_place *object, const char *key, bool is_srgb, size_t material_number,
                       texture_use *use);
/* The scene material of a glTF material (NONE: the default), made at first use. */
bool gltf_use_material(gltf *g, size_t material_number, size_t *index);
/* Counts a material that will look different. */
void gltf_note_material(gltf *g, size_t material_number, const char *what, const char *effect);
/* Passes the notes on as warnings. */
void gltf_report_notes(gltf *g);

/* ---- gltf_mesh.c and its parts: geometry ---------------------------------------------------------- */

/* A skin at rest: one matrix per joint, joint's world times inverse bind. */
typedef struct gltf_pose {
    gltf_matrix *joints;
    size_t n_joints;
} gltf_pose;

/* pose->joints is the caller's to free. */
bool gltf_read_pose(gltf *g, size_t skin, gltf_pose *pose);

/* The scene meshes of a glTF mesh, shown by a node.  They are built once and shared, unless the node has
 * morph weights or a skin (pose, else NULL) of its own.  *result is valid until the next call. */
bool gltf_use_mesh(gltf *g, size_t mesh_number, const json_place *node, const gltf_pose *pose,
                   const gltf_mesh **result);
void gltf_mesh_destroy(gltf_mesh *m);

/* Triangles from the primitive's mode and indices; *triangles NULL if it has none. */
bool gltf_read_triangles(gltf *g, const json_place *primitive, size_t n_vertices, uint32_t (**triangles)[3],
                         size_t *n_triangles);
/* Adds the morph targets, weighted, to positions, normals and tangents. */
bool gltf_apply_morph(gltf *g, const json_place *primitive, const json_place *weights, mesh *m);
/* Moves vertices to where the skin's joints put them. */
bool gltf_apply_skin(gltf *g, const json_place *attributes, const gltf_pose *pose, mesh *m);
/* Makes normals and tangents unit, and replaces those that have no direction. */
bool gltf_tidy_frames(gltf *g, const json_place *primitive, mesh *m);

/* ---- gltf_node.c, gltf_scene.c: the hierarchy and what hangs on it ------------------------------- */

/* Reads all nodes' transforms and finds everyone's parent and world matrix. */
bool gltf_declare_nodes(gltf *g);
void gltf_multiply(gltf_matrix a, gltf_matrix b, gltf_matrix product);
/* From TRS; the rotation need not be unit, false if it is zero. */
bool gltf_compose(const double translation[3], const double rotation[4], const double scale[3], gltf_matrix m);
/* Adds what the file's default scene shows. */
bool gltf_build_scene(gltf *g);

bool gltf_add_camera(gltf *g, const json_place *node, size_t camera_number, gltf_matrix world);
bool gltf_add_light(gltf *g, const json_place *node, gltf_matrix world);
