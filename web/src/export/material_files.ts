/* material_files.ts: one material as text for elsewhere: spec, glTF, GLSL, C.
 *
 * SPDX-License-Identifier: MIT */
import type { ShaderBrdf } from "../brdf/shader_brdf";
import type { FacetBrdf } from "../facet/facet_brdf";
import { glslFile, glslName, KERNEL_FILES } from "../gl/shading";

export interface TextFile {
  readonly name: string;
  readonly type: string;
  readonly text: string;
}

/** The object of extensions.FACET_materials_bsdf: the parameters that the spec gives. */
export function materialObject({ settings }: FacetBrdf): Record<string, unknown> {
  const object: Record<string, unknown> = { model: settings.model.name };
  settings.model.parameters.forEach((parameter, k) => {
    const values = settings.values[k];
    if (!settings.given[k]) return;
    if (parameter.kind === "choice") object[parameter.name] = parameter.choices[values[0]];
    else object[parameter.name] = parameter.kind === "colour" ? [...values] : values[0];
  });
  return object;
}

export function specFile(brdf: FacetBrdf): TextFile {
  return { name: "material.txt", type: "text/plain", text: brdf.text + "\n" };
}

export function gltfFile(brdf: FacetBrdf, version: string): TextFile {
  const gltf = {
    asset: { version: "2.0", generator: `facet explorer ${version}` },
    extensionsUsed: ["FACET_materials_bsdf"],
    materials: [{ name: brdf.text, extensions: { FACET_materials_bsdf: materialObject(brdf) } }],
  };
  return { name: "material.gltf", type: "model/gltf+json", text: JSON.stringify(gltf, null, 2) + "\n" };
}

/** The model's own file, with the parameters as a constant and two functions without any. */
export async function glslMaterial(brdf: FacetBrdf): Promise<TextFile> {
  const name = glslName(brdf, KERNEL_FILES),
    model = await glslFile(name),
    constant = `${name.toUpperCase()}_WORDS`;
  const n = Number(new RegExp(`${constant} = (\\d+);`).exec(model)![1]),
    words = brdf.words(4 * n);
  const rows = Array.from({ length: n }, (_, i) => {
    const [a, b, c, d] = [...words.subarray(4 * i, 4 * i + 4)].map(word => `0x${word.toString(16)}u`);
    return `    uvec4(${a}, ${b}, ${c}, ${d})`;
  });
  const text = `${model}
/* ${brdf.text} */
const uvec4 material_words[${constant}] = uvec4[${constant}](
${rows.join(",\n")});

/* f(wi,wo) |cos theta_i|, and a sample of wi. */
vec3 material_eval(vec3 wi, vec3 wo) { return ${name}_eval(${name}_load(material_words), wi, wo); }
bsdf_sample material_sample(vec3 wo, vec3 u) { return ${name}_sample(${name}_load(material_words), wo, u); }
`;
  return { name: "material.glsl", type: "text/plain", text };
}

/** A .brdf file's values as Disney's BRDF Explorer keeps them; it looks for the file where the first line says. */
export function bparamFile({ settings: { model, values } }: ShaderBrdf): TextFile {
  const lines = model.parameters.map(({ name, kind, low, high }, k) => {
    const numbers = values[k].map(x => x.toFixed(6));
    if (kind === "choice") return `bool ${name} ${values[k][0]}`;
    if (kind === "colour") return `color ${name} ${numbers.join(" ")}`;
    return `float ${name} ${low.toFixed(6)} ${high.toFixed(6)} ${numbers[0]}`;
  });
  const text = ["bparam " + model.name, "::begin parameters", ...lines, "::end parameters", ""].join("\n");
  return { name: model.name.replace(/\.brdf$/i, "") + ".bparam", type: "text/plain", text };
}

export function cFile(brdf: FacetBrdf): TextFile {
  const text = `/* cc material.c -lfacet -lm */
#include <stdio.h>

#include "facet/facet.h"

int main(void)
{
    facet_material material;
    facet_bsdf bsdf;
    facet_error why;
    if (facet_material_parse("${brdf.text}", &material, &why) || facet_bsdf_prepare(&material, &bsdf, &why))
        return fprintf(stderr, "%s: %s\\n", why.place, why.text), 1;
    const float wi[3] = {0, 0.6f, 0.8f}, wo[3] = {0, -0.6f, 0.8f};
    float f[3];
    facet_bsdf_eval(&bsdf, wi, wo, f); /* f |cos theta_i| */
    printf("%.9g %.9g %.9g, pdf %.9g\\n", f[0], f[1], f[2], facet_bsdf_pdf(&bsdf, wi, wo));
    return 0;
}
`;
  return { name: "material.c", type: "text/x-c", text };
}
