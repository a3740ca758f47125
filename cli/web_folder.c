/* web_folder.c: the files of one folder, for a web server.
 * SPDX-License-Identifier: MIT */
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/report.h"
#include "cli/web_server.h"

enum { MOST_BYTES = 256 << 20, MOST_PATH = 1024 };

void web_send_text(web_request *request, int status, const char *text)
{
    web_send(request, status, "text/plain; charset=utf-8", text, strlen(text));
}

static const char *type_of(const char *path)
{
    static const char *const types[][2] = {{"html", "text/html; charset=utf-8"},
                                           {"js", "text/javascript; charset=utf-8"},
                                           {"mjs", "text/javascript; charset=utf-8"},
                                           {"css", "text/css; charset=utf-8"},
                                           {"json", "application/json"},
                                           {"wasm", "application/wasm"},
                                           {"svg", "image/svg+xml"},
                                           {"png", "image/png"},
                                           {"jpg", "image/jpeg"},
                                           {"ico", "image/x-icon"},
                                           {"txt", "text/plain; charset=utf-8"},
                                           {"glsl", "text/plain; charset=utf-8"},
                                           {"glb", "model/gltf-binary"},
                                           {"gltf", "model/gltf+json"}};
    for (size_t i = 0; i < sizeof types/sizeof *types; i++)
        if (has_extension(path, types[i][0])) return types[i][1];
    return "application/octet-stream";
}

/* Whether each part of the path is an ordinary name: no `..`, no hidden file, nothing that another system would take
 * for a separator. */
static bool is_plain(const char *path)
{
    if (path[0] != '/' || strlen(path) >= MOST_PATH) return false;
    for (const char *c = path; *c; c++)
        if (*c == '\\' || *c == ':' || (unsigned char)*c < 32 || (c[0] == '/' && c[1] == '.')) return false;
    return true;
}

/* Opens a file below a folder, one name at a time, following no link.  -1: there is none. */
static int open_below(const char *folder, const char *path)
{
    char names[MOST_PATH + 16], *rest = NULL;
    snprintf(names, sizeof names, "%s%s", path, path[strlen(path) - 1] == '/' ? "index.html" : "");
    int file = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    for (char *name = strtok_r(names, "/", &rest); file >= 0 && name; name = strtok_r(NULL, "/", &rest)) {
        const int next = openat(file, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
        close(file);
        file = next;
    }
    return file;
}

/* Reads a regular file of at most MOST_BYTES, the caller's to free; NULL: it is none. */
static char *read_file(int file, size_t *n)
{
    struct stat information;
    if (fstat(file, &information) || !S_ISREG(information.st_mode) || information.st_size > MOST_BYTES) return NULL;
    const size_t size = (size_t)information.st_size;
    char *bytes = malloc(size ? size : 1);
    for (*n = 0; bytes && *n < size;) {
        const ssize_t got = read(file, bytes + *n, size - *n);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        *n += (size_t)got;
    }
    return bytes;
}

void web_serve_folder(void *user, web_request *request)
{
    const char *folder = user, *path = web_path(request);
    if (!web_is_method(request, "GET") && !web_is_method(request, "HEAD")) {
        web_send_text(request, 405, "only GET\n");
        return;
    }
    const int file = is_plain(path) ? open_below(folder, path) : -1;
    size_t n = 0;
    char *bytes = file >= 0 ? read_file(file, &n) : NULL;
    if (file >= 0) close(file);
    if (bytes) web_send(request, 200, type_of(path[strlen(path) - 1] == '/' ? "index.html" : path), bytes, n);
    else web_send_text(request, 404, "there is no such file\n");
    free(bytes);
}
