/* command_list.c: the program's commands, in the order of the overview.
 * SPDX-License-Identifier: MIT */
#include "cli/commands.h"

const command *const commands[] = {
    &render_command,    &merge_command,  &compare_command, &eval_command,    &sample_command,
    &terms_command,     &albedo_command, &plot_command,    &verify_command,  &fit_command,
    &materials_command, &scenes_command, &info_command,    &explore_command,
};
const size_t n_commands = sizeof commands/sizeof *commands;
