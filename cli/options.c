/* options.c: reading a command line by a table.
 * SPDX-License-Identifier: MIT */
#include "options.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/report.h"
#include "cli/suggest.h"

/* ---- Values ------------------------------------------------------------------------------------ */

/* One finite number at *text, which moves behind it. */
static bool parse_number(const char **text, double *number)
{
    if (isspace((unsigned char)**text)) return false;
    char *end;
    *number = strtod(*text, &end);
    if (end == *text || !isfinite(*number)) return false;
    *text = end;
    return true;
}

bool parse_numbers(const char *text, double *numbers, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        if (!parse_number(&text, &numbers[i])) return false;
        if (*text++ != (i + 1 < n ? ',' : 0)) return false;
    }
    return true;
}

/* n whole numbers separated by `separator` (in either case), the whole text. */
static bool parse_wholes(const char *text, char separator, size_t *wholes, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        if (!isdigit((unsigned char)*text)) return false;
        char *end;
        errno = 0;
        const unsigned long long value = strtoull(text, &end, 10);
        if (errno || value > INT32_MAX) return false;
        wholes[i] = (size_t)value;
        text = end;
        if (tolower((unsigned char)*text++) != (i + 1 < n ? separator : 0)) return false;
    }
    return true;
}

static bool is_choice(const char *choices, const char *text)
{
    const size_t n = strlen(text);
    for (const char *p = choices;; p++) {
        const size_t length = strcspn(p, "|");
        if (n == length && strncmp(p, text, n) == 0) return true;
        p += length;
        if (!*p) return false;
    }
}

static int bad_value(const option *o, const char *text, const char *right)
{
    char place[64];
    snprintf(place, sizeof place, "--%s", o->name);
    return fail(EXIT_USAGE, NULL, place, "`%s` is not %s", text, right);
}

static int set_integer(const option *o, const char *text, uint64_t *value)
{
    char right[96];
    char *end;
    errno = 0;
    const unsigned long long whole = strtoull(text, &end, 10);
    if (isdigit((unsigned char)*text) && !*end && !errno && (double)whole >= o->low && (double)whole <= o->high) {
        *value = whole;
        return PARSE_GO;
    }
    snprintf(right, sizeof right, "a whole number from %.0f to %.0f", o->low, o->high);
    return bad_value(o, text, right);
}

static int set_bytes(const option *o, const char *text, uint64_t *value)
{
    static const char units[] = "KMGT";
    char *end;
    errno = 0;
    const unsigned long long whole = strtoull(text, &end, 10);
    const char *unit = *end ? strchr(units, toupper((unsigned char)*end)) : NULL;
    const int shift = unit ? 10*(int)(unit - units + 1) : 0;
    if (isdigit((unsigned char)*text) && !errno && !end[unit ? 1 : 0] && whole > 0 && whole <= UINT64_MAX >> shift) {
        *value = whole << shift;
        return PARSE_GO;
    }
    return bad_value(o, text, "a size in bytes, with K, M, G or T for powers of 1024, such as 512M");
}

static int set_number(const option *o, const char *text, option_number *number)
{
    char right[96];
    number->is_given = true;
    if (parse_numbers(text, &number->value, 1) && number->value >= o->low && number->value <= o->high) return PARSE_GO;
    snprintf(right, sizeof right, "a number from %g to %g", o->low, o->high);
    return bad_value(o, text, right);
}

static int set_numbers(const option *o, const char *text, number_list *list)
{
    char right[96];
    size_t n = 1;
    for (const char *p = text; *p; p++) n += *p == ',';
    if (n > MAX_LIST) {
        snprintf(right, sizeof right, "a list of at most %d numbers: it has %zu", MAX_LIST, n);
        return bad_value(o, "...", right);
    }
    bool is_good = parse_numbers(text, list->items, n);
    for (size_t i = 0; is_good && i < n; i++) is_good = list->items[i] >= o->low && list->items[i] <= o->high;
    list->n = n;
    snprintf(right, sizeof right, "a list of numbers from %g to %g such as 1,0.5,0.1", o->low, o->high);
    return is_good ? PARSE_GO : bad_value(o, text, right);
}

