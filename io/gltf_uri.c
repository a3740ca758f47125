/* gltf_uri.c: what a URI in a glTF file may name: data inside the URI, or a file in or below the glTF
 * file's own folder.  [gltf, section 2.8], RFC 3986, RFC 4648 section 4.
 *
 * A path is taken literally after percent-decoding.  It must be relative, must not climb out of the
 * folder with "..", and has no scheme; symbolic links are followed if they stay in the folder, too.  What leads outside
 * is read only if gltf.allows_outside; then so are absolute paths and file: URIs (RFC 8089, of this machine).
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "core/error.h"
#include "io/file.h"
#include "io/gltf_internal.h"

/* The value of a base64 digit, or -1. */
static int base64_digit(char c)
{
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/* Strict: whole groups of four, '=' only at the end, unused bits zero. */
static bool decode_base64(gltf *g, const json_place *place, const char *text, unsigned char **bytes, size_t *size)
{
    const size_t length = strlen(text);
    if (length%4 != 0)
        return json_fail(place, FACET_BAD_FILE, "base64 of %zu digits; must be a multiple of 4", length);
    size_t padding = 0;
    while (padding < 2 && padding < length && text[length - 1 - padding] == '=') padding++;
    const size_t n = length/4*3 - padding;
    if (!gltf_claim(g, place, n, 1)) return false;
    unsigned char *out = malloc(length/4*3 + 1);
    if (!out) return json_fail(place, FACET_NO_MEMORY, "out of memory");
    uint32_t group = 0;
    for (size_t i = 0; i < length; i++) {
        const int digit = i + padding >= length ? 0 : base64_digit(text[i]);
        if (digit < 0) {
            free(out);
            return json_fail(place, FACET_BAD_FILE, "base64 has an invalid digit at its byte %zu", i);
        }
        group = group << 6 | (uint32_t)digit;
        if (i%4 == 3) {
            unsigned char *at = out + i/4*3;
            at[0] = (unsigned char)(group >> 16);
            at[1] = (unsigned char)(group >> 8);
            at[2] = (unsigned char)group;
        }
    }
    if (padding && (group & (padding == 1 ? 0xFFu : 0xFFFFu))) {
        free(out);
        return json_fail(place, FACET_BAD_FILE, "base64 ends in bits that belong to no byte");
    }
    out[n] = 0;
    *bytes = out;
    *size = n;
    return true;
}

/* data:[<type>][;parameter]*;base64,<digits> */
static bool read_data_uri(gltf *g, const json_place *place, const char *uri, unsigned char **bytes, size_t *size)
{
    static const char marker[] = ";base64";
    const char *comma = strchr(uri, ',');
    if (!comma) return json_fail(place, FACET_BAD_FILE, "data URI without a comma before its data");
    const size_t marker_length = sizeof marker - 1;
    if ((size_t)(comma - uri) < marker_length || strncmp(comma - marker_length, marker, marker_length) != 0)
        return json_fail(place, FACET_BAD_FILE, "data URI is not base64; must be data:TYPE;base64,DIGITS");
    return decode_base64(g, place, comma + 1, bytes, size);
}

/* RFC 3986: ALPHA *(ALPHA / DIGIT / "+" / "-" / ".") ":" */
static bool has_scheme(const char *uri)
{
    const char *c = uri;
    while ((*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') ||
           (c != uri && ((*c >= '0' && *c <= '9') || *c == '+' || *c == '-' || *c == '.')))
        c++;
    return c != uri && *c == ':';
}

static int hex_digit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* Decodes %XX into `out`, which has room for strlen(uri) + 1. */
static bool decode_percent(const json_place *place, const char *uri, char *out)
{
    for (; *uri; uri++) {
        char c = *uri;
        if (c == '%') {
            const int high = hex_digit(uri[1]), low = high < 0 ? -1 : hex_digit(uri[2]);
            if (low < 0) return json_fail(place, FACET_BAD_FILE, "'%%' must be followed by two hexadecimal digits");
            c = (char)(high*16 + low);
            uri += 2;
        }
        if ((unsigned char)c < 0x20) return json_fail(place, FACET_BAD_FILE, "a control character in a file name");
        if (c == '\\') return json_fail(place, FACET_BAD_FILE, "a backslash in a path; folders are separated by '/'");
        *out++ = c;
    }
    *out = 0;
    return true;
}

/* False if the relative path climbs above its start at any point. */
static bool stays_inside(const char *path)
{
    long depth = 0;
    while (*path) {
        const size_t length = strcspn(path, "/");
        if (length == 2 && path[0] == '.' && path[1] == '.') depth--;
        else if (length > 0 && !(length == 1 && path[0] == '.')) depth++;
        if (depth < 0) return false;
        path += length + (path[length] == '/');
    }
    return true;
}

static bool is_outside(const json_place *place, const char *name)
{
    return json_fail(place, FACET_UNSUPPORTED,
                     "\"%.80s\" is not inside the scene's own folder; --allow-outside lets it be read", name);
}

/* The path's own file, once it is sure to lie inside.  What was checked is what is opened: a path without links. */
static facet_status read_inside(gltf *g, const char *path, const json_place *place, unsigned char **bytes, size_t *size,
                                facet_error *why)
{
    char *folder = strndup(g->path, g->folder_length), *resolved = NULL;
    bool is_inside = false;
    facet_status status = FACET_OK;
    if (!folder) status = facet_error_set(why, FACET_NO_MEMORY, "", "no memory for a path");
    if (!status) status = file_resolve(folder, path, &resolved, &is_inside, why);
    if (!status && !is_inside) is_outside(place, path + g->folder_length);
    else if (!status) status = file_read_within(resolved, gltf_memory_left(g), bytes, size, why);
    free(resolved);
    free(folder);
    return status;
}

/* name: decoded, relative to the scene's folder unless it begins with '/'. */
static bool read_file(gltf *g, const json_place *place, const char *name, unsigned char **bytes, size_t *size)
{
    const size_t start = name[0] == '/' ? 0 : g->folder_length;
    char *path = malloc(start + strlen(name) + 1);
    facet_error problem = {0};
    if (!path) return gltf_no_memory(place);
    memcpy(path, g->path, start);
    strcpy(path + start, name);
    const facet_status status = g->allows_outside ? file_read_within(path, gltf_memory_left(g), bytes, size, &problem)
                                                  : read_inside(g, path, place, bytes, size, &problem);
    if (!status && !place->why->status && g->on_file) g->on_file(g->user, path);
    free(path);
    return !place->why->status &&
           (!status || json_fail(place, status, "\"%.80s\": %s%s", name, problem.text,
                                 status == FACET_UNSUPPORTED ? "; --max-memory SIZE sets another limit" : ""));
}

static bool read_file_uri(gltf *g, const json_place *place, const char *uri, unsigned char **bytes, size_t *size)
{
    char *name = calloc(strlen(uri) + 1, 1);
    if (!name) return gltf_no_memory(place);
    bool is_read = decode_percent(place, uri, name);
    if (is_read && !name[0]) is_read = json_fail(place, FACET_BAD_FILE, "is empty; it must name a file");
    if (is_read && !g->allows_outside && (name[0] == '/' || !stays_inside(name))) is_read = is_outside(place, name);
    is_read = is_read && read_file(g, place, name, bytes, size);
    free(name);
    return is_read;
}

/* The path of a file: URI, or NULL if it is none of this machine. */
static const char *file_scheme_path(const char *uri)
{
    if (strncasecmp(uri, "file:/", 6) != 0) return NULL;
    uri += 5;
    if (strncmp(uri, "//", 2) != 0) return uri; /* file:/path */
    uri += 2;
    if (strncasecmp(uri, "localhost/", 10) == 0) uri += 9;
    return *uri == '/' ? uri : NULL;
}

bool gltf_read_uri(gltf *g, const json_place *place, unsigned char **bytes, size_t *size)
{
    const char *uri;
    if (!json_string_here(place, &uri)) return false;
    if (strncmp(uri, "data:", 5) == 0) return read_data_uri(g, place, uri, bytes, size);
    const char *path = has_scheme(uri) ? file_scheme_path(uri) : uri;
    if (!path)
        return json_fail(place, FACET_UNSUPPORTED, "\"%.80s\": only data URIs and files of this machine are read", uri);
    if (path != uri && !g->allows_outside) return is_outside(place, uri);
    if (!read_file_uri(g, place, path, bytes, size)) return false;
    if (gltf_take_input(g, place, *bytes, *size)) return true;
    free(*bytes);
    *bytes = NULL;
    return false;
}
