/* read_material.h: reading a checked material's values in the precision of the file that includes this.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "../kernel/real.h"
#include "../material.h"

#ifdef FACET_PREPARE
static inline real3 prepare_colour(const facet_material *m, const char *name)
{
    return make3((real)facet_material_value(m, name, 0), (real)facet_material_value(m, name, 1),
                 (real)facet_material_value(m, name, 2));
}

static inline real prepare_number(const facet_material *m, const char *name)
{
    return (real)facet_material_value(m, name, 0);
}

static inline int prepare_choice(const facet_material *m, const char *name)
{
    return (int)facet_material_value(m, name, 0);
}
#endif