/* Stores the option's value (text is NULL for a flag).  Returns PARSE_GO or an exit status. */
static int set_value(const option *o, const char *text, void *value)
{
    switch (o->kind) {
    case OPTION_FLAG: *(bool *)value = true; return PARSE_GO;
    case OPTION_TEXT:
        if (!*text) return bad_value(o, text, "a value: it is empty");
        *(const char **)value = text;
        return PARSE_GO;
    case OPTION_PLACE: *(const char **)value = text; return PARSE_GO;
    case OPTION_TEXTS: {
        text_list *list = value;
        if (!*text) return bad_value(o, text, "a value: it is empty");
        if (list->n == MAX_LIST) return bad_value(o, text, "possible: the option can be repeated 64 times");
        list->items[list->n++] = text;
        return PARSE_GO;
    }
    case OPTION_INTEGER: return set_integer(o, text, value);
    case OPTION_BYTES: return set_bytes(o, text, value);
    case OPTION_NUMBER: return set_number(o, text, value);
    case OPTION_NUMBERS: return set_numbers(o, text, value);
    case OPTION_SIZE: {
        size_t *size = value;
        if (parse_wholes(text, 'x', size, 2) && size[0] && size[1]) return PARSE_GO;
        return bad_value(o, text, "WIDTHxHEIGHT in pixels, such as 960x540");
    }
    case OPTION_RECT: {
        size_t *rect = value;
        if (parse_wholes(text, ',', rect, 4) && rect[2] && rect[3]) return PARSE_GO;
        return bad_value(o, text, "X,Y,WIDTH,HEIGHT in pixels from the top left corner, such as 100,50,320,240");
    }
    case OPTION_VECTOR: {
        option_vector *vector = value;
        vector->is_given = true;
        if (parse_numbers(text, vector->v, 3)) return PARSE_GO;
        return bad_value(o, text, "three finite numbers X,Y,Z, such as 0,0.6,0.8");
    }
    case OPTION_CHOICE: {
        if (is_choice(o->choices, text)) {
            *(const char **)value = text;
            return PARSE_GO;
        }
        char right[160];
        snprintf(right, sizeof right, "one of %s", o->choices);
        return bad_value(o, text, right);
    }
    }
    return PARSE_GO;
}

/* ---- Arguments --------------------------------------------------------------------------------- */

const option help_option = {"help", 'h', OPTION_FLAG, 0, NULL, "print this help", 0, 0, NULL};

/* The option that argument i spells, or NULL with the message printed; *text is the value attached to it. */
static const option *find_option(const command *c, const char *argument, const char **text)
{
    *text = NULL;
    if (argument[1] != '-') {
        *text = argument[2] ? argument + 2 : NULL;
        if (argument[1] == 'h') return &help_option;
        for (size_t k = 0; k < c->n_options; k++)
            if (c->options[k].letter == argument[1]) return &c->options[k];
        fail(EXIT_USAGE, NULL, NULL, "%s has no option `-%c`; `facet %s --help` lists the options", c->name,
             argument[1], c->name);
        return NULL;
    }
    const size_t length = strcspn(argument + 2, "=");
    if (argument[2 + length]) *text = argument + 2 + length + 1;
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)(length < 63 ? length : 63), argument + 2);
    suggestion near = suggestion_start(name);
    for (size_t k = 0; k <= c->n_options; k++) {
        const option *o = k < c->n_options ? &c->options[k] : &help_option;
        if (strcmp(o->name, name) == 0) return o;
        suggestion_offer(&near, o->name);
    }
    const char *meant = suggestion_get(&near);
    if (meant) fail(EXIT_USAGE, NULL, NULL, "%s has no option `--%s`; did you mean `--%s`?", c->name, name, meant);
    else
        fail(EXIT_USAGE, NULL, NULL, "%s has no option `--%s`; `facet %s --help` lists the options", c->name, name,
             c->name);
    return NULL;
}

/* Whether an argument looks like PORT or ADDRESS:PORT. */
static bool is_place(const char *text)
{
    const char *colon = strrchr(text, ':'), *port = colon ? colon + 1 : text;
    return *port && !port[strspn(port, "0123456789")];
}

