/* fuzz_material.c: libFuzzer's way into the text form of materials, and on to what an accepted one computes.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "tests/fuzz/parts/bsdf_checks.h"
#include "tests/fuzz/parts/harness.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    char *text = malloc(size + 1);
    require(text != NULL);
    if (size) memcpy(text, bytes, size);
    text[size] = 0;
    facet_material material = {.struct_size = sizeof material};
    facet_error why = {0};
    if (facet_material_parse(text, &material, &why)) {
        require(why.status && why.text[0]);
    } else {
        facet_bsdf bsdf;
        require(facet_bsdf_prepare(&material, &bsdf, &why) == FACET_OK || (why.status && why.text[0]));
        if (!why.status) check_bsdf(&bsdf);
    }
    free(text);
    return 0;
}
