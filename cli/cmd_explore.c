/* cmd_explore.c: `facet explore`, which serves the explorer's page to this machine.
 *
 * The page is a folder of files that any static server shows.  It is beside the program where that is installed, in
 * share/facet/web, and in build/web where it was built.
 * SPDX-License-Identifier: MIT */
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "cli/commands.h"
#include "cli/interruption.h"
#include "cli/report.h"
#include "cli/web_server.h"

enum { DEFAULT_PORT = 8640 };

typedef struct settings {
    uint64_t port;
    bool stays_closed, is_path_wanted;
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

/* Opens the address in the user's browser where there is a desktop; how that goes is the browser's to tell. */
static void open_browser(const char *address)
{
    if (!getenv("DISPLAY") && !getenv("WAYLAND_DISPLAY")) return;
    const pid_t child = fork();
    if (child != 0) return;
    const int nowhere = open("/dev/null", O_RDWR);
    if (nowhere >= 0)
        for (int stream = 0; stream <= 2; stream++) dup2(nowhere, stream);
    execlp("xdg-open", "xdg-open", address, (char *)NULL);
    _exit(127);
}

/* Until Ctrl-C. */
static void wait_for_end(void)
{
    const struct timespec moment = {.tv_nsec = 100000000};
    catch_signals();
    while (!is_interrupted()) nanosleep(&moment, NULL);
}

static int run(int argc, char **argv)
{
    settings s = {.port = DEFAULT_PORT};
    web_server *server = NULL;
    int status = options_parse(&explore_command, argc, argv, &s, NULL);
    if (status != PARSE_GO) return status;
    char *const page = find_page();
    if (!page)
        return fail(EXIT_WORLD, NULL, NULL,
                    "the explorer's page is not there; `make web` builds it, `cmake --install` installs it");
    if (s.is_path_wanted) {
        printf("%s\n", page);
        status = finish_stdout(0);
    } else {
        const web_place place = {.host = "127.0.0.1", .port = (uint16_t)s.port, .is_loopback = true};
        status = web_server_start(&place, NULL, web_serve_folder, page, &server);
    }
    if (server) {
        printf("%s\n", web_server_url(server));
        fflush(stdout);
        note("the explorer is at this address, for this machine alone; Ctrl-C ends it");
        if (!s.stays_closed) open_browser(web_server_url(server));
        wait_for_end();
        web_server_stop(server);
    }
    free(page);
    return status;
}

static const option options[] = {
    {"port", 0, OPTION_INTEGER, offsetof(settings, port), "P",
     "the port of the address (default 8640); 0 is any free one", 0, 65535, NULL},
    {"no-open", 0, OPTION_FLAG, offsetof(settings, stays_closed), NULL, "do not open a browser", 0, 0, NULL},
    {"path", 0, OPTION_FLAG, offsetof(settings, is_path_wanted), NULL,
     "print the folder of the page, which any static server can show, and end", 0, 0, NULL},
};

const command explore_command = {
    .name = "explore",
    .summary = "look at materials in the browser",
    .operands = "",
    .description =
        "Serves the explorer to this machine alone, prints its address and opens it in the browser where there is a\n"
        "desktop: materials as curves, lobes, slices, samples and lit objects, computed in the browser by libfacet.\n"
        "Ends with Ctrl-C.\n",
    .options = options,
    .n_options = sizeof options/sizeof *options,
    .examples = "  facet explore\n  facet explore --port 9000 --no-open\n",
    .run = run,
};
