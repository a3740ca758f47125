/* main.c: the program `facet`: finds the command and runs it.
 * SPDX-License-Identifier: MIT */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/report.h"
#include "cli/suggest.h"

static void print_usage(FILE *stream)
{
    fputs("Usage: facet COMMAND [OPTION]... [ARGUMENT]...\n\n", stream);
    for (size_t i = 0; i < n_commands; i++) fprintf(stream, "  %-11s%s\n", commands[i]->name, commands[i]->summary);
    fputs("\n`facet COMMAND --help` explains a command; `facet render` alone renders the demo scene to facet.png.\n",
          stream);
}

static void print_help(void)
{
    printf("facet %s: microfacet reflection, exact, and a path tracer built on it\n\n", facet_version());
    print_usage(stdout);
    printf("\nMaterials are written as MODEL key=value ...; `facet materials` lists the models and their keys:\n"
           "  facet albedo 'ggx alpha=.3 ks=.9,.7,.3'\n"
           "Directions are unit vectors in the local frame with the normal (0,0,1), pointing away from the surface.\n"
           "Results go to stdout, messages and progress to stderr.\n\n"
           "  facet --version            print the version\n"
           "  facet help [COMMAND]       print this overview, or the help of a command\n"
           "  facet help --json          print all helps as one JSON object\n\n%s",
           exit_status_help);
}

static const command *find_command(const char *name)
{
    suggestion near = suggestion_start(name);
    for (size_t i = 0; i < n_commands; i++) {
        if (strcmp(commands[i]->name, name) == 0) return commands[i];
        suggestion_offer(&near, commands[i]->name);
    }
    suggestion_offer(&near, "help");
    const char *meant = suggestion_get(&near);
    if (meant) fail(EXIT_USAGE, NULL, NULL, "there is no command `%s`; did you mean `%s`?", name, meant);
    else fail(EXIT_USAGE, NULL, NULL, "there is no command `%s`; `facet --help` lists the commands", name);
    return NULL;
}

/* The overview, which explains `facet help` itself, too, or the help of a command. */
static int help(const char *name)
{
    if (!name || strcmp(name, "help") == 0 || strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0) {
        print_help();
        return finish_stdout(0);
    }
    if (strcmp(name, "--json") == 0) {
        print_help_json();
        return finish_stdout(0);
    }
    const command *c = find_command(name);
    if (!c) return EXIT_USAGE;
    command_help(c);
    return finish_stdout(0);
}

/* What follows the arguments that are understood. */
static int fail_extra(const char *extra, const char *usage)
{
    return fail(EXIT_USAGE, NULL, NULL, "unexpected argument `%s`; usage: facet %s", extra, usage);
}

int main(int argc, char **argv)
{
    /* A pipe that closes and a limit on the size of files are ordinary write errors: they must not end the
     * program before a picture is saved, or in the middle of one. */
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
    errno = 0;
    if (argc < 2) {
        print_usage(stderr);
        return EXIT_USAGE;
    }
    const char *name = argv[1];
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0)
        return argc > 2 ? fail_extra(argv[2], "--help") : help(NULL);
    if (strcmp(name, "help") == 0)
        return argc > 3 ? fail_extra(argv[3], "help [COMMAND|--json]") : help(argc > 2 ? argv[2] : NULL);
    if (strcmp(name, "--version") == 0 || strcmp(name, "-V") == 0) {
        if (argc > 2) return fail_extra(argv[2], "--version");
        printf("facet %s\n", facet_version());
        return finish_stdout(0);
    }
    const command *c = find_command(name);
    return c ? c->run(argc - 1, argv + 1) : EXIT_USAGE;
}
