/* test_words.c: text before it is drawn.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "plot/words.h"

static void what_is_not_utf8_becomes_question_marks(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"θ_i, 10⁻³ 🙂", "θ_i, 10⁻³ 🙂"}, /* two, three and four bytes */
        {"a\xffz", "a?z"},
        {"\xce", "?"},                /* cut short */
        {"\xc0\xaf", "??"},           /* overlong */
        {"\xed\xa0\x80", "???"},      /* a surrogate */
        {"\xf4\x90\x80\x80", "????"}, /* beyond Unicode */
        {"a\tb\x1b", "a?b?"},
    };
    char clean[WORDS_CAP];
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        words_clean(cases[i][0], clean);
        assert_string_equal(clean, cases[i][1]);
    }
}

static void long_text_is_cut_behind_a_character(void **state)
{
    (void)state;
    char text[3*WORDS_CAP + 1], clean[WORDS_CAP];
    for (size_t i = 0; i < WORDS_CAP; i++) memcpy(text + 3*i, "€", 3);
    text[3*WORDS_CAP] = 0;
    words_clean(text, clean);
    assert_int_equal(strlen(clean), (WORDS_CAP - 1)/3*3);
}

static void expect_stretches(const char *text, int is_formula, const char *expected)
{
    char all[2*WORDS_CAP] = "", part[WORDS_CAP];
    for (const char *rest = text; *rest;) {
        const int level = words_next(&rest, is_formula, part);
        snprintf(all + strlen(all), sizeof all - strlen(all), "%s%s|", level > 0 ? "^" : level < 0 ? "_" : "", part);
    }
    assert_string_equal(all, expected);
}

static void marks_lower_and_raise_in_formulas_only(void **state)
{
    (void)state;
    expect_stretches("f cos θ_i [1/sr]", 1, "f cos θ|_i| [1/sr]|");
    expect_stretches("10^{−12}", 1, "10|^−12|");
    expect_stretches("x_θ^2", 1, "x|_θ|^2|");
    expect_stretches("alpha_x=.1", 0, "alpha_x=.1|");
    expect_stretches("end_", 1, "end|_|");
    expect_stretches("_{open", 1, "_{|open|");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_not_utf8_becomes_question_marks),
        cmocka_unit_test(long_text_is_cut_behind_a_character),
        cmocka_unit_test(marks_lower_and_raise_in_formulas_only),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
