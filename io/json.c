/* json.c: JSON through jansson, which is strict about syntax, UTF-8 and depth; the typed reads are ours.
 *
 * Numbers are read as doubles: every whole number that glTF allows (below 2^53) is exact, and `100.0` is
 * as good as `100`.  A number above the double range is a syntax error to jansson.
 * SPDX-License-Identifier: MIT */
#include "io/json.h"

#include <float.h>
#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "core/error.h"

#if JSON_PARSER_MAX_DEPTH > JSON_DEPTH_CAP
#error "jansson was built to nest deeper than io/json.h promises"
#endif

/* Whole numbers up to here are exact in a double. */
#define WHOLE_NUMBER_CAP 9007199254740991.0

/* Upper bounds of what jansson takes for each value, with its place in an array that doubles; for each pair of an
 * object besides, with the table that doubles; and for each array and object, with the first element, which no comma
 * announces. */
enum { VALUE_MEMORY = 104, PAIR_MEMORY = 96, ARRAY_MEMORY = 256, OBJECT_MEMORY = 352 };

size_t json_memory(const unsigned char *bytes, size_t size)
{
    size_t sum = size; /* the texts */
    bool is_in_string = false;
    for (size_t i = 0; i < size; i++) {
        const unsigned char c = bytes[i];
        if (c == '"') is_in_string = !is_in_string;
        else if (is_in_string) i += c == '\\';
        else
            sum += c == ','   ? VALUE_MEMORY
                   : c == ':' ? PAIR_MEMORY
                   : c == '[' ? ARRAY_MEMORY
                   : c == '{' ? OBJECT_MEMORY
                              : 0;
    }
    return sum;
}

bool json_parse(const unsigned char *bytes, size_t size, json_place *root, facet_error *why)
{
    *root = (json_place){.why = why};
    if (size >= 3 && memcmp(bytes, "\xEF\xBB\xBF", 3) == 0)
        return json_fail(root, FACET_BAD_FILE, "starts with a byte order mark; JSON must start with its first value");
    json_error_t problem;
    const size_t flags = JSON_REJECT_DUPLICATES | JSON_DECODE_ANY | JSON_DECODE_INT_AS_REAL;
    root->value = json_loadb((const char *)bytes, size, flags, &problem);
    if (root->value) return true;
    if (json_error_code(&problem) == json_error_out_of_memory)
        return json_fail(root, FACET_NO_MEMORY, "out of memory while reading JSON");
    char place[sizeof why->place];
    /* jansson names its own flag, which nobody who reads the file can set */
    const bool is_nul = json_error_code(&problem) == json_error_null_character ||
                        json_error_code(&problem) == json_error_null_byte_in_key;
    snprintf(place, sizeof place, "line %d, column %d", problem.line, problem.column);
    facet_error_set(why, FACET_BAD_FILE, place, "not valid JSON: %s",
                    is_nul ? "\\u0000, the character that ends texts, cannot be part of one" : problem.text);
    return false;
}

void json_destroy(json_place *root)
{
    json_decref((json_t *)root->value);
    root->value = NULL;
}

void json_path(const json_place *place, char *text, size_t size)
{
    /* Built from its end, so that what does not fit is lost at the front. */
    char path[256];
    size_t start = sizeof path - 1;
    path[start] = 0;
    for (; place && (place->parent || place->key); place = place->parent) {
        char step[80];
        const bool is_first = !place->parent || (!place->parent->parent && !place->parent->key);
        if (place->key) snprintf(step, sizeof step, "%s%s", is_first ? "" : ".", place->key);
        else snprintf(step, sizeof step, "[%zu]", place->index);
        const size_t length = strlen(step);
        if (length > start) break;
        start -= length;
        memcpy(path + start, step, length);
    }
    snprintf(text, size, "%s", path + start);
}

