/* models.c: the table of models and parameters, and materials as text.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "facet/facet.h"

#include "error.h"
#include "material.h"
#define FACET_PARAMETERS
#include "model_table.h"

#define INFO_ROW(name, kernel, summary, source)                                                                        \
    {#name, summary, source, sizeof name##_parameters/sizeof name##_parameters[0], name##_parameters},
static const facet_model_info models[] = {FACET_MODELS(INFO_ROW)};

#define FITS_ROW(name, kernel, summary, source)                                                                        \
    _Static_assert(sizeof name##_parameters/sizeof name##_parameters[0] <= FACET_MAX_PARAMETERS, #name);
FACET_MODELS(FITS_ROW)

/* Parameters that say the same thing in two ways: at most one side may be given. */
static const char *const exclusive[][2] = {{"alpha", "alpha_x"},
                                           {"alpha", "alpha_y"},
                                           {"exponent", "alpha"},
                                           {"exponent", "alpha_x"},
                                           {"exponent", "alpha_y"},
                                           {"ks", "ior"},
                                           {"ks", "metal"},
                                           {"ks", "eta"},
                                           {"ks", "k"},
                                           {"f82", "ior"},
                                           {"f82", "metal"},
                                           {"f82", "eta"},
                                           {"f82", "k"},
                                           {"ior", "metal"},
                                           {"ior", "eta"},
                                           {"ior", "k"},
                                           {"metal", "eta"},
                                           {"metal", "k"}};

/* Parameters that mean nothing without each other. */
static const char *const together[][2] = {{"eta", "k"}, {"k", "eta"}};

size_t facet_model_count(void)
{
    return sizeof models/sizeof models[0];
}

const facet_model_info *facet_model_get(size_t i)
{
    return i < facet_model_count() ? &models[i] : NULL;
}

int facet_material_index(const facet_material *material, const char *name)
{
    const facet_model_info *model = &models[material->model];
    for (size_t i = 0; i < model->n_parameters; i++)
        if (strcmp(model->parameters[i].name, name) == 0) return (int)i;
    return -1;
}

double facet_material_value(const facet_material *material, const char *name, int k)
{
    return material->values[facet_material_index(material, name)][k];
}

int facet_material_given(const facet_material *material, const char *name)
{
    const int i = facet_material_index(material, name);
    return i >= 0 && (material->given >> i & 1);
}

static size_t value_count(const facet_parameter *parameter)
{
    return parameter->kind == FACET_COLOUR ? 3 : 1;
}

/* One value against its range; `not >=` so that NaN fails. */
static facet_status check_value(const facet_parameter *parameter, double value, facet_error *why)
{
    const int is_in_range = value >= parameter->low && value <= parameter->high &&
                            (parameter->kind != FACET_CHOICE || value == floor(value));
    if (is_in_range) return FACET_OK;
    if (parameter->kind == FACET_CHOICE)
        return facet_error_set(why, FACET_BAD_VALUE, parameter->name, "%g is not a choice; give one of %s", value,
                               parameter->choices);
    return facet_error_set(why, FACET_BAD_VALUE, parameter->name, "%g is out of range; give %s in [%g, %g]", value,
                           parameter->kind == FACET_COLOUR ? "numbers" : "a number", parameter->low, parameter->high);
}

/* "a, b, c" for a message, cut at the buffer's end. */
static void list_names(char *text, size_t size, const facet_model_info *model)
{
    size_t used = 0;
    const size_t n = model ? model->n_parameters : facet_model_count();
    text[0] = 0;
    for (size_t i = 0; i < n && used < size; i++) {
        const char *name = model ? model->parameters[i].name : models[i].name;
        used += (size_t)snprintf(text + used, size - used, "%s%s", i ? ", " : "", name);
    }
}

static facet_status find_model(const char *name, size_t length, size_t *index, facet_error *why)
{
    for (size_t i = 0; i < facet_model_count(); i++)
        if (strlen(models[i].name) == length && memcmp(models[i].name, name, length) == 0) {
            *index = i;
            return FACET_OK;
        }
    char names[160];
    list_names(names, sizeof names, NULL);
    if (length == 0) return facet_error_set(why, FACET_BAD_SYNTAX, "", "no model; give one of %s", names);
    return facet_error_set(why, FACET_UNKNOWN_NAME, "", "no model is called '%.*s'; give one of %s",
                           (int)(length < 32 ? length : 32), name, names);
}

