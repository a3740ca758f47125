/* facet.h: libfacet, microfacet reflection, exact where the literature approximates.
 *
 * The whole public interface.  A material is described by a plain struct (facet_material: a model
 * and its parameters, also written as text such as "ggx alpha=.2 ks=.9,.7,.3"), prepared once into a
 * facet_bsdf, and then evaluated for any number of direction pairs, singly or in batches.
 *
 * Conventions, everywhere in this header:
 *   - local shading frame: normal n = (0,0,1), tangent = x, bitangent = y; directions have unit length
 *     and point away from the surface; `wi` points to the light, `wo` to the viewer;
 *   - eval is f(wi,wo) |cos theta_i| [1/sr]; pdf is per solid angle of wi [1/sr]; a sample's weight is
 *     eval/pdf; all are 0 where nothing is scattered; pdf == 0 means that there is no sample;
 *   - colours are linear, Rec.709/sRGB primaries; angles in radians;
 *   - finite, unit directions never give NaN or Inf.
 *
 * The library keeps no state but the choice of facet_isa_force: every other function may be called from
 * any number of threads at once.  It allocates nothing, prints nothing, and frees nothing.
 *
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FACET_VERSION_MAJOR 0
#define FACET_VERSION_MINOR 1
#define FACET_VERSION_PATCH 0

#if defined(_WIN32)
#define FACET_API
#else
#define FACET_API __attribute__((visibility("default")))
#endif

/* "0.1.0"; static storage. */
FACET_API const char *facet_version(void);

/* ---- Errors ------------------------------------------------------------------------------------ */

/* 0 is success.  On any other value the outputs are untouched. */
typedef enum facet_status {
    FACET_OK = 0,
    FACET_BAD_ARGUMENT, /* a NULL pointer or a struct_size this library does not know */
    FACET_BAD_SYNTAX,   /* text that does not have the documented form */
    FACET_UNKNOWN_NAME, /* no such model, parameter or choice */
    FACET_BAD_VALUE,    /* a value outside its documented range, or not finite */
    FACET_BAD_FILE,     /* a file's content is damaged or not of its kind */
    FACET_UNSUPPORTED,  /* a file asks for something that is not supported, or is above a documented cap */
    FACET_NO_MEMORY,    /* out of memory */
    FACET_IO            /* the system refused: missing, not permitted, disk full */
} facet_status;

/* A short English phrase, never NULL; static storage. */
FACET_API const char *facet_status_string(facet_status status);

/* Where and why something failed.  `place` locates the fault inside the input ("alpha",
 * "materials[3].name", "byte 120"; may be empty); `text` says what is wrong and what would be right. */
typedef struct facet_error {
    facet_status status;
    char place[96];
    char text[224];
} facet_error;

/* ---- Models and their parameters --------------------------------------------------------------- */

typedef enum facet_parameter_kind {
    FACET_NUMBER, /* one value */
    FACET_COLOUR, /* three values, r,g,b; one number stands for a grey */
    FACET_CHOICE  /* one of `choices`, separated by '|'; its value is its index */
} facet_parameter_kind;

/* One parameter of a model.  The same table drives the text form, `facet materials`, and the docs. */
typedef struct facet_parameter {
    const char *name;
    facet_parameter_kind kind;
    double low, high;  /* inclusive range of each value; 0 and count-1 for a choice */
    double initial[3]; /* the default */
    const char *unit;  /* "1" for dimensionless */
    const char *choices;
    const char *description;
} facet_parameter;

#define FACET_MAX_PARAMETERS 24

typedef struct facet_model_info {
    const char *name;    /* as written in the text form */
    const char *summary; /* one line */
    const char *source;  /* the paper and equations that it implements */
    size_t n_parameters;
    const facet_parameter *parameters;
} facet_model_info;

FACET_API size_t facet_model_count(void);

/* The i-th model, i < facet_model_count(); NULL past the end.  Static storage. */
FACET_API const facet_model_info *facet_model_get(size_t i);