bool json_fail(const json_place *place, facet_status status, const char *format, ...)
{
    if (place->why->status) return false;
    char path[sizeof place->why->place], text[sizeof place->why->text];
    json_path(place, path, sizeof path);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    facet_error_set(place->why, status, path, "%s", text);
    return false;
}

json_place json_member(const json_place *object, const char *key)
{
    const void *value = object->value ? json_object_get(object->value, key) : NULL;
    return (json_place){.parent = object, .key = key, .value = value, .why = object->why};
}

json_place json_element(const json_place *array, size_t i)
{
    const void *value = array->value ? json_array_get(array->value, i) : NULL;
    return (json_place){.parent = array, .index = i, .value = value, .why = array->why};
}

size_t json_count(const json_place *place)
{
    if (json_is_array((const json_t *)place->value)) return json_array_size(place->value);
    return json_is_object((const json_t *)place->value) ? json_object_size(place->value) : 0;
}

bool json_next(const json_place *object, void **iterator, json_place *member)
{
    json_t *value = (json_t *)object->value;
    if (!json_is_object(value)) return false;
    *iterator = *iterator ? json_object_iter_next(value, *iterator) : json_object_iter(value);
    if (!*iterator) return false;
    *member = (json_place){.parent = object,
                           .key = json_object_iter_key(*iterator),
                           .value = json_object_iter_value(*iterator),
                           .why = object->why};
    return true;
}

static const char *kind_name(const json_place *place)
{
    switch (json_typeof((const json_t *)place->value)) {
    case JSON_OBJECT: return "an object";
    case JSON_ARRAY: return "an array";
    case JSON_STRING: return "a string";
    case JSON_INTEGER:
    case JSON_REAL: return "a number";
    case JSON_TRUE:
    case JSON_FALSE: return "a boolean";
    default: return "null";
    }
}

static bool wrong_kind(const json_place *place, const char *wanted)
{
    if (!place->value) return json_want_present(place);
    return json_fail(place, FACET_BAD_FILE, "is %s; must be %s", kind_name(place), wanted);
}

bool json_want_object(const json_place *place)
{
    return !place->value || json_is_object((const json_t *)place->value) || wrong_kind(place, "an object");
}

bool json_want_array(const json_place *place)
{
    return !place->value || json_is_array((const json_t *)place->value) || wrong_kind(place, "an array");
}

bool json_want_present(const json_place *place)
{
    return place->value || json_fail(place, FACET_BAD_FILE, "is missing; it is required");
}

bool json_read_object(const json_place *object, const char *key, json_place *member)
{
    *member = json_member(object, key);
    return json_want_object(member);
}

bool json_read_array(const json_place *object, const char *key, json_place *member)
{
    *member = json_member(object, key);
    return json_want_array(member);
}

bool json_number_here(const json_place *place, double low, double high, double *value)
{
    if (!json_is_number((const json_t *)place->value)) return wrong_kind(place, "a number");
    const double number = json_number_value(place->value);
    if (!isfinite(number)) return json_fail(place, FACET_BAD_VALUE, "is not finite");
    if (!(number >= low && number <= high)) {
        if (low <= -FLT_MAX) return json_fail(place, FACET_BAD_VALUE, "is %.9g; must be at most %.9g", number, high);
        if (high >= FLT_MAX) return json_fail(place, FACET_BAD_VALUE, "is %.9g; must be at least %.9g", number, low);
        return json_fail(place, FACET_BAD_VALUE, "is %.9g; must be from %.9g to %.9g", number, low, high);
    }
    *value = number;
    return true;
}

/* A whole number from 0 to high. */
static bool whole_here(const json_place *place, double high, double *value)
{
    double number = 0;
    if (!json_number_here(place, -INFINITY, INFINITY, &number)) return false;
    if (number != floor(number)) return json_fail(place, FACET_BAD_VALUE, "is %.9g; must be a whole number", number);
    if (number < 0) return json_fail(place, FACET_BAD_VALUE, "is %.9g; must not be negative", number);
    if (number > WHOLE_NUMBER_CAP || number > high)
        return json_fail(place, FACET_BAD_VALUE, "is %.17g; must be at most %.17g", number,
                         high < WHOLE_NUMBER_CAP ? high : WHOLE_NUMBER_CAP);
    *value = number;
    return true;
}

