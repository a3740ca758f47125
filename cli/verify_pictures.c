/* verify_pictures.c: the pictures of `facet verify --plot`.
 * SPDX-License-Identifier: MIT */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/report.h"
#include "cli/verify_job.h"
#include "plot/pictures.h"

int pictures_prepare(const verify_options *o)
{
    const char *folder = o->pictures;
    facet_error why = {0};
    canvas *page = NULL;
    const facet_status status = canvas_create(CANVAS_PNG, 1, 1, 1, &page, &why);
    canvas_destroy(page);
    if (status) return fail_with(FROM_OUTPUT, NULL, &why);
    if (mkdir(folder, 0777) && errno != EEXIST)
        return fail(EXIT_WORLD, folder, NULL, "the folder cannot be made: %s", strerror(errno));
    struct stat information;
    if (stat(folder, &information) || !S_ISDIR(information.st_mode))
        return fail(EXIT_WORLD, folder, NULL, "is not a folder; name another one");
    if (access(folder, W_OK | X_OK))
        return fail(EXIT_WORLD, folder, NULL, "the folder cannot be written to: %s", strerror(errno));
    return 0;
}

/* The value of `energy` of a microfacet model, as a parameter table has it; false if the model has none. */
static bool find_energy(const facet_material *m, int *value)
{
    const facet_model_info *model = facet_model_get(m->model);
    for (size_t i = 0; i < model->n_parameters; i++)
        if (strcmp(model->parameters[i].name, "energy") == 0) {
            *value = (int)m->values[i][0];
            return true;
        }
    return false;
}

/* A material beside itself with the other treatment of light that is reflected several times, if it has one. */
typedef struct variants {
    facet_material material;
    facet_bsdf64 bsdf;
    verify_subject other;
    picture_subject items[2];
    size_t n;
} variants;

static void make_variants(variants *v, const verify_options *o, const verify_case *c, const verify_subject *subject)
{
    static const char *const names[] = {"energy=single", "energy=multi", "energy=scaled"};
    int energy = 0;
    v->items[0] = (picture_subject){"albedo", subject};
    v->n = 1;
    if (o->plugin || facet_material_parse(c->text, &v->material, NULL) || !find_energy(&v->material, &energy)) return;
    const double other = energy ? 0 : 1;
    if (facet_material_set(&v->material, "energy", &other, 1, NULL)) return;
    if (facet_bsdf64_prepare(&v->material, &v->bsdf, NULL)) return;
    v->other = verify_material(&v->material, &v->bsdf);
    v->items[0].label = names[energy];
    v->items[v->n++] = (picture_subject){names[energy ? 0 : 1], &v->other};
}

int pictures_draw(const verdicts *v, const verify_case *c, const verify_subject *subject,
                  const verify_settings *settings)
{
    const verify_options *o = v->o;
    char path[4096], title[512];
    case_title(o, c, title, sizeof title);
    const image_text texts[] = {
        {"Title", title}, {"facet:version", facet_version()}, {"facet:command", o->command_line}};
    const picture p = {path, title, texts, sizeof texts/sizeof *texts};
    const int digits = snprintf(NULL, 0, "%zu", v->n_cases);
    facet_error why = {0};
    facet_status status = FACET_OK;
    if (subject->sample && verify_is_chosen(o, VERIFY_CHI_SQUARE)) {
        snprintf(path, sizeof path, "%s/%0*zu-chi-square.png", o->pictures, digits, v->n_done + 1);
        status = picture_chi_square(&p, subject, settings, &why);
    }
    if (!status && (verify_is_chosen(o, VERIFY_FURNACE) || verify_is_chosen(o, VERIFY_WEAK_FURNACE))) {
        variants all;
        make_variants(&all, o, c, subject);
        snprintf(path, sizeof path, "%s/%0*zu-furnace.png", o->pictures, digits, v->n_done + 1);
        status = picture_furnace(&p, all.items, all.n, &why);
    }
    return status ? fail_with(FROM_OUTPUT, path, &why) : 0;
}
