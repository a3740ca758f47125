/* test_json.c: JSON is read strictly, and complaints name their place.
 * SPDX-License-Identifier: MIT */
#include <float.h>
#include <malloc.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "io/json.h"

static facet_error why;
static json_place root;

static bool parse(const char *text)
{
    why = (facet_error){0};
    return json_parse((const unsigned char *)text, strlen(text), &root, &why);
}

static int cleanup(void **state)
{
    (void)state;
    json_destroy(&root);
    return 0;
}

static void syntax_errors_are_refused_with_their_line(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "",        "{",          "[1,]",          "{\"a\":1,\"a\":2}", "[NaN]", "// c\n[]", "[] []",
        "[1e400]", "[\"\xff\"]", "[\"\\ud800\"]", "\xEF\xBB\xBF[]",    "[01]",  "['a']",    "[\"\\u0000\"]",
        "{a:1}",   "[Infinity]"};
    for (size_t i = 0; i < sizeof texts/sizeof *texts; i++) {
        if (parse(texts[i])) fail_msg("accepted: %s", texts[i]);
        assert_int_equal(why.status, FACET_BAD_FILE);
        assert_true(why.text[0]);
    }
    static const char *const nuls[] = {"[\"a\\u0000b\"]", "{\"a\\u0000b\":1}"};
    for (size_t i = 0; i < 2; i++) {
        assert_false(parse(nuls[i]));
        assert_string_equal(why.text, "not valid JSON: \\u0000, the character that ends texts, cannot be part of one");
    }
    assert_false(parse("{\n\"a\": oops}"));
    assert_string_equal(why.place, "line 2, column 9");
}

static void nesting_beyond_the_cap_is_refused(void **state)
{
    (void)state;
    static char deep[2*JSON_DEPTH_CAP + 8];
    for (int extra = 0; extra < 2; extra++) {
        const size_t n = JSON_DEPTH_CAP + (size_t)extra;
        memset(deep, '[', n);
        memset(deep + n, ']', n);
        deep[2*n] = 0;
        assert_int_equal(parse(deep), extra == 0);
        if (extra == 0) json_destroy(&root);
    }
}

static void values_are_read_by_kind_and_range(void **state)
{
    (void)state;
    assert_true(parse("{\"n\":-1.5e3,\"i\":7.0,\"b\":true,\"s\":\"t\\u00e9\",\"v\":[1,2,3]}"));
    double n = 0;
    size_t i = 0;
    bool b = false;
    const char *s = NULL;
    float v[3] = {0, 0, 0};
    assert_true(json_read_number(&root, "n", -INFINITY, INFINITY, &n) && n == -1500);
    assert_true(json_read_size(&root, "i", 7, &i) && i == 7);
    assert_true(json_read_index(&root, "i", 8, "things", &i) && i == 7);
    assert_true(json_read_bool(&root, "b", &b) && b);
    assert_true(json_read_string(&root, "s", &s));
    assert_string_equal(s, "t\xC3\xA9");
    assert_true(json_read_floats(&root, "v", 3, 0, 3, v) && v[2] == 3);
}

static void absent_members_leave_defaults(void **state)
{
    (void)state;
    assert_true(parse("{\"empty\":{}}"));
    json_place empty, gone;
    double n = 4;
    assert_true(json_read_object(&root, "empty", &empty) && json_read_object(&empty, "gone", &gone));
    assert_true(json_read_number(&gone, "x", 0, 1, &n) && n == 4);
    assert_int_equal(json_count(&gone), 0);
    assert_false(json_want_present(&gone));
    assert_string_equal(why.place, "empty.gone");
}

static void complaints_name_place_and_range(void **state)
{
    (void)state;
    static const struct {
        const char *text, *place, *complaint;
    } cases[] = {
        {"{\"a\":[{\"x\":2}]}", "a[0].x", "is 2; must be from 0 to 1"},
        {"{\"a\":[{\"x\":\"1\"}]}", "a[0].x", "is a string; must be a number"},
        {"{\"a\":[{\"x\":null}]}", "a[0].x", "is null; must be a number"},
        {"{\"a\":[{\"i\":1.5}]}", "a[0].i", "must be a whole number"},
        {"{\"a\":[{\"i\":-1}]}", "a[0].i", "must not be negative"},
        {"{\"a\":[{\"i\":3}]}", "a[0].i", "the number of things is 3"},
        {"{\"a\":[{\"i\":9007199254740993}]}", "a[0].i", "must be at most 9007199254740991"},
        {"{\"a\":[{\"v\":[1,2]}]}", "a[0].v", "has 2 numbers; must have 3"},
        {"{\"a\":[{\"v\":[1,2,1e39]}]}", "a[0].v[2]", "must be at most"},
        {"{\"a\":[{\"v\":{}}]}", "a[0].v", "is an object; must be an array"},
        {"{\"a\":[7]}", "a[0]", "is a number; must be an object"},
    };
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        json_place list;
        double x;
        size_t index;
        float v[3];
        assert_true(parse(cases[i].text) && json_read_array(&root, "a", &list));
        const json_place element = json_element(&list, 0);
        assert_false(json_want_object(&element) && json_read_number(&element, "x", 0, 1, &x) &&
                     json_read_index(&element, "i", 3, "things", &index) &&
                     json_read_floats(&element, "v", 3, -INFINITY, INFINITY, v));
        assert_string_equal(why.place, cases[i].place);
        if (!strstr(why.text, cases[i].complaint)) fail_msg("\"%s\" lacks \"%s\"", why.text, cases[i].complaint);
        json_destroy(&root);
    }
}

