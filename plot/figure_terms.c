/* figure_terms.c: D, Lambda, G1 and F over their angle.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "core/error.h"
#include "plot/curves.h"

static double value_D(const figure *f, const figure_material *m, double theta, double x)
{
    (void)theta;
    double v[3];
    figure_direction(x, f->phi, v);
    return figure_D(m, v);
}

static double value_Lambda(const figure *f, const figure_material *m, double theta, double x)
{
    (void)theta;
    double v[3];
    figure_direction(x, f->phi, v);
    return v[2] > 0 ? figure_Lambda(m, v) : NAN; /* infinite at 90 degrees */
}

static double value_G1(const figure *f, const figure_material *m, double theta, double x)
{
    (void)theta;
    double v[3];
    figure_direction(x, f->phi, v);
    return figure_G1(m, v);
}

facet_status draw_D(canvas *page, box place, const figure *f, facet_error *why)
{
    const curve_kind kind = {.value = value_D,
                             .x_name = "θ_m, angle between microfacet and surface normal [degrees]",
                             .y_name = "D(θ_m) [1/sr]",
                             .high = 90,
                             .is_symmetric = true};
    const facet_status status = figure_need_terms(f, "D", why);
    return status ? status : draw_curves(page, place, f, &kind, why);
}

facet_status draw_Lambda(canvas *page, box place, const figure *f, facet_error *why)
{
    const curve_kind kind = {.value = value_Lambda,
                             .x_name = "θ, angle between direction and surface normal [degrees]",
                             .y_name = "Λ(θ) [1]",
                             .high = 90,
                             .is_symmetric = true};
    const facet_status status = figure_need_terms(f, "Lambda", why);
    return status ? status : draw_curves(page, place, f, &kind, why);
}

facet_status draw_G1(canvas *page, box place, const figure *f, facet_error *why)
{
    const curve_kind kind = {.value = value_G1,
                             .x_name = "θ, angle between direction and surface normal [degrees]",
                             .y_name = "G_1(θ) [1]",
                             .high = 90,
                             .is_symmetric = true};
    const facet_status status = figure_need_terms(f, "G1", why);
    return status ? status : draw_curves(page, place, f, &kind, why);
}

/* ---- Fresnel ----------------------------------------------------------------------------------- */

/* F = f/f where F is 1, of one pair of directions: the same facets with ks = 1 and no diffuse part. */
static facet_status make_pair(const figure_material *m, figure_material pair[2], facet_error *why)
{
    static const char *const fresnel[] = {"ks", "f82", "ior", "metal", "eta", "k", "energy"};
    const double none = 0, one = 1;
    const facet_model_info *model = facet_model_get(m->material.model);
    pair[0] = pair[1] = *m;
    for (size_t i = 0; i < model->n_parameters; i++)
        for (size_t k = 0; k < sizeof fresnel/sizeof *fresnel; k++) {
            if (strcmp(model->parameters[i].name, fresnel[k]) != 0) continue;
            if (strcmp(fresnel[k], "energy") == 0) pair[0].material.values[i][0] = 0;
            memcpy(pair[1].material.values[i], model->parameters[i].initial, sizeof model->parameters[i].initial);
            pair[1].material.given &= ~(1u << i);
        }
    facet_status status = FACET_OK;
    for (int k = 0; k < 2 && !status; k++) {
        status = facet_material_set(&pair[k].material, "kd", &none, 1, why);
        if (k == 1 && !status) status = facet_material_set(&pair[k].material, "ks", &one, 1, why);
        if (!status) status = facet_bsdf64_prepare(&pair[k].material, &pair[k].bsdf, why);
    }
    if (!status) return FACET_OK;
    return facet_error_set(why, FACET_UNSUPPORTED, m->label,
                           "has no Fresnel term that can be shown alone; phong, beckmann, ggx and gtr have one");
}

/* Light and view on both sides of the normal, so that the half vector is the normal. */
static double value_F(const figure *f, const figure_material *m, double theta, double x)
{
    (void)theta;
    figure_material pair[2];
    double wi[3], wo[3], value[2][3];
    if (x >= 90 || make_pair(m, pair, NULL)) return NAN;
    figure_direction(x, f->phi, wi);
    figure_direction(-x, f->phi, wo);
    for (int k = 0; k < 2; k++) facet_bsdf64_eval(&pair[k].bsdf, wi, wo, value[k]);
    return figure_channel_of(f, value[0])/figure_channel_of(f, value[1]);
}

facet_status draw_F(canvas *page, box place, const figure *f, facet_error *why)
{
    const curve_kind kind = {.value = value_F,
                             .x_name = "θ_d, angle between light and half vector [degrees]",
                             .y_name = "F(θ_d) [1]",
                             .high = 90,
                             .is_symmetric = true};
    figure_material pair[2];
    facet_status status = figure_need_own(f, "a Fresnel term that can be shown alone", why);
    if (!status) status = figure_need_terms(f, "Fresnel term of microfacets", why);
    for (size_t k = 0; k < f->n_materials && !status; k++) status = make_pair(&f->materials[k], pair, why);
    return status ? status : draw_curves(page, place, f, &kind, why);
}