static void fill_defaults(size_t model, facet_material *material)
{
    *material = (facet_material){.struct_size = sizeof *material, .model = model};
    for (size_t i = 0; i < models[model].n_parameters; i++)
        memcpy(material->values[i], models[model].parameters[i].initial, sizeof material->values[i]);
}

facet_status facet_material_defaults(const char *name, facet_material *material, facet_error *why)
{
    if (!name || !material) return facet_error_set(why, FACET_BAD_ARGUMENT, "", "a pointer is NULL");
    size_t model;
    const facet_status status = find_model(name, strlen(name), &model, why);
    if (status == FACET_OK) fill_defaults(model, material);
    return status;
}

/* Refuses parameter i if one that says the same thing is already given. */
static facet_status check_exclusive(const facet_material *material, const char *name, facet_error *why)
{
    for (size_t i = 0; i < sizeof exclusive/sizeof exclusive[0]; i++)
        for (int side = 0; side < 2; side++)
            if (strcmp(name, exclusive[i][side]) == 0 && facet_material_given(material, exclusive[i][!side]))
                return facet_error_set(why, FACET_BAD_VALUE, name, "'%s' is given as well; give one of the two",
                                       exclusive[i][!side]);
    return FACET_OK;
}

facet_status facet_material_set(facet_material *material, const char *name, const double *values, size_t n_values,
                                facet_error *why)
{
    if (!material || !name || !values || material->struct_size != sizeof *material ||
        material->model >= facet_model_count())
        return facet_error_set(why, FACET_BAD_ARGUMENT, "", "the material was not filled by this library");
    const facet_model_info *model = &models[material->model];
    const int i = facet_material_index(material, name);
    if (i < 0) {
        char names[200];
        list_names(names, sizeof names, model);
        return facet_error_set(why, FACET_UNKNOWN_NAME, name, "%s has no such parameter; it has %s", model->name,
                               names);
    }
    const facet_parameter *parameter = &model->parameters[i];
    const size_t expected = value_count(parameter);
    if (n_values != expected && n_values != 1)
        return facet_error_set(why, FACET_BAD_SYNTAX, name, "%zu values; give %s", n_values,
                               expected == 3 ? "r,g,b or one number for a grey" : "one number");
    for (size_t k = 0; k < n_values; k++) {
        const facet_status status = check_value(parameter, values[k], why);
        if (status) return status;
    }
    const facet_status status = check_exclusive(material, name, why);
    if (status) return status;
    for (size_t k = 0; k < expected; k++) material->values[i][k] = values[n_values == 1 ? 0 : k];
    material->given |= 1u << i;
    return FACET_OK;
}

/* Refuses a parameter whose partner is missing; to be asked when all are set. */
static facet_status check_together(const facet_material *material, facet_error *why)
{
    for (size_t i = 0; i < sizeof together/sizeof together[0]; i++)
        if (facet_material_given(material, together[i][0]) && !facet_material_given(material, together[i][1]))
            return facet_error_set(why, FACET_BAD_VALUE, together[i][0], "'%s' is missing; give both", together[i][1]);
    return FACET_OK;
}

facet_status facet_material_check(const facet_material *material, facet_error *why)
{
    if (!material || material->struct_size != sizeof *material || material->model >= facet_model_count())
        return facet_error_set(why, FACET_BAD_ARGUMENT, "", "the material was not filled by this library");
    const facet_model_info *model = &models[material->model];
    for (size_t i = 0; i < model->n_parameters; i++)
        for (size_t k = 0; k < value_count(&model->parameters[i]); k++) {
            const facet_status status = check_value(&model->parameters[i], material->values[i][k], why);
            if (status) return status;
        }
    return check_together(material, why);
}

/* The index of `text` among "a|b|c", or -1. */
static int choice_index(const char *choices, const char *text)
{
    const size_t length = strlen(text);
    int index = 0;
    for (const char *c = choices;; index++) {
        const char *end = strchr(c, '|');
        const size_t n = end ? (size_t)(end - c) : strlen(c);
        if (n == length && memcmp(c, text, n) == 0) return index;
        if (!end) return -1;
        c = end + 1;
    }
}

