/* test_kmath_tables.c: the polynomials in core/kernel/kmath_f*.h are those that tools/make_kmath.py derives.
 * Skipped where python3 has no mpmath.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
/* cmocka.h needs the four above */
#include <cmocka.h>

static void headers_equal_what_the_script_computes(void **state)
{
    (void)state;
    if (system("python3 -B -c 'import mpmath' 2>/dev/null") != 0) {
        print_message("skipped: python3 cannot import mpmath (Debian package python3-mpmath)\n");
        skip();
    }
    assert_int_equal(system("python3 -B '" FACET_SOURCE_DIR "/tools/make_kmath.py' --check"), 0);
}

int main(void)
{
    static const struct CMUnitTest TESTS[] = {cmocka_unit_test(headers_equal_what_the_script_computes)};
    return cmocka_run_group_tests_name("kmath tables", TESTS, NULL, NULL);
}
