/* shader_brdf.ts: a .brdf file as a material: its text compiled for WebGL 2, its parameters as uniforms.
 *
 * SPDX-License-Identifier: MIT */
import { specText, type Settings } from "../facet/library";
import { theEvaluator } from "../gl/evaluator";
import type { Shaded, Shading } from "../gl/shading";
import { bindTable, TABLE_SAMPLER } from "../gl/table_glsl";
import type { Directions, Rgb } from "./brdf";
import type { BrdfFile } from "./brdf_file";
import { toGlslEs } from "./glsl_es";

const TYPES = { number: "float", choice: "bool", colour: "vec3" } as const;

function shadingOf({ model, shader }: BrdfFile): Shading {
  const own = new Set(model.parameters.map(parameter => parameter.name)),
    rename = (word: string): string => (own.has(word) ? `brdf_${word}` : word);
  const uniforms = model.parameters.map(({ name, kind }) => `uniform ${TYPES[kind]} ${rename(name)};`).join("\n");
  return {
    text: `${uniforms}
${toGlslEs(shader, rename)}
vec3 shade_eval(vec3 wi, vec3 wo)
{
    if (wi.z <= 0.0 || wo.z <= 0.0) return vec3(0);
    vec3 f = BRDF(wi, wo, vec3(0, 0, 1), vec3(1, 0, 0), vec3(0, 1, 0))*wi.z;
    return vec3(isnan(f.x) ? 0.0 : f.x, isnan(f.y) ? 0.0 : f.y, isnan(f.z) ? 0.0 : f.z);
}
${TABLE_SAMPLER}`,
    bind: (gl, program, brdf) => {
      const { settings } = brdf as ShaderBrdf;
      settings.model.parameters.forEach(({ name, kind }, k) => {
        const place = gl.getUniformLocation(program, rename(name)),
          [a, b, c] = settings.values[k];
        if (kind === "colour") gl.uniform3f(place, a, b, c);
        else if (kind === "choice") gl.uniform1i(place, a);
        else gl.uniform1f(place, a);
      });
      bindTable(gl, program, brdf);
    },
  };
}

export class ShaderBrdf implements Shaded {
  readonly kind = "file";

  constructor(
    readonly settings: Settings,
    readonly shading: Shading,
  ) {}

  get label(): string {
    return specText(this.settings);
  }

  get text(): string {
    return `file:${this.label}`;
  }

  eval(wi: Directions, wo: Directions): Rgb {
    return theEvaluator().eval(this, this.shading, wi, wo);
  }

  /** The same file with the values of "NAME=..." words; what does not fit is left out. */
  withWords(words: readonly string[]): ShaderBrdf {
    const { model } = this.settings,
      values = model.parameters.map(parameter => [...parameter.initial]),
      given = values.map(() => false);
    for (const word of words) {
      const [name, text] = word.split("="),
        k = model.parameters.findIndex(parameter => parameter.name === name);
      if (k < 0 || text === undefined) continue;
      const choice = model.parameters[k].choices.indexOf(text),
        numbers = choice >= 0 ? [choice] : text.split(",").map(Number);
      if (!numbers.every(Number.isFinite)) continue;
      values[k] = numbers.length === 3 ? numbers : [numbers[0], numbers[0], numbers[0]];
      given[k] = true;
    }
    return new ShaderBrdf({ model, values, given }, this.shading);
  }
}

/** Compiles the file; an Error with the compiler's words if that fails. */
export function compileBrdf(file: BrdfFile): ShaderBrdf {
  const shading = shadingOf(file);
  try {
    theEvaluator().check(shading);
  } catch (error) {
    throw new Error(`${file.model.name}: the shader does not compile: ${(error as Error).message.split("\n")[0]}`);
  }
  const values = file.model.parameters.map(parameter => parameter.initial);
  return new ShaderBrdf({ model: file.model, values, given: values.map(() => false) }, shading);
}
