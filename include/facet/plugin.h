/* facet/plugin.h: a reflection model of your own, for `facet verify --plugin FILE.so`.
 *
 * A plugin is a shared library that defines facet_plugin_describe, which returns one facet_plugin:
 *
 *     const facet_plugin *facet_plugin_describe(void);
 *
 *     cc -shared -fPIC -I include -o my_model.so my_model.c -lm
 *     facet verify --plugin ./my_model.so
 *
 * Conventions are those of facet.h (docs/conventions.md): the local frame with the normal (0, 0, 1); unit vectors that
 * point away from the surface; wi towards the light, wo towards the viewer.  Every function must be a pure function of
 * its arguments: facet calls it from several threads at once, in any order.
 *
 * examples/07_plugin_phong.c is a whole one.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>

#include "facet/facet.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Exports what a plugin defines, whatever its compiler hides. */
#define FACET_PLUGIN FACET_API

/* What a plugin promises of its model, besides what every model promises: numbers that are finite and not negative, a
 * pdf that is the density of the samples, and weights that are f cos/pdf.  facet verify checks each promise. */
enum {
    FACET_CLAIMS_RECIPROCAL = 1, /* f(wi, wo) = f(wo, wi) */
    FACET_CLAIMS_PASSIVE = 2,    /* the directional albedo is at most 1 for every wo */
    FACET_CLAIMS_LOSSLESS = 4,   /* ... and is exactly 1 */
    FACET_CLAIMS_ISOTROPIC = 8,  /* turning wi and wo about the normal together changes nothing */
    FACET_CLAIMS_TRANSMITS = 16  /* light goes through: wo may be on either side, and wi on the other */
};

/* A parameter: facet verify runs over [lowest, highest], unless the user fixes it with NAME=VALUE. */
typedef struct facet_plugin_parameter {
    const char *name;
    double lowest, highest, value; /* range, ends included, and default */
    const char *description;       /* one line, for --help */
} facet_plugin_parameter;

/* `p` holds the parameters' values in the order of the table.  Set what a model does not have to NULL. */
typedef struct facet_plugin {
    size_t struct_size;  /* sizeof(facet_plugin) */
    const char *name;    /* as in messages: a word */
    const char *summary; /* one line */
    unsigned claims;     /* FACET_CLAIMS_... */
    int parameter_count;
    const facet_plugin_parameter *parameters;

    /* f(wi, wo) |cos theta_i| as RGB [1/sr]; 0 where wi or wo is below the horizon, unless the model transmits.  Never
     * NULL. */
    void (*eval)(const double *p, const double wi[3], const double wo[3], double f[3]);

    /* The density with which `sample` draws wi for wo [1/sr].  NULL together with sample. */
    double (*pdf)(const double *p, const double wi[3], const double wo[3]);

    /* Draws wi for wo from three uniform numbers u in [0, 1): fills wi and weight = f |cos theta_i|/pdf and returns 1,
     * or returns 0 for a draw that gives no sample (one that falls below the horizon). */
    int (*sample)(const double *p, const double wo[3], const double u[3], double wi[3], double weight[3]);

    /* Of a microfacet model: the distribution of normals, D(m) [1/sr], and Smith's G1 for the direction v.  Either may
     * be NULL, and the checks that need it are left out. */
    double (*D)(const double *p, const double m[3]);
    double (*G1)(const double *p, const double v[3]);
} facet_plugin;

/* What a plugin defines. */
FACET_PLUGIN const facet_plugin *facet_plugin_describe(void);

#ifdef __cplusplus
}
#endif
