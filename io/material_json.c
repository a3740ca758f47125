/* material_json.c: a libfacet material written as a JSON object.
 *
 * The parameter table decides: each member is looked up by name and set through facet_material_set, so
 * that ranges and exclusions are checked where they are defined.
 * SPDX-License-Identifier: MIT */
#include "io/material_json.h"

#include <float.h>
#include <string.h>

static const facet_parameter *find_parameter(const facet_material *material, const char *name)
{
    const facet_model_info *const model = facet_model_get(material->model);
    for (size_t i = 0; i < model->n_parameters; i++)
        if (strcmp(model->parameters[i].name, name) == 0) return &model->parameters[i];
    return NULL;
}

/* The index of `name` among choices separated by '|'. */
static bool find_choice(const json_place *place, const facet_parameter *parameter, const char *name, double *index)
{
    const size_t length = strlen(name);
    const char *choice = parameter->choices;
    for (int i = 0; choice; i++) {
        const size_t n = strcspn(choice, "|");
        if (n == length && strncmp(choice, name, n) == 0) {
            *index = i;
            return true;
        }
        choice = choice[n] ? choice + n + 1 : NULL;
    }
    return json_fail(place, FACET_UNKNOWN_NAME, "\"%.40s\" is not one of %s", name, parameter->choices);
}

/* One to three numbers, or a choice's name as its index: which number that is, files do not say. */
static bool read_values(const json_place *place, const facet_parameter *parameter, double values[3], size_t *n)
{
    const char *name;
    *n = 1;
    if (parameter->kind == FACET_CHOICE) {
        if (json_kind_here(place) != JSON_KIND_STRING)
            return json_fail(place, FACET_BAD_VALUE, "must be a name: one of %s", parameter->choices);
        return json_string_here(place, &name) && find_choice(place, parameter, name, &values[0]);
    }
    switch (json_kind_here(place)) {
    case JSON_KIND_STRING:
        return json_fail(place, FACET_BAD_VALUE, "is a string; must be a number from %g to %g", parameter->low,
                         parameter->high);
    case JSON_KIND_ARRAY:
        *n = json_count(place);
        if (*n != 3) return json_fail(place, FACET_BAD_VALUE, "has %zu numbers; must have 1 or 3", *n);
        for (size_t i = 0; i < 3; i++) {
            const json_place element = json_element(place, i);
            if (!json_number_here(&element, -DBL_MAX, DBL_MAX, &values[i])) return false;
        }
        return true;
    default: return json_number_here(place, -DBL_MAX, DBL_MAX, &values[0]);
    }
}

static bool set_member(const json_place *place, facet_material *material)
{
    const facet_parameter *const parameter = find_parameter(material, place->key);
    facet_error problem = {0};
    double values[3] = {0};
    size_t n = 1;
    /* a name that the model does not have is left to facet_material_set, which says what it has */
    if (parameter && !read_values(place, parameter, values, &n)) return false;
    const facet_status status = facet_material_set(material, place->key, values, n, &problem);
    return !status || json_fail(place, status, "%s", problem.text);
}

bool material_json_read(const json_place *object, facet_bsdf *bsdf)
{
    facet_error problem = {0};
    facet_material material = {.struct_size = sizeof material};
    const json_place model = json_member(object, "model");
    const char *name;
    if (!json_want_present(&model) || !json_string_here(&model, &name)) return false;
    facet_status status = facet_material_defaults(name, &material, &problem);
    if (status) return json_fail(&model, status, "%s", problem.text);
    json_place member;
    void *iterator = NULL;
    while (json_next(object, &iterator, &member)) {
        if (strcmp(member.key, "model") == 0 || strcmp(member.key, "extras") == 0) continue;
        if (!set_member(&member, &material)) return false;
    }
    status = facet_bsdf_prepare(&material, bsdf, &problem);
    return !status || json_fail(object, status, "%s%s%s", problem.place, problem.place[0] ? ": " : "", problem.text);
}
