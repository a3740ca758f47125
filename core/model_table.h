/* model_table.h: the models, one row each.  A new model is a file in core/kernel/ and a row here.
 *
 * A kernel file NAME.h defines, beside its formulas, NAME_params, NAME_eval, NAME_pdf, NAME_sample,
 * NAME_lobes and NAME_terms; under FACET_PARAMETERS the array NAME_parameters, and under FACET_PREPARE NAME_prepare,
 * which turns a checked facet_material into NAME_params.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "facet/facet.h"

#include "material.h"

#include "kernel/beckmann.h"
#include "kernel/ggx.h"
#include "kernel/glass.h"
#include "kernel/lambert.h"
#include "kernel/metallic_roughness.h"
#include "kernel/phong.h"

/* X(name, summary, source) */
#define FACET_MODELS(X)                                                                                                \
    X(lambert, "ideal diffuse reflector", "CS500 Project 3, diffuse term")                                             \
    X(phong, "Phong distribution of normals, with its own exact Smith masking",                                        \
      "CS500 Project 3, D_p, exponent of the sampler corrected")                                                       \
    X(beckmann, "Beckmann (Gaussian) distribution of normals", "CS500 Project 3, D_b; Heitz 2014")                     \
    X(ggx, "GGX (Trowbridge-Reitz) distribution of normals", "CS500 Project 3, D_g; Dupuy and Benyoub 2023")           \
    X(glass, "smooth dielectric: mirror reflection and refraction", "CS500 Project 3, exact F; Walter 2007, s. 4")     \
    X(metallic_roughness, "glTF's material: dielectric over diffuse, blended towards a metal",                         \
      "glTF 2.0 Specification, appendix B")
