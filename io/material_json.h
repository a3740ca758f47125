/* material_json.h: a libfacet material written as a JSON object.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "facet/facet.h"
#include "io/json.h"

#ifdef __cplusplus
extern "C" {
#endif

/* {"model": "ggx", "alpha": 0.2, "ks": [0.9, 0.7, 0.3], "g2": "separable"}: the keys of the text form that
 * facet_material_parse reads; numbers, arrays of three, and choices by name. */
bool material_json_read(const json_place *object, facet_bsdf *bsdf);

#ifdef __cplusplus
}
#endif