/* Decimal numbers with '.', whatever the locale: digits, an optional fraction and exponent; "inf", "nan" and
 * hexadecimal are not numbers here.  Returns the number of characters read, 0 if none. */
static size_t number_length(const char *text)
{
    const char *p = text + (*text == '-' || *text == '+');
    size_t digits = 0;
    for (; *p >= '0' && *p <= '9'; p++) digits++;
    if (*p == '.')
        for (p++; *p >= '0' && *p <= '9'; p++) digits++;
    if (!digits) return 0;
    if (*p == 'e' || *p == 'E') {
        const char *q = p + 1 + (p[1] == '-' || p[1] == '+');
        if (*q >= '0' && *q <= '9') {
            while (*q >= '0' && *q <= '9') q++;
            p = q;
        }
    }
    return (size_t)(p - text);
}

/* The value of a number of that length.  strtod wants the decimal point of the program's locale, which printf shows. */
static double number_value(const char *text, size_t length)
{
    char half[16], copy[256];
    const int shown = snprintf(half, sizeof half, "%.1f", 0.5); /* "0.5", "0,5" */
    const size_t point_length = (size_t)shown - 2;
    size_t used = 0;
    for (size_t i = 0; i < length && used + point_length < sizeof copy; i++) {
        if (text[i] == '.') {
            memcpy(copy + used, half + 1, point_length);
            used += point_length;
        } else {
            copy[used++] = text[i];
        }
    }
    copy[used] = 0;
    return strtod(copy, NULL);
}

/* "a" or "a,b,c" into numbers; 0 on anything else. */
static size_t parse_numbers(const char *text, double values[3])
{
    for (size_t n = 0; n < 3; n++) {
        const size_t length = number_length(text);
        if (!length) return 0;
        values[n] = number_value(text, length);
        text += length;
        if (*text == 0) return n + 1;
        if (*text++ != ',') return 0;
    }
    return 0;
}

/* Sets one "key=value" word, already cut out of the text. */
static facet_status set_word(facet_material *material, char *word, facet_error *why)
{
    char *equals = strchr(word, '=');
    if (!equals || equals == word) return facet_error_set(why, FACET_BAD_SYNTAX, word, "not of the form key=value");
    *equals = 0;
    const char *value = equals + 1;
    const int i = facet_material_index(material, word);
    if (i >= 0 && (material->given >> i & 1))
        return facet_error_set(why, FACET_BAD_SYNTAX, word, "given twice; give it once");
    double values[3] = {0};
    size_t n = 0;
    if (i >= 0 && models[material->model].parameters[i].kind == FACET_CHOICE) {
        const char *choices = models[material->model].parameters[i].choices;
        const int choice = choice_index(choices, value);
        if (choice < 0)
            return facet_error_set(why, FACET_UNKNOWN_NAME, word, "'%.40s' is not a choice; give one of %s", value,
                                   choices);
        values[0] = choice;
        n = 1;
    } else if (i >= 0) {
        n = parse_numbers(value, values);
        if (n == 0) return facet_error_set(why, FACET_BAD_SYNTAX, word, "'%.40s' is not a number or r,g,b", value);
    }
    return facet_material_set(material, word, values, n, why);
}

facet_status facet_material_parse(const char *text, facet_material *material, facet_error *why)
{
    if (!text || !material) return facet_error_set(why, FACET_BAD_ARGUMENT, "", "a pointer is NULL");
    static const char blank[] = " \t\r\n";
    text += strspn(text, blank);
    size_t model;
    size_t length = strcspn(text, blank);
    facet_status status = find_model(text, length, &model, why);
    if (status) return status;
    facet_material parsed;
    fill_defaults(model, &parsed);
    for (;;) {
        text += length;
        text += strspn(text, blank);
        length = strcspn(text, blank);
        if (length == 0) break;
        char word[160];
        if (length >= sizeof word)
            return facet_error_set(why, FACET_BAD_SYNTAX, "", "a word of %zu characters; give key=value", length);
        memcpy(word, text, length);
        word[length] = 0;
        status = set_word(&parsed, word, why);
        if (status) return status;
    }
    status = check_together(&parsed, why);
    if (status == FACET_OK) *material = parsed;
    return status;
}
