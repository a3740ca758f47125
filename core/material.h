/* material.h: reading a material's parameters by name, for the models' prepare functions.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "facet/facet.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The parameter's index in its model's table, or -1. */
int facet_material_index(const facet_material *material, const char *name);

/* Value k of the parameter; the model must have it. */
double facet_material_value(const facet_material *material, const char *name, int k);

/* Whether the caller set the parameter. */
int facet_material_given(const facet_material *material, const char *name);

/* FACET_OK if the struct is one that this library filled and every value is in range. */
facet_status facet_material_check(const facet_material *material, facet_error *why);

#ifdef __cplusplus
}
#endif