/* A material: a model and a value for each of its parameters, in the order of its table
 * (values[k][0] for a number or a choice).  Bit k of `given` tells that parameter k was set by the
 * caller; where parameters exclude each other (ks, ior) the one given counts. */
typedef struct facet_material {
    size_t struct_size;
    size_t model;
    unsigned given;
    double values[FACET_MAX_PARAMETERS][3];
} facet_material;

/* All defaults of the model called `name`. */
FACET_API facet_status facet_material_defaults(const char *name, facet_material *material, facet_error *why);

/* Parses "MODEL key=value key=r,g,b ...", e.g. "ggx alpha_x=.1 alpha_y=.4 ks=.9,.7,.3".  Unknown
 * keys, repeated keys, keys that exclude each other, values out of range and non-finite numbers are
 * errors; `why->place` then names the key.  `why` may be NULL. */
FACET_API facet_status facet_material_parse(const char *text, facet_material *material, facet_error *why);

/* Sets one parameter from n_values numbers (1 or 3; a choice by its index).  Same errors. */
FACET_API facet_status facet_material_set(facet_material *material, const char *name, const double *values,
                                          size_t n_values, facet_error *why);

/* ---- Evaluation -------------------------------------------------------------------------------- */

/* A material prepared for evaluation, in float and in double.  The caller owns the storage; the
 * content is private and valid for one version of the library on one machine; copy it freely. */
typedef struct facet_bsdf {
    double state[80];
} facet_bsdf;
typedef struct facet_bsdf64 {
    double state[320];
} facet_bsdf64;

FACET_API facet_status facet_bsdf_prepare(const facet_material *material, facet_bsdf *bsdf, facet_error *why);
FACET_API facet_status facet_bsdf64_prepare(const facet_material *material, facet_bsdf64 *bsdf, facet_error *why);

/* The model metallic_roughness straight from its values at one shading point, for textured surfaces: no
 * checks, a few nanoseconds.  base_color, metallic, roughness, specular in [0,1]; specular_color >= 0;
 * dielectric_F0 = ((ior - 1)/(ior + 1))^2. */
FACET_API facet_bsdf facet_bsdf_metallic_roughness(const float base_color[3], float metallic, float roughness,
                                                   float dielectric_F0, float specular, const float specular_color[3]);

/* The model glass straight from its values.  ior in [0.1, 10]; alpha in [0, 4], of ggx, smooth below 1e-4; tint in
 * [0,1]. */
FACET_API facet_bsdf facet_bsdf_glass(float ior, float alpha, const float tint[3], int is_thin);

/* The prepared parameters as 32-bit words, for the shaders of share/facet/glsl (docs/shaders.md): fills words[0..n-1],
 * with 0 past the last, and returns how many there are.  words may be NULL if n is 0. */
FACET_API size_t facet_bsdf_words(const facet_bsdf *bsdf, size_t n, uint32_t *words);

/* The kernel that serves the material, e.g. "microfacet" for ggx: what its functions in facet.glsl are called by;
 * static storage. */
FACET_API const char *facet_bsdf_kernel(const facet_bsdf *bsdf);

/* What a sample is.  A delta sample (smooth glass, mirrors) is one of finitely many directions: its
 * pdf is the probability of that direction [1], and eval and pdf of any direction are 0. */
enum { FACET_REFLECTION = 1, FACET_TRANSMISSION = 2, FACET_DIFFUSE = 4, FACET_GLOSSY = 8, FACET_DELTA = 16 };

/* All the bits that the samples of this material can have. */
FACET_API int facet_bsdf_lobes(const facet_bsdf *bsdf);
FACET_API int facet_bsdf64_lobes(const facet_bsdf64 *bsdf);

typedef struct facet_sample {
    float wi[3];
    float pdf;       /* [1/sr]; 0: there is no sample, and weight is 0 */
    float weight[3]; /* eval/pdf */
    int lobe;        /* FACET_REFLECTION | FACET_GLOSSY, ... */
    float eta;       /* index of refraction on wi's side over that on wo's; 1 unless the sample refracts */
} facet_sample;
typedef struct facet_sample64 {
    double wi[3];
    double pdf;
    double weight[3];
    int lobe;
    double eta;
} facet_sample64;

