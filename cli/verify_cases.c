/* verify_cases.c: the settings of the parameters that `facet verify` runs over.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>

#include "cli/verify_job.h"

/* Every model, every choice that changes a formula, and the ends of the ranges. */
static const char *const every[] = {
    "lambert kd=1",
    "ggx alpha=1e-3",
    "ggx alpha=.05",
    "ggx alpha=.3",
    "ggx alpha=1",
    "ggx alpha=4",
    "ggx alpha_x=.1 alpha_y=.5",
    "ggx alpha_x=1 alpha_y=.1",
    "ggx alpha=.3 g2=separable",
    "ggx alpha=.3 sampling=ndf",
    "ggx alpha=.3 sampling=bounded",
    "ggx alpha_x=.2 alpha_y=.6 sampling=bounded",
    "ggx alpha=.2 kd=.5 ior=1.5",
    "ggx alpha=.2 metal=Au",
    "ggx alpha=.2 ks=.9,.6,.3 f82=.9,.8,.7",
    "ggx alpha=.05 energy=multi",
    "ggx alpha=.5 energy=multi",
    "ggx alpha=1 energy=multi",
    "ggx alpha_x=.1 alpha_y=.5 energy=multi",
    "ggx alpha=.5 energy=scaled",
    "beckmann alpha=1e-3",
    "beckmann alpha=.1",
    "beckmann alpha=.5",
    "beckmann alpha=1",
    "beckmann alpha_x=.1 alpha_y=.5",
    "beckmann alpha=.3 sampling=ndf",
    "beckmann alpha=.5 energy=multi",
    "phong exponent=0",
    "phong exponent=1",
    "phong exponent=50",
    "phong exponent=1e5",
    "phong alpha_x=.1 alpha_y=.4",
    "phong exponent=10 sampling=ndf",
    "phong exponent=10 energy=multi",
    "gtr alpha=.1 gamma=.05",
    "gtr alpha=.1 gamma=.7",
    "gtr alpha=.1 gamma=.999",
    "gtr alpha=.1 gamma=1",
    "gtr alpha=.1 gamma=1.001",
    "gtr alpha=.1 gamma=1.5",
    "gtr alpha=1e-3 gamma=1",
    "gtr alpha=1e-3 gamma=2",
    "gtr alpha=.3 gamma=2",
    "gtr alpha=.3 gamma=4.5",
    "gtr alpha=.5 gamma=20",
    "gtr alpha=1 gamma=.5",
    "gtr alpha=1 gamma=20",
    "gtr alpha_x=.1 alpha_y=.5 gamma=1.5",
    "gtr alpha_x=.1 alpha_y=1 gamma=3",
    "gtr alpha=.3 gamma=1.5 sampling=ndf",
    "gtr alpha=.3 gamma=.7 energy=multi",
    "ward alpha_x=.2 alpha_y=.2",
    "ward alpha_x=.1 alpha_y=.3",
    "ward variant=duer alpha_x=.1 alpha_y=.3",
    "ward variant=ward92 alpha_x=.1 alpha_y=.3",
    "cs500 ndf=ggx alpha=.3 kd=.5 ks=.5",
    "cs500 ndf=beckmann alpha=.3 masking=exact",
    "cs500 ndf=phong exponent=20 masking=exact",
    "vray sharpness=.6 masking=exact",
    "vray sharpness=.8 gamma=3 masking=exact",
    "disney",
    "disney metallic=1 roughness=.3 anisotropic=.8",
    "disney roughness=.6 sheen=1 subsurface=1",
    "disney clearcoat=1 coat_masking=exact",
    "metallic_roughness roughness=.3",
    "metallic_roughness metallic=1 roughness=.8",
    "glass",
    "glass alpha=.3",
    "glass alpha=.2 wall=thin",
    "glass alpha=.3 ndf=beckmann",
    "glass alpha=.3 ndf=gtr gamma=1.5",
};

void cases_add_every(case_list *list)
{
    for (size_t i = 0; i < sizeof every/sizeof *every; i++) cases_add(list, every[i]);
}

/* The values over which a shape parameter is run unless it is fixed. */
typedef struct shape_range {
    const char *name;
    double values[3];
} shape_range;
static const shape_range shapes[] = {{"alpha", {.02, .3, 1}},      {"gamma", {.5, 2, 8}},
                                     {"exponent", {2, 50, 2000}},  {"roughness", {.1, .5, 1}},
                                     {"sharpness", {.1, .5, .85}}, {"anisotropic", {0, .5, 1}}};

void cases_add(case_list *list, const char *text)
{
    if (list->n == VERIFY_MOST_CASES) return;
    snprintf(list->items[list->n].text, sizeof list->items[0].text, "%s", text);
    list->n++;
}

void cases_add_shapes(case_list *list, const char *spec, bool is_fixed)
{
    facet_material m;
    cases_add(list, spec);
    if (is_fixed || facet_material_parse(spec, &m, NULL)) return;
    const facet_model_info *model = facet_model_get(m.model);
    for (size_t k = 0; k < model->n_parameters; k++)
        for (size_t s = 0; s < sizeof shapes/sizeof *shapes; s++) {
            if (strcmp(model->parameters[k].name, shapes[s].name) != 0 || m.given >> k & 1) continue;
            for (int v = 0; v < 3; v++) {
                char text[400];
                facet_material changed;
                facet_bsdf64 bsdf;
                snprintf(text, sizeof text, "%s %s=%g", spec, shapes[s].name, shapes[s].values[v]);
                if (shapes[s].values[v] == m.values[k][0]) continue;
                if (facet_material_parse(text, &changed, NULL) || facet_bsdf64_prepare(&changed, &bsdf, NULL)) continue;
                cases_add(list, text);
            }
        }
}

static void add_plugin_case(case_list *list, const plugin *p, const double values[PLUGIN_PARAMETERS])
{
    char text[400] = "";
    for (int i = 0; i < p->model->parameter_count; i++) {
        const size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "%s%s=%.9g", i ? " " : "", p->model->parameters[i].name, values[i]);
    }
    cases_add(list, text);
    memcpy(list->items[list->n - 1].values, values, PLUGIN_PARAMETERS*sizeof *values);
}

void cases_add_plugin(case_list *list, const plugin *p, bool is_fixed)
{
    add_plugin_case(list, p, p->values);
    for (int i = 0; i < p->model->parameter_count && !is_fixed; i++)
        for (int end = 0; end < 2 && !p->is_fixed[i]; end++) {
            double values[PLUGIN_PARAMETERS];
            memcpy(values, p->values, sizeof values);
            values[i] = end ? p->model->parameters[i].highest : p->model->parameters[i].lowest;
            if (values[i] != p->values[i]) add_plugin_case(list, p, values);
        }
}
