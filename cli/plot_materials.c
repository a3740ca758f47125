/* plot_materials.c: see plot_materials.h.
 * SPDX-License-Identifier: MIT */
#include "cli/plot_materials.h"

#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/report.h"

static const char blanks[] = " \t\n";

/* Cuts the text behind "plugin" into words: the file, and the parameters. */
static int read_plugin(const char *words, plot_spec *s)
{
    static const char form[] = "file=";
    char *rest = NULL;
    s->copy = strdup(words);
    if (!s->copy) return fail_memory();
    for (char *word = strtok_r(s->copy, blanks, &rest); word; word = strtok_r(NULL, blanks, &rest)) {
        if (strncmp(word, form, strlen(form)) == 0) {
            if (s->path) return fail(EXIT_USAGE, "SPEC", "file", "the key is given twice");
            s->path = word + strlen(form);
        } else {
            if (s->n_parameters == PLUGIN_PARAMETERS)
                return fail(EXIT_USAGE, "SPEC", "plugin", "has more than %d parameters", PLUGIN_PARAMETERS);
            s->parameters[s->n_parameters++] = word;
        }
    }
    if (!s->path || !*s->path)
        return fail(EXIT_USAGE, "SPEC", "plugin", "has no file; write `plugin file=FILE.so NAME=VALUE ...`");
    return 0;
}

/* What follows the first word, if it is `word`; NULL if it is another. */
static const char *behind(const char *text, const char *word)
{
    const size_t length = strlen(word);
    text += strspn(text, blanks);
    if (strncmp(text, word, length) != 0 || (text[length] && !strchr(blanks, text[length]))) return NULL;
    return text + length + strspn(text + length, blanks);
}

int plot_spec_read(const char *text, plot_spec *s)
{
    static const char form[] = "file=";
    *s = (plot_spec){.text = text};
    const char *rest = behind(text, "merl");
    if (rest) {
        if (strncmp(rest, form, strlen(form)) != 0 || !rest[strlen(form)])
            return fail(EXIT_USAGE, "SPEC", "merl", "has no file; write `merl file=FILE.binary`");
        s->kind = SPEC_MERL;
        s->path = rest + strlen(form);
        return 0;
    }
    if (!(rest = behind(text, "plugin"))) return 0;
    s->kind = SPEC_PLUGIN;
    return read_plugin(rest, s);
}

static void eval_measured(const void *self, const double wi[3], const double wo[3], double f[3])
{
    merl_eval(self, wi, wo, f);
}

int plot_spec_open(plot_spec *s, const char *label, plugin_watch *watch, figure_material *m)
{
    m->label = label;
    if (s->kind == SPEC_MATERIAL) {
        const int status = read_material(s->text, "SPEC", &m->material);
        return status ? status : prepare_bsdf64(s->text, "SPEC", &m->bsdf);
    }
    if (s->kind == SPEC_MERL) {
        facet_error why = {0};
        if (merl_read(s->path, &s->measured, &why)) return fail_with(FROM_INPUT, s->path, &why);
        m->foreign = (verify_subject){.self = &s->measured, .eval = eval_measured};
        return 0;
    }
    const int status = plugin_open(s->path, s->parameters, s->n_parameters, watch, &s->model);
    if (!status) m->foreign = plugin_subject(&s->model);
    return status;
}

void plot_spec_free(plot_spec *s)
{
    merl_free(&s->measured);
    free(s->copy);
}