bool json_index_here(const json_place *place, size_t count, const char *what, size_t *value)
{
    double number = 0;
    if (!whole_here(place, WHOLE_NUMBER_CAP, &number)) return false;
    if (number >= (double)count)
        return json_fail(place, FACET_BAD_VALUE, "is %.17g, but the number of %s is %zu", number, what, count);
    *value = (size_t)number;
    return true;
}

bool json_string_here(const json_place *place, const char **value)
{
    if (!json_is_string((const json_t *)place->value)) return wrong_kind(place, "a string");
    *value = json_string_value(place->value);
    return true;
}

json_kind json_kind_here(const json_place *place)
{
    if (json_is_number((const json_t *)place->value)) return JSON_KIND_NUMBER;
    if (json_is_string((const json_t *)place->value)) return JSON_KIND_STRING;
    return json_is_array((const json_t *)place->value) ? JSON_KIND_ARRAY : JSON_KIND_OTHER;
}

bool json_read_number(const json_place *object, const char *key, double low, double high, double *value)
{
    const json_place place = json_member(object, key);
    return !place.value || json_number_here(&place, low, high, value);
}

bool json_read_numbers(const json_place *object, const char *key, size_t n, double low, double high, double *values)
{
    json_place place;
    if (!json_read_array(object, key, &place)) return false;
    if (!place.value) return true;
    if (json_count(&place) != n)
        return json_fail(&place, FACET_BAD_FILE, "has %zu numbers; must have %zu", json_count(&place), n);
    for (size_t i = 0; i < n; i++) {
        const json_place element = json_element(&place, i);
        if (!json_number_here(&element, low, high, &values[i])) return false;
    }
    return true;
}

static double clip(double value, double limit)
{
    return value < -limit ? -limit : value > limit ? limit : value;
}

bool json_read_float(const json_place *object, const char *key, double low, double high, float *value)
{
    double number = *value;
    if (!json_read_number(object, key, clip(low, FLT_MAX), clip(high, FLT_MAX), &number)) return false;
    *value = (float)number;
    return true;
}

bool json_read_floats(const json_place *object, const char *key, size_t n, double low, double high, float *values)
{
    double numbers[16] = {0};
    const json_place place = json_member(object, key);
    if (n > sizeof numbers/sizeof *numbers) return json_fail(&place, FACET_BAD_ARGUMENT, "is read as %zu numbers", n);
    if (!json_read_numbers(object, key, n, clip(low, FLT_MAX), clip(high, FLT_MAX), numbers)) return false;
    for (size_t i = 0; place.value && i < n; i++) values[i] = (float)numbers[i];
    return true;
}

bool json_read_size(const json_place *object, const char *key, size_t high, size_t *value)
{
    const json_place place = json_member(object, key);
    double number = 0;
    if (!place.value) return true;
    if (!whole_here(&place, (double)high, &number)) return false;
    *value = (size_t)number;
    return true;
}

bool json_read_index(const json_place *object, const char *key, size_t count, const char *what, size_t *value)
{
    const json_place place = json_member(object, key);
    return !place.value || json_index_here(&place, count, what, value);
}

bool json_read_bool(const json_place *object, const char *key, bool *value)
{
    const json_place place = json_member(object, key);
    if (!place.value) return true;
    if (!json_is_boolean((const json_t *)place.value)) return wrong_kind(&place, "true or false");
    *value = json_is_true((const json_t *)place.value);
    return true;
}

bool json_read_string(const json_place *object, const char *key, const char **value)
{
    const json_place place = json_member(object, key);
    return !place.value || json_string_here(&place, value);
}
