/* test_kmath_f64.c: kmath.h in double, against libm in long double.
 * SPDX-License-Identifier: MIT */
#define FACET_REAL_IS_DOUBLE 1
#include "tests/core/kmath_cases.h"

int main(void)
{
    /* Where long double is no wider (64 bits on some machines), there is no reference to hold against. */
    if (LDBL_MANT_DIG < 64) {
        printf("skipped: long double has %d bits, the test needs 64\n", LDBL_MANT_DIG);
        return 0;
    }
    return cmocka_run_group_tests_name("kmath in double", KMATH_TESTS, NULL, NULL);
}
