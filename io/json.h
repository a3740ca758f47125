/* json.h: JSON text into a tree, and typed reads that know where they are.
 *
 * A json_place is a value in the tree together with the way to it, so that every complaint names its
 * place ("meshes[2].primitives[0].attributes.POSITION").  Places are small, live on the stack, and
 * borrow their parent and the tree.  A read of an absent member succeeds and leaves its output as it
 * was, so that outputs are set to their defaults first; a member of the wrong kind, not finite or out
 * of range is an error.  The first error is kept in the facet_error given to json_parse; every function
 * that returns bool returns false once it has put one there.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "facet/facet.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Arrays and objects nested deeper than this are refused. */
#define JSON_DEPTH_CAP 2048

typedef struct json_place {
    const struct json_place *parent; /* NULL at the root */
    const char *key;                 /* NULL for an element of an array */
    size_t index;                    /* of an element */
    const void *value;               /* NULL: absent */
    facet_error *why;
} json_place;

/* At least what json_parse takes in memory for a document [byte], told from its brackets and commas alone. */
size_t json_memory(const unsigned char *bytes, size_t size);

/* Strict RFC 8259: UTF-8, no byte order mark, no comments, no repeated keys, nothing after the document,
 * numbers within double range.  *root is the caller's to give to json_destroy; why is borrowed by all
 * places and must not be NULL. */
bool json_parse(const unsigned char *bytes, size_t size, json_place *root, facet_error *why);
void json_destroy(json_place *root);

/* Records an error at this place, unless there is one already.  Always false. */
bool json_fail(const json_place *place, facet_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Writes the path of the place, truncated to fit. */
void json_path(const json_place *place, char *text, size_t size);

/* The member or element; absent if there is none, or if the parent is absent or of another kind. */
json_place json_member(const json_place *object, const char *key);
json_place json_element(const json_place *array, size_t i);

/* Number of elements or members; 0 for anything else. */
size_t json_count(const json_place *place);

/* Walks an object's members: start with *iterator = NULL; false at the end. */
bool json_next(const json_place *object, void **iterator, json_place *member);

/* False, with an error, if the place is present and not of the kind. */
bool json_want_object(const json_place *place);
bool json_want_array(const json_place *place);
/* False, with an error, if the place is absent. */
bool json_want_present(const json_place *place);

/* json_member followed by json_want_object or json_want_array. */
bool json_read_object(const json_place *object, const char *key, json_place *member);
bool json_read_array(const json_place *object, const char *key, json_place *member);

/* low and high are inclusive. */
bool json_read_number(const json_place *object, const char *key, double low, double high, double *value);
bool json_read_float(const json_place *object, const char *key, double low, double high, float *value);
/* Exactly n numbers. */
bool json_read_numbers(const json_place *object, const char *key, size_t n, double low, double high, double *values);
bool json_read_floats(const json_place *object, const char *key, size_t n, double low, double high, float *values);
/* A whole number from 0 to high. */
bool json_read_size(const json_place *object, const char *key, size_t high, size_t *value);
/* A whole number below count, which is the number of `what` ("accessors"). */
bool json_read_index(const json_place *object, const char *key, size_t count, const char *what, size_t *value);
bool json_read_bool(const json_place *object, const char *key, bool *value);
/* The text stays with the tree; it has no 0 byte inside. */
bool json_read_string(const json_place *object, const char *key, const char **value);

/* The place's own value, for elements: a number, a whole number below count, text.  Absent is an error. */
bool json_number_here(const json_place *place, double low, double high, double *value);
bool json_index_here(const json_place *place, size_t count, const char *what, size_t *value);
bool json_string_here(const json_place *place, const char **value);

typedef enum json_kind { JSON_KIND_NUMBER, JSON_KIND_STRING, JSON_KIND_ARRAY, JSON_KIND_OTHER } json_kind;
json_kind json_kind_here(const json_place *place);

#ifdef __cplusplus
}
#endif
