/* material_text.c: materials and directions from the command line.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/report.h"
#include "cli/suggest.h"

/* The name that the first word, or the key called `place`, was probably meant to be; NULL if none is near. */
static const char *near_name(const char *text, const char *place, char *wrong, size_t size)
{
    snprintf(wrong, size, "%.*s", (int)strcspn(text, " \t\n"), text);
    const facet_model_info *model = NULL;
    for (size_t i = 0; i < facet_model_count(); i++)
        if (strcmp(facet_model_get(i)->name, wrong) == 0) model = facet_model_get(i);
    if (model) snprintf(wrong, size, "%s", place);
    suggestion near = suggestion_start(wrong);
    for (size_t i = 0; !model && i < facet_model_count(); i++) suggestion_offer(&near, facet_model_get(i)->name);
    for (size_t i = 0; model && i < model->n_parameters; i++) suggestion_offer(&near, model->parameters[i].name);
    const char *meant = suggestion_get(&near);
    return meant && near.distance > 0 ? meant : NULL;
}

/* What is no model but has a text of the same form, where it is taken; NULL for all else. */
static const char *said_of_foreign(const char *text)
{
    static const char *const kinds[][2] = {
        {"merl",
         "`merl file=FILE.binary`, a measurement, is taken by `facet plot` and `facet verify` alone; `facet fit "
         "FILE.binary` finds a material for it"},
        {"plugin", "`plugin file=FILE.so` is taken by `facet plot` alone; `facet verify` has --plugin FILE.so"}};
    const char *word = text + strspn(text, " \t\r\n");
    const size_t length = strcspn(word, " \t\r\n");
    for (size_t i = 0; i < sizeof kinds/sizeof *kinds; i++)
        if (strlen(kinds[i][0]) == length && strncmp(word, kinds[i][0], length) == 0) return kinds[i][1];
    return NULL;
}

int read_material(const char *text, const char *place, facet_material *m)
{
    facet_error why = {0};
    facet_status status = facet_material_parse(text, m, &why);
    if (!status) return 0;
    const char *foreign = said_of_foreign(text);
    if (foreign) return fail(EXIT_USAGE, place, NULL, "%s", foreign);
    char wrong[96];
    const char *meant = status == FACET_UNKNOWN_NAME ? near_name(text, why.place, wrong, sizeof wrong) : NULL;
    char suggested[80] = "";
    if (meant) snprintf(suggested, sizeof suggested, "; did you mean `%s`?", meant);
    return fail(exit_status(status, FROM_ARGUMENTS), place, why.place, "%s%s", why.text, suggested);
}

int prepare_bsdf(const char *text, const char *place, facet_bsdf *bsdf)
{
    facet_material m;
    facet_error why = {0};
    const int status = read_material(text, place, &m);
    if (status) return status;
    return facet_bsdf_prepare(&m, bsdf, &why) ? fail_with(FROM_ARGUMENTS, place, &why) : 0;
}

int prepare_bsdf64(const char *text, const char *place, facet_bsdf64 *bsdf)
{
    facet_material m;
    facet_error why = {0};
    const int status = read_material(text, place, &m);
    if (status) return status;
    return facet_bsdf64_prepare(&m, bsdf, &why) ? fail_with(FROM_ARGUMENTS, place, &why) : 0;
}

bool make_unit(double v[3])
{
    const double length = sqrt(v[0]*v[0] + v[1]*v[1] + v[2]*v[2]);
    if (!(fabs(length - 1) <= 1e-3)) return false;
    for (int k = 0; k < 3; k++) v[k] /= length;
    return true;
}
