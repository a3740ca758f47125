/* shading.ts: every material as GLSL: vec3 shade_eval(wi, wo), f |cos theta_i|; float shade_pdf(wi, wo), 1/sr; and vec3
 * shade_sample(wo, u, wi, pdf), which gives the weight of a drawn wi, 0 if there is none.  Its pdf is SHADE_DELTA where
 * only one direction is possible: mirrors and smooth glass.
 *
 * The library's models are the very files that it generates from its kernels, with their parameters as words.
 * SPDX-License-Identifier: MIT */
import type { Brdf } from "../brdf/brdf";
import { FacetBrdf, LOBE } from "../facet/facet_brdf";

export interface Shading {
  /** The same text, the same program. */
  readonly text: string;
  /** Sets the uniforms of `brdf`, which has this shading, in the program in use. */
  bind(gl: WebGL2RenderingContext, program: WebGLProgram, brdf: Brdf): void;
}

/** A material that brings a shading of its own: files, fits, measurements. */
export interface Shaded extends Brdf {
  readonly shading: Shading;
}

export const SHADE_DELTA = "const float SHADE_DELTA = 1e30;\n";

const texts = new Map<string, Promise<string>>();

/** A generated file, fetched once. */
export function glslFile(name: string): Promise<string> {
  let text = texts.get(name);
  if (!text) {
    const url = new URL(`./glsl/${name}.glsl?${FACET_STAMP}`, document.baseURI);
    text = fetch(url).then(answer => {
      if (!answer.ok) throw new Error(`${url.pathname}: ${answer.status}`);
      return answer.text();
    });
    texts.set(name, text);
  }
  return text;
}

/** The file that serves a material: its model's, or that of the model's second kernel. */
export function glslName(brdf: FacetBrdf, files: readonly string[]): string {
  const kernel = brdf.kernel,
    model = brdf.settings.model.name;
  return kernel !== model && files.includes(kernel) ? kernel : model;
}

// Kernels that serve a part of a model only have a file of their own.
export const KERNEL_FILES = ["rough_dielectric"];

async function facetShading(brdf: FacetBrdf): Promise<Shading> {
  const name = glslName(brdf, KERNEL_FILES),
    text = await glslFile(name);
  const nWords = 4 * Number(new RegExp(`${name.toUpperCase()}_WORDS = (\\d+);`).exec(text)![1]);
  return {
    text: `${text}
uniform uvec4 material[${name.toUpperCase()}_WORDS];
vec3 shade_eval(vec3 wi, vec3 wo) { return ${name}_eval(${name}_load(material), wi, wo); }
float shade_pdf(vec3 wi, vec3 wo) { return ${name}_pdf(${name}_load(material), wi, wo); }
${SHADE_DELTA}vec3 shade_sample(vec3 wo, vec3 u, out vec3 wi, out float pdf)
{
    bsdf_sample s = ${name}_sample(${name}_load(material), wo, u);
    wi = s.wi;
    pdf = (s.lobe & ${LOBE.delta}) != 0 ? SHADE_DELTA : s.pdf;
    return s.pdf > 0.0 ? s.weight : vec3(0);
}
`,
    bind: (gl, program, one) =>
      gl.uniform4uiv(gl.getUniformLocation(program, "material"), (one as FacetBrdf).words(nWords)),
  };
}

const shadings = new Map<string, Promise<Shading>>();

export function shadingOf(brdf: Brdf): Promise<Shading> {
  if (!(brdf instanceof FacetBrdf)) return Promise.resolve((brdf as Shaded).shading);
  const key = glslName(brdf, KERNEL_FILES);
  let shading = shadings.get(key);
  if (!shading) shadings.set(key, (shading = facetShading(brdf)));
  return shading;
}
