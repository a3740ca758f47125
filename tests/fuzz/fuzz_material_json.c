/* fuzz_material_json.c: libFuzzer's way into JSON, and into materials that are written as JSON objects.
 * SPDX-License-Identifier: MIT */
#include "io/material_json.h"
#include "tests/fuzz/parts/bsdf_checks.h"
#include "tests/fuzz/parts/harness.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    facet_error why = {0};
    json_place root;
    if (!json_parse(bytes, size, &root, &why)) {
        require(why.status && why.text[0]);
        return 0;
    }
    facet_bsdf bsdf;
    const bool is_read = json_want_object(&root) && material_json_read(&root, &bsdf);
    require(is_read == (why.status == FACET_OK) && (is_read || why.text[0]));
    if (is_read) check_bsdf(&bsdf);
    json_destroy(&root);
    return 0;
}
