/* test_kmath.c: kmath.h in float, against libm in double.
 * SPDX-License-Identifier: MIT */
#include "tests/core/kmath_cases.h"

int main(void)
{
    return cmocka_run_group_tests_name("kmath in float", KMATH_TESTS, NULL, NULL);
}