/* f(wi,wo) |cos theta_i| as RGB [1/sr].  wi, wo: unit vectors. */
FACET_API void facet_bsdf_eval(const facet_bsdf *bsdf, const float wi[3], const float wo[3], float f[3]);
FACET_API void facet_bsdf64_eval(const facet_bsdf64 *bsdf, const double wi[3], const double wo[3], double f[3]);

/* The density with which facet_bsdf_sample draws wi for this wo [1/sr]. */
FACET_API float facet_bsdf_pdf(const facet_bsdf *bsdf, const float wi[3], const float wo[3]);
FACET_API double facet_bsdf64_pdf(const facet_bsdf64 *bsdf, const double wi[3], const double wo[3]);

/* Both at once, for less than the two calls: fills f and returns the pdf, the same bits. */
FACET_API float facet_bsdf_eval_pdf(const facet_bsdf *bsdf, const float wi[3], const float wo[3], float f[3]);
FACET_API double facet_bsdf64_eval_pdf(const facet_bsdf64 *bsdf, const double wi[3], const double wo[3], double f[3]);

/* Draws wi for wo from three numbers u in [0,1): u[0], u[1] place the direction, u[2] picks the lobe. */
FACET_API facet_sample facet_bsdf_sample(const facet_bsdf *bsdf, const float wo[3], const float u[3]);
FACET_API facet_sample64 facet_bsdf64_sample(const facet_bsdf64 *bsdf, const double wo[3], const double u[3]);

/* The distribution's own terms at the unit vector m: D(m) [1/sr], Lambda(m) and G1 = 1/(1 + Lambda)
 * with m as a direction of view above the horizon.  Below it D and G1 are 0, since no microfacet shows its face, and
 * Lambda is whatever the model's formula gives.  All 0 for a model without a distribution (lambert, smooth glass). */
typedef struct facet_terms {
    float D, Lambda, G1;
} facet_terms;
typedef struct facet_terms64 {
    double D, Lambda, G1;
} facet_terms64;
FACET_API facet_terms facet_bsdf_terms(const facet_bsdf *bsdf, const float m[3]);
FACET_API facet_terms64 facet_bsdf64_terms(const facet_bsdf64 *bsdf, const double m[3]);

/* D(m) alone, the same bits, where Lambda takes long (gtr: to its last digits, an integral). */
FACET_API float facet_bsdf_D(const facet_bsdf *bsdf, const float m[3]);
FACET_API double facet_bsdf64_D(const facet_bsdf64 *bsdf, const double m[3]);

/* The directional albedo, Int f(wi,wo) |cos theta_i| d omega_i as RGB: what a world of radiance 1 sends to wo, by
 * reflection (`reflected`: wi on wo's side) and through the surface (`transmitted`), mirrors and smooth glass included.
 * By reciprocity `reflected` is also the share of the light from wo that is reflected.  What is transmitted carries the
 * factor (n_o/n_i)^2 of radiance.  wo: unit, above or below the surface.  *error, unless `error` is NULL: how far two
 * rules of quadrature disagree, which is more than the error of the better one; for both results together about 1e-8,
 * and below 1e-6 for alpha from 1e-4 on.  Takes 1 to 30 ms, and up to 200 ms under total reflection.
 * FACET_BAD_ARGUMENT if another pointer is NULL, FACET_BAD_VALUE if |wo|^2 is not 1 within 1e-6. */
FACET_API facet_status facet_bsdf64_albedo(const facet_bsdf64 *bsdf, const double wo[3], double reflected[3],
                                           double transmitted[3], double *error);

/* The same averaged over all wo above the surface, or below it if `is_inside`, weighted by their cosines:
 * 1/pi Int albedo(wo) |cos theta_o| d omega_o, what happens to perfectly diffuse light.  *error: about 1e-7.  Takes
 * 0.1 s, seconds for what is anisotropic or rough glass, and half a minute for alpha_x:alpha_y = 1:100. */
