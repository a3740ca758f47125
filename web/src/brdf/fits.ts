/* fits.ts: fits of MERL materials by small neural networks, which are no measurements; public/fits/LICENCE.txt.
 *
 * [sztrajman21] Sztrajman, Rainer, Ritschel and Weyrich, Neural BRDF Representation and Importance Sampling: the half
 * vector and the difference vector, two layers of 21 with max(x, 0), and max(exp(x) - 1, 0) at the end.
 * SPDX-License-Identifier: MIT */
import names from "../../public/fits/merl100.names.txt?raw";
import type { Shaded, Shading } from "../gl/shading";
import { bindTable, TABLE_SAMPLER } from "../gl/table_glsl";
import type { Brdf, Directions, Rgb } from "./brdf";
import { HALF_ANGLES_GLSL, halfAngles } from "./half_angles";

const INPUTS = 6,
  HIDDEN = 21,
  OUTPUTS = 3;
const W1 = 0,
  B1 = W1 + INPUTS * HIDDEN,
  W2 = B1 + HIDDEN,
  B2 = W2 + HIDDEN * HIDDEN,
  W3 = B2 + HIDDEN,
  B3 = W3 + HIDDEN * OUTPUTS,
  COUNT = B3 + OUTPUTS,
  VECTORS = Math.ceil(COUNT / 4);

export const FIT_NAMES: readonly string[] = names.trim().split("\n");

const SHADING: Shading = {
  text: `${HALF_ANGLES_GLSL}
uniform vec4 weights[${VECTORS}];
float weight_of(int k) { return weights[k >> 2][k & 3]; }
vec3 shade_eval(vec3 wi, vec3 wo)
{
    if (wi.z <= 0.0 || wo.z <= 0.0) return vec3(0);
    vec3 a = half_angles(wi, wo);
    float x[${INPUTS}] = float[${INPUTS}](sin(a.x), 0.0, cos(a.x), sin(a.y)*cos(a.z), sin(a.y)*sin(a.z), cos(a.y));
    float first[${HIDDEN}], second[${HIDDEN}];
    for (int j = 0; j < ${HIDDEN}; j++) {
        float sum = weight_of(${B1} + j);
        for (int i = 0; i < ${INPUTS}; i++) sum += x[i]*weight_of(${W1} + ${HIDDEN}*i + j);
        first[j] = max(sum, 0.0);
    }
    for (int j = 0; j < ${HIDDEN}; j++) {
        float sum = weight_of(${B2} + j);
        for (int i = 0; i < ${HIDDEN}; i++) sum += first[i]*weight_of(${W2} + ${HIDDEN}*i + j);
        second[j] = max(sum, 0.0);
    }
    vec3 f = vec3(weight_of(${B3}), weight_of(${B3} + 1), weight_of(${B3} + 2));
    for (int i = 0; i < ${HIDDEN}; i++) {
        int k = ${W3} + ${OUTPUTS}*i;
        f += second[i]*vec3(weight_of(k), weight_of(k + 1), weight_of(k + 2));
    }
    return max(exp(min(f, 80.0)) - 1.0, 0.0)*wi.z;
}
${TABLE_SAMPLER}`,
  bind: (gl, program, brdf) => {
    gl.uniform4fv(gl.getUniformLocation(program, "weights"), (brdf as Fit).padded);
    bindTable(gl, program, brdf);
  },
};

/** to[j] = from + sum of x[i] W[i][j]. */
function layer(w: Float32Array, matrix: number, bias: number, x: Float64Array, to: Float64Array): void {
  const n = to.length;
  for (let j = 0; j < n; j++) to[j] = w[bias + j];
  for (let i = 0; i < x.length; i++) {
    const value = x[i];
    if (value !== 0) for (let j = 0; j < n; j++) to[j] += value * w[matrix + n * i + j];
  }
}

class Fit implements Shaded {
  readonly kind = "fit";
  readonly shading = SHADING;
  readonly padded = new Float32Array(4 * VECTORS);
  private readonly angles = new Float64Array(3);
  private readonly layers = [INPUTS, HIDDEN, HIDDEN, OUTPUTS].map(n => new Float64Array(n));

  constructor(
    readonly name: string,
    private readonly w: Float32Array,
  ) {
    this.padded.set(w);
  }

  get label(): string {
    return `fit of MERL ${this.name}`;
  }

  get text(): string {
    return `fit:${this.name}`;
  }

  eval(wi: Directions, wo: Directions): Rgb {
    const n = wi.x.length,
      rgb = { r: new Float32Array(n), g: new Float32Array(n), b: new Float32Array(n) };
    const { angles, w } = this,
      [x, first, second, f] = this.layers;
    for (let i = 0; i < n; i++) {
      if (!(wi.z[i] > 0 && wo.z[i] > 0)) continue;
      halfAngles([wi.x[i], wi.y[i], wi.z[i]], [wo.x[i], wo.y[i], wo.z[i]], angles);
      const [h, d, phi] = angles,
        sine = Math.sin(d);
      x.set([Math.sin(h), 0, Math.cos(h), sine * Math.cos(phi), sine * Math.sin(phi), Math.cos(d)]);
      layer(w, W1, B1, x, first);
      for (let j = 0; j < HIDDEN; j++) first[j] = Math.max(first[j], 0);
      layer(w, W2, B2, first, second);
      for (let j = 0; j < HIDDEN; j++) second[j] = Math.max(second[j], 0);
      layer(w, W3, B3, second, f);
      rgb.r[i] = Math.max(Math.expm1(f[0]), 0) * wi.z[i];
      rgb.g[i] = Math.max(Math.expm1(f[1]), 0) * wi.z[i];
      rgb.b[i] = Math.max(Math.expm1(f[2]), 0) * wi.z[i];
    }
    return rgb;
  }
}

let loading: Promise<Float32Array> | undefined;

export async function loadFit(name: string): Promise<Brdf> {
  const place = FIT_NAMES.indexOf(name);
  if (place < 0) throw new Error(`there is no fit of a material ${name}`);
  loading ??= fetch(new URL("./fits/merl100.f32", document.baseURI)).then(async answer => {
    if (!answer.ok) throw new Error(`the fits could not be loaded: ${answer.status}`);
    return new Float32Array(await answer.arrayBuffer());
  });
  return new Fit(name, (await loading).slice(place * COUNT, (place + 1) * COUNT));
}