static void the_first_complaint_is_kept(void **state)
{
    (void)state;
    assert_true(parse("{\"x\":2,\"y\":3}"));
    double n;
    assert_false(json_read_number(&root, "x", 0, 1, &n));
    assert_false(json_read_number(&root, "y", 0, 1, &n));
    assert_string_equal(why.place, "x");
}

static void members_come_in_the_order_of_the_file(void **state)
{
    (void)state;
    assert_true(parse("{\"z\":1,\"a\":2,\"m\":3}"));
    json_place member;
    void *iterator = NULL;
    char order[4] = "";
    for (size_t i = 0; json_next(&root, &iterator, &member); i++) order[i] = member.key[0];
    assert_string_equal(order, "zam");
}

/* Sanitizers have an allocator of their own, which mallinfo2 does not see. */
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HAS_OWN_ALLOCATOR 1
#endif
#endif

/* Documents of many values of one kind take no more memory than json_memory says. */
static void memory_is_told_before_it_is_taken(void **state)
{
    (void)state;
    static const char *const values[] = {"{}",
                                         "[]",
                                         "0",
                                         "\"\"",
                                         "\"abcdefghijklmnopqrstuvwxyzabcdefghijklmn\\\"\"",
                                         "[0]",
                                         "[[[[]]]]",
                                         "{\"a\":{}}",
                                         "{\"a\":0,\"b\":[],\"c\":\"\"}",
                                         "null",
                                         "[1,2,3,4,5,6,7,8,9]"};
    enum { N = 20000 };
    for (size_t i = 0; i < sizeof values/sizeof *values; i++) {
        const size_t length = strlen(values[i]);
        char *text = malloc(N*(length + 1) + 2), *to = text;
        assert_non_null(text);
        *to++ = '[';
        for (int k = 0; k < N; k++) {
            memcpy(to, values[i], length);
            to += length;
            *to++ = k + 1 < N ? ',' : ']';
        }
        const size_t told = json_memory((const unsigned char *)text, (size_t)(to - text));
        *to = 0;
#ifndef HAS_OWN_ALLOCATOR
        const struct mallinfo2 before = mallinfo2();
        assert_true(parse(text));
        const struct mallinfo2 after = mallinfo2();
        const size_t taken = after.uordblks + after.hblkhd - before.uordblks - before.hblkhd;
        print_message("  %-44.44s %5.1f bytes each of %5.1f told\n", values[i], (double)taken/N, (double)told/N);
        assert_true(taken <= told);
        json_destroy(&root);
#else
        assert_true(told > (size_t)(to - text));
#endif
        free(text);
    }
}

static void memory_of_an_object_with_many_keys_is_told(void **state)
{
    (void)state;
#ifndef HAS_OWN_ALLOCATOR
    enum { N = 40000 };
    char *text = malloc(N*16 + 2), *to = text;
    assert_non_null(text);
    *to++ = '{';
    for (int k = 0; k < N; k++) to += sprintf(to, "\"%x\":0%c", k, k + 1 < N ? ',' : '}');
    const size_t told = json_memory((const unsigned char *)text, (size_t)(to - text));
    const struct mallinfo2 before = mallinfo2();
    assert_true(parse(text));
    const struct mallinfo2 after = mallinfo2();
    assert_true(after.uordblks + after.hblkhd - before.uordblks - before.hblkhd <= told);
    free(text);
#endif
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(syntax_errors_are_refused_with_their_line, cleanup),
        cmocka_unit_test_teardown(memory_is_told_before_it_is_taken, cleanup),
        cmocka_unit_test_teardown(memory_of_an_object_with_many_keys_is_told, cleanup),
        cmocka_unit_test_teardown(nesting_beyond_the_cap_is_refused, cleanup),
        cmocka_unit_test_teardown(values_are_read_by_kind_and_range, cleanup),
        cmocka_unit_test_teardown(absent_members_leave_defaults, cleanup),
        cmocka_unit_test_teardown(complaints_name_place_and_range, cleanup),
        cmocka_unit_test_teardown(the_first_complaint_is_kept, cleanup),
        cmocka_unit_test_teardown(members_come_in_the_order_of_the_file, cleanup),
    };
    return cmocka_run_group_tests_name("json", tests, NULL, NULL);
}