FACET_API facet_status facet_bsdf64_average_albedo(const facet_bsdf64 *bsdf, int is_inside, double reflected[3],
                                                   double transmitted[3], double *error);

/* ---- Batches ----------------------------------------------------------------------------------- */

/* Structures of arrays, n elements each, owned by the caller.  Outputs must not overlap inputs. */
typedef struct facet_dirs {
    const float *x, *y, *z;
} facet_dirs;
typedef struct facet_rgb {
    float *r, *g, *b;
} facet_rgb;
typedef struct facet_samples {
    float *wi_x, *wi_y, *wi_z, *pdf, *weight_r, *weight_g, *weight_b;
} facet_samples;

/* facet_bsdf_eval, _pdf, _eval_pdf and _sample for n elements: the same bits, whatever the instruction set.  Up to
 * 128 KiB of stack. */
FACET_API void facet_bsdf_eval_batch(const facet_bsdf *bsdf, size_t n, facet_dirs wi, facet_dirs wo, facet_rgb f);
FACET_API void facet_bsdf_pdf_batch(const facet_bsdf *bsdf, size_t n, facet_dirs wi, facet_dirs wo, float *pdf);
FACET_API void facet_bsdf_eval_pdf_batch(const facet_bsdf *bsdf, size_t n, facet_dirs wi, facet_dirs wo, facet_rgb f,
                                         float *pdf);
/* u: three arrays of n numbers in [0,1), named x, y, z for u[0], u[1], u[2]. */
FACET_API void facet_bsdf_sample_batch(const facet_bsdf *bsdf, size_t n, facet_dirs wo, facet_dirs u,
                                       facet_samples samples);

/* Parameters that differ from element to element, as textures give them: arrays of n, or NULL for the prepared
 * material's own value.  Set struct_size to sizeof(facet_lanes) and all else that is not used to 0.  Values beyond the
 * range of their parameter count as its nearest end, NaN as its lower one. */
typedef struct facet_lanes {
    size_t struct_size;
    const float *alpha_x, *alpha_y; /* both or neither; the same array twice for an isotropic surface */
    const float *gamma;             /* of gtr */
    const float *kd[3], *ks[3];     /* red, green and blue: all three or none; ks with Schlick's Fresnel term */
} facet_lanes;

/* The batch functions with parameters that vary, for ggx, beckmann, phong and gtr (and cs500 and vray) with
 * masking=exact and energy=single.  Directions are drawn from visible normals, of gtr from all, whatever the material
 * says.  FACET_BAD_ARGUMENT if a pointer is NULL, lanes->struct_size is unknown, or an array is given that the material
 * does not have; FACET_UNSUPPORTED for other materials.  gtr takes some 30 ns for each direction's masking. */
FACET_API facet_status facet_bsdf_eval_lanes(const facet_bsdf *bsdf, const facet_lanes *lanes, size_t n, facet_dirs wi,
                                             facet_dirs wo, facet_rgb f, facet_error *why);
FACET_API facet_status facet_bsdf_pdf_lanes(const facet_bsdf *bsdf, const facet_lanes *lanes, size_t n, facet_dirs wi,
                                            facet_dirs wo, float *pdf, facet_error *why);
FACET_API facet_status facet_bsdf_eval_pdf_lanes(const facet_bsdf *bsdf, const facet_lanes *lanes, size_t n,
                                                 facet_dirs wi, facet_dirs wo, facet_rgb f, float *pdf,
                                                 facet_error *why);
FACET_API facet_status facet_bsdf_sample_lanes(const facet_bsdf *bsdf, const facet_lanes *lanes, size_t n,
                                               facet_dirs wo, facet_dirs u, facet_samples samples, facet_error *why);

/* The instruction sets that this processor can run, best first ("avx512", "avx2", "base"); NULL past
 * the end.  Batches use the first unless facet_isa_force names another (for tests and benchmarks: not
 * to be called while batches run).  FACET_UNKNOWN_NAME if this processor cannot run it; NULL: best. */
FACET_API const char *facet_isa_name(size_t i);
FACET_API facet_status facet_isa_force(const char *name);

#ifdef __cplusplus
}
#endif
