/* help_json.c: `facet help --json`: what all helps say, for programs; man pages and completion are made from it.
 * SPDX-License-Identifier: MIT */
#include "cli/commands.h"
#include "cli/json_writer.h"
#include "cli/report.h"

static void put_option(json_writer *j, const option *o)
{
    const char letter[2] = {o->letter, 0};
    json_put_open(j, NULL, '{');
    json_put_text(j, "name", o->name);
    if (o->letter) json_put_text(j, "letter", letter);
    if (o->kind != OPTION_FLAG) json_put_text(j, "value", o->kind == OPTION_CHOICE ? o->choices : o->value);
    json_put_bool(j, "is_choice", o->kind == OPTION_CHOICE);
    json_put_bool(j, "is_repeated", o->kind == OPTION_TEXTS);
    json_put_text(j, "help", o->help);
    json_put_close(j, '}');
}

static void put_command(json_writer *j, const command *c)
{
    json_put_open(j, NULL, '{');
    json_put_text(j, "name", c->name);
    json_put_text(j, "summary", c->summary);
    json_put_text(j, "operands", c->operands);
    json_put_text(j, "description", c->description);
    json_put_text(j, "examples", c->examples);
    json_put_open(j, "options", '[');
    for (size_t k = 0; k < c->n_options; k++) put_option(j, &c->options[k]);
    put_option(j, &help_option);
    json_put_close(j, ']');
    json_put_close(j, '}');
}

void print_help_json(void)
{
    json_writer j = json_put_start(stdout);
    json_put_open(&j, NULL, '{');
    json_put_text(&j, "version", facet_version());
    json_put_text(&j, "exit_status", exit_status_help);
    json_put_open(&j, "commands", '[');
    for (size_t i = 0; i < n_commands; i++) put_command(&j, commands[i]);
    json_put_close(&j, ']');
    json_put_close(&j, '}');
}
