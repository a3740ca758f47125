/* cmd_materials.c: `facet materials`, the models and their parameters, from the library's own table.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/json_writer.h"
#include "cli/report.h"
#include "cli/suggest.h"

typedef struct settings {
    bool json;
} settings;

/* The i-th of the names in "a|b|c"; returns its length. */
static int choice_name(const char *choices, size_t i, const char **name)
{
    *name = choices;
    for (; i > 0; i--) *name += strcspn(*name, "|") + 1;
    return (int)strcspn(*name, "|");
}

static void print_default(const facet_parameter *p, char *text, size_t size)
{
    const char *name;
    if (p->kind == FACET_CHOICE) {
        const int length = choice_name(p->choices, (size_t)p->initial[0], &name);
        snprintf(text, size, "%.*s", length, name);
    } else if (p->kind == FACET_COLOUR && !(p->initial[0] == p->initial[1] && p->initial[0] == p->initial[2])) {
        snprintf(text, size, "%.6g,%.6g,%.6g", p->initial[0], p->initial[1], p->initial[2]);
    } else {
        snprintf(text, size, "%.6g", p->initial[0]);
    }
}

static void print_model(const facet_model_info *model)
{
    printf("%s: %s\n  source: %s\n", model->name, model->summary, model->source);
    for (size_t i = 0; i < model->n_parameters; i++) {
        const facet_parameter *p = &model->parameters[i];
        static const char *const kinds[] = {"number", "colour", "choice"};
        char initial[80], range[64] = "";
        print_default(p, initial, sizeof initial);
        if (p->kind != FACET_CHOICE) snprintf(range, sizeof range, "%g to %g", p->low, p->high);
        printf("  %-20s %-7s default %-12s %-16s %s", p->name, kinds[p->kind], initial, range, p->description);
        if (p->kind == FACET_CHOICE) printf(": %s", p->choices);
        else if (strcmp(p->unit, "1") != 0) printf(" [%s]", p->unit);
        putchar('\n');
    }
}

static void write_parameter(json_writer *j, const facet_parameter *p)
{
    static const char *const kinds[] = {"number", "colour", "choice"};
    json_put_open(j, NULL, '{');
    json_put_text(j, "name", p->name);
    json_put_text(j, "kind", kinds[p->kind]);
    if (p->kind == FACET_CHOICE) {
        char text[80];
        print_default(p, text, sizeof text);
        json_put_text(j, "default", text);
        json_put_open(j, "choices", '[');
        for (size_t i = 0; i <= (size_t)p->high; i++) {
            const char *name;
            const int length = choice_name(p->choices, i, &name);
            snprintf(text, sizeof text, "%.*s", length, name);
            json_put_text(j, NULL, text);
        }
        json_put_close(j, ']');
    } else {
        json_put_number(j, "low", p->low);
        json_put_number(j, "high", p->high);
        json_put_numbers(j, "default", p->initial, p->kind == FACET_COLOUR ? 3 : 1);
        json_put_text(j, "unit", p->unit);
    }
    json_put_text(j, "description", p->description);
    json_put_close(j, '}');
}

static void write_model(json_writer *j, const facet_model_info *model)
{
    json_put_open(j, NULL, '{');
    json_put_text(j, "name", model->name);
    json_put_text(j, "summary", model->summary);
    json_put_text(j, "source", model->source);
    json_put_open(j, "parameters", '[');
    for (size_t i = 0; i < model->n_parameters; i++) write_parameter(j, &model->parameters[i]);
    json_put_close(j, ']');
    json_put_close(j, '}');
}

static int run(int argc, char **argv)
{
    settings s = {0};
    const char *name;
    const int status = options_parse(&materials_command, argc, argv, &s, &name);
    if (status != PARSE_GO) return status;
    bool is_found = !name;
    suggestion near = suggestion_start(name ? name : "");
    for (size_t i = 0; name && i < facet_model_count(); i++) {
        is_found = is_found || strcmp(name, facet_model_get(i)->name) == 0;
        suggestion_offer(&near, facet_model_get(i)->name);
    }
    if (!is_found) {
        const char *meant = suggestion_get(&near);
        if (meant) return fail(EXIT_USAGE, NULL, NULL, "there is no model `%s`; did you mean `%s`?", name, meant);
        return fail(EXIT_USAGE, NULL, NULL, "there is no model `%s`; `facet materials` lists the models", name);
    }
    json_writer j = json_put_start(stdout);
    if (s.json) json_put_open(&j, NULL, '[');
    for (size_t i = 0, n_printed = 0; i < facet_model_count(); i++) {
        const facet_model_info *model = facet_model_get(i);
        if (name && strcmp(name, model->name) != 0) continue;
        if (s.json) {
            write_model(&j, model);
        } else {
            if (n_printed++) putchar('\n');
            print_model(model);
        }
    }
    if (s.json) json_put_close(&j, ']');
    return finish_stdout(0);
}

static const option options[] = {
    {"json", 0, OPTION_FLAG, offsetof(settings, json), NULL, "print the table as JSON", 0, 0, NULL},
};

const command materials_command = {
    .name = "materials",
    .summary = "list the material models and their parameters",
    .operands = "[MODEL]",
    .max_operands = 1,
    .description = "A material is written as MODEL key=value ..., a colour as r,g,b or as one number for a grey.\n"
                   "The list gives each key's kind, default, range and meaning; [1] units are left out.\n",
    .examples = "  facet materials\n  facet materials ggx\n  facet materials --json\n",
    .options = options,
    .n_options = sizeof options/sizeof *options,
    .run = run,
};
