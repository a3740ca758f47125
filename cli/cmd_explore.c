/* cmd_explore.c: `facet explore`, where the explorer's page is, and how to look at it.
 *
 * The page is a folder of files that any static server shows.  It is beside the program where that is installed, in
 * share/facet/web, and in build/web where it was built.
 * SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/commands.h"
#include "cli/report.h"

typedef struct settings {
    uint64_t port;
} settings;

/* The folder of the program's own file; false if the system does not tell. */
static bool program_folder(char folder[PATH_MAX])
{
    const ssize_t n = readlink("/proc/self/exe", folder, PATH_MAX - 1);
    if (n <= 0) return false;
    folder[n] = 0;
    char *const slash = strrchr(folder, '/');
    if (slash) *slash = 0;
    return slash != NULL;
}

/* The folder with the page, without links and dots; NULL if there is none. */
static char *find_page(void)
{
    static const char *const places[] = {"../share/facet/web", "../web"};
    char folder[PATH_MAX], path[2*PATH_MAX];
    if (!program_folder(folder)) return NULL;
    for (size_t i = 0; i < sizeof places/sizeof *places; i++) {
        snprintf(path, sizeof path, "%s/%s/index.html", folder, places[i]);
        if (access(path, R_OK) != 0) continue;
        *strrchr(path, '/') = 0;
        return realpath(path, NULL);
    }
    return NULL;
}

static int run(int argc, char **argv)
{
    settings s = {.port = 8640};
    const int status = options_parse(&explore_command, argc, argv, &s, NULL);
    if (status != PARSE_GO) return status;
    char *const page = find_page();
    if (!page)
        return fail(EXIT_WORLD, NULL, NULL,
                    "the explorer's page is not there; `make web` builds it, `cmake --install` installs it");
    printf("page:  %s/index.html\n", page);
    printf("serve: python3 -m http.server --bind 127.0.0.1 --directory '%s' %" PRIu64 "\n", page, s.port);
    printf("open:  http://127.0.0.1:%" PRIu64 "/\n", s.port);
    free(page);
    return finish_stdout(0);
}

static const option options[] = {
    {"port", 0, OPTION_INTEGER, offsetof(settings, port), "P", "the port of the address (default 8640)", 1, 65535,
     NULL},
};

const command explore_command = {
    .name = "explore",
    .summary = "look at materials in the browser",
    .operands = "",
    .description =
        "The explorer is a static page: materials as curves, lobes, slices, samples and lit objects, computed\n"
        "in the browser by libfacet.  Prints where its files are, a command that serves them to this machine\n"
        "alone, and the address to open then.  Any other static server does, too.\n",
    .options = options,
    .n_options = sizeof options/sizeof *options,
    .examples = "  facet explore\n  facet explore --port 9000\n",
    .run = run,
};
