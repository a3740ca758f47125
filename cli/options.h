/* options.h: a command's options as a table, from which the parser and --help both work.
 *
 * `--name value`, `--name=value`, `-x value`, `-xvalue`; `--` ends the options; a value may begin with
 * one dash (a negative number, or `-` for stdin) but not with two.  Everything else is an operand.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { MAX_LIST = 64 };

/* The types that an option fills in; each starts at the default that the command's struct holds. */
typedef struct text_list {
    const char *items[MAX_LIST];
    size_t n;
} text_list;
typedef struct number_list {
    double items[MAX_LIST];
    size_t n;
} number_list;
typedef struct option_vector {
    bool is_given;
    double v[3];
} option_vector;
typedef struct option_number {
    bool is_given;
    double value;
} option_number;

typedef enum option_kind {
    OPTION_FLAG,    /* bool */
    OPTION_TEXT,    /* const char * */
    OPTION_TEXTS,   /* text_list: may be repeated */
    OPTION_INTEGER, /* uint64_t, low to high */
    OPTION_BYTES,   /* uint64_t: a number of bytes, with K, M, G or T for powers of 1024; at least 1 */
    OPTION_NUMBER,  /* option_number, low to high */
    OPTION_NUMBERS, /* number_list, separated by commas */
    OPTION_SIZE,    /* size_t[2]: WIDTHxHEIGHT */
    OPTION_RECT,    /* size_t[4]: X,Y,W,H */
    OPTION_VECTOR,  /* option_vector: X,Y,Z */
    OPTION_PLACE,   /* const char *: [ADDRESS:]PORT or nothing: "" without a value that looks like one */
    OPTION_CHOICE   /* const char *: one of `choices`, separated by '|' */
} option_kind;

typedef struct option {
    const char *name; /* without the dashes */
    char letter;      /* short form, or 0 */
    option_kind kind;
    size_t offset;     /* of the value, in the command's struct */
    const char *value; /* how help names the value: "FILE" */
    const char *help;  /* with the default */
    double low, high;
    const char *choices;
} option;

typedef struct command {
    const char *name, *summary;
    const char *operands; /* as in the usage line: "SPEC" or "[SCENE.gltf|.glb]" */
    size_t min_operands, max_operands;
    const char *description; /* paragraphs of help, ended by newlines */
    const char *examples;
    const option *options;
    size_t n_options;
    int (*run)(int argc, char **argv); /* argv[0] is the command's name; returns the exit status */
} command;

/* What parsing found: PARSE_GO, or the exit status to return with (help was printed, or an error). */
enum { PARSE_GO = -1 };

/* Parses argv[1..argc-1] into the struct at `values`; operands go to operands[max_operands], the missing
 * ones as NULL. */
int options_parse(const command *c, int argc, char **argv, void *values, const char **operands);

/* `--help`, which every command has. */
extern const option help_option;

/* The complete help of a command, on stdout. */
void command_help(const command *c);

/* n numbers separated by commas, the whole text; false if it has another form or a number is not finite. */
bool parse_numbers(const char *text, double *numbers, size_t n);

#ifdef __cplusplus
}
#endif