/* Handles the option at argv[*i], moving *i to its last argument. */
static int take_option(const command *c, int argc, char **argv, int *i, void *values, uint64_t *given)
{
    const char *spelling = argv[*i], *text;
    const option *o = find_option(c, spelling, &text);
    if (!o) return EXIT_USAGE;
    if (o->kind == OPTION_FLAG && text)
        return fail(EXIT_USAGE, NULL, NULL, "--%s takes no value; leave `%s` out", o->name, text);
    if (o == &help_option) {
        command_help(c);
        return finish_stdout(0);
    }
    if (o->kind == OPTION_PLACE && !text) {
        text = *i + 1 < argc && is_place(argv[*i + 1]) ? argv[++*i] : "";
    } else if (o->kind != OPTION_FLAG && !text) {
        if (*i + 1 == argc || strncmp(argv[*i + 1], "--", 2) == 0)
            return fail(EXIT_USAGE, NULL, NULL, "`%s` needs a value: %s %s", spelling, spelling, o->value);
        text = argv[++*i];
    }
    const uint64_t bit = (uint64_t)1 << (o - c->options);
    if ((*given & bit) && o->kind != OPTION_TEXTS && o->kind != OPTION_FLAG)
        return fail(EXIT_USAGE, NULL, NULL, "--%s is given twice; give it once", o->name);
    *given |= bit;
    return set_value(o, text, (char *)values + o->offset);
}

int options_parse(const command *c, int argc, char **argv, void *values, const char **operands)
{
    uint64_t given = 0;
    size_t n_operands = 0;
    bool is_over = false;
    for (size_t k = 0; k < c->max_operands; k++) operands[k] = NULL;
    for (int i = 1; i < argc; i++) {
        if (!is_over && strcmp(argv[i], "--") == 0) {
            is_over = true;
        } else if (!is_over && argv[i][0] == '-' && argv[i][1]) {
            const int status = take_option(c, argc, argv, &i, values, &given);
            if (status != PARSE_GO) return status;
        } else if (n_operands == c->max_operands) {
            return fail(EXIT_USAGE, NULL, NULL, "unexpected argument `%s`; usage: facet %s [OPTION]...%s%s", argv[i],
                        c->name, *c->operands ? " " : "", c->operands);
        } else {
            if (!argv[i][0])
                return fail(EXIT_USAGE, NULL, NULL, "an empty argument; usage: facet %s [OPTION]...%s%s", c->name,
                            *c->operands ? " " : "", c->operands);
            operands[n_operands++] = argv[i];
        }
    }
    if (n_operands < c->min_operands)
        return fail(EXIT_USAGE, NULL, NULL, "%s needs %s; usage: facet %s [OPTION]... %s", c->name, c->operands,
                    c->name, c->operands);
    return PARSE_GO;
}

/* ---- Help -------------------------------------------------------------------------------------- */

enum { HELP_INDENT = 28, HELP_WIDTH = 80 };

/* Text in words, wrapped between columns HELP_INDENT and HELP_WIDTH; the cursor stands at `column`. */
static void print_wrapped(const char *text, int column)
{
    if (column >= HELP_INDENT) {
        putchar('\n');
        column = 0;
    }
    printf("%*s", HELP_INDENT - column, "");
    column = HELP_INDENT;
    while (*text) {
        const int length = (int)strcspn(text, " ");
        if (column > HELP_INDENT && column + 1 + length > HELP_WIDTH) {
            printf("\n%*s", HELP_INDENT, "");
            column = HELP_INDENT;
        } else if (column > HELP_INDENT) {
            putchar(' ');
            column++;
        }
        printf("%.*s", length, text);
        column += length;
        text += length;
        text += strspn(text, " ");
    }
    putchar('\n');
}

/* "a|b|c" from `column` on; what does not fit goes on below, in the same column.  Returns the cursor's column. */
static int print_choices(const char *choices, const int column)
{
    int cursor = column;
    while (*choices) {
        const size_t name = strcspn(choices, "|"), length = name + (choices[name] == '|');
        if (cursor > column && cursor + (int)length > HELP_WIDTH) {
            printf("\n%*s", column, "");
            cursor = column;
        }
        printf("%.*s", (int)length, choices);
        cursor += (int)length;
        choices += length;
    }
    return cursor;
}

static void print_option(const option *o)
{
    const char *value = o->kind == OPTION_CHOICE ? o->choices : o->value;
    int column = o->letter ? printf("  -%c, --%s", o->letter, o->name) : printf("      --%s", o->name);
    if (value) {
        putchar(' ');
        column = print_choices(value, column + 1);
    }
    print_wrapped(o->help, column + 1);
}

void command_help(const command *c)
{
    printf("facet %s: %s\n\nUsage: facet %s [OPTION]...%s%s\n\n%s\nOptions:\n", c->name, c->summary, c->name,
           *c->operands ? " " : "", c->operands, c->description);
    for (size_t k = 0; k < c->n_options; k++) print_option(&c->options[k]);
    print_option(&help_option);
    printf("\nExamples:\n%s\n%s", c->examples, exit_status_help);
}
