/* cmd_scenes.c: `facet scenes`, the scenes that are built in.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>

#include "cli/commands.h"
#include "cli/report.h"

static int run(int argc, char **argv)
{
    char unused;
    const int status = options_parse(&scenes_command, argc, argv, &unused, NULL);
    if (status != PARSE_GO) return status;
    printf("demo        shader balls that show the models; `facet render` renders it when no scene is given\n");
    return finish_stdout(0);
}

const command scenes_command = {
    .name = "scenes",
    .summary = "list the built-in scenes",
    .operands = "",
    .description = "One line per scene: its name, for `facet render NAME`, and what it shows.\n",
    .examples = "  facet scenes\n  facet render demo -o balls.exr --spp 256\n",
    .run = run,
};
