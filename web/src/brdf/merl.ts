/* merl.ts: measured isotropic BRDFs of the MERL database (.binary); io/merl.c says how they are stored.
 *
 * [matusik03] Matusik, Pfister, Brand and McMillan, A data-driven reflectance model, SIGGRAPH 2003.
 * SPDX-License-Identifier: MIT */
import type { Shading } from "../gl/shading";
import { bindTable, TABLE_SAMPLER } from "../gl/table_glsl";
import type { Vector } from "./angles";
import { HALF_ANGLES_GLSL, halfAngles } from "./half_angles";
import { Measured } from "./measured";

const HALF = 90,
  DIFFERENCE = 90,
  AZIMUTH = 180,
  COUNT = HALF * DIFFERENCE * AZIMUTH,
  HEADER = 12,
  BYTES = HEADER + 24 * COUNT;
const SCALE = [1 / 1500, 1.15 / 1500, 1.66 / 1500];
const FORM = `a MERL file is 90 x 90 x 180 x 3 numbers, ${BYTES} bytes`;

const SHADING: Shading = {
  text: `${HALF_ANGLES_GLSL}
uniform sampler3D merl;
vec3 shade_eval(vec3 wi, vec3 wo)
{
    if (wi.z <= 0.0 || wo.z <= 0.0) return vec3(0);
    vec3 a = half_angles(wi, wo);
    if (a.z < 0.0) a.z += 3.14159265;
    vec3 at = vec3(min(a.z*(180.0/3.14159265), 180.0), a.y*(90.0/1.57079633), 90.0*sqrt(a.x/1.57079633));
    at = clamp(at, vec3(0), vec3(180, 89, 89));
    ivec3 low = ivec3(at), high = min(low + 1, ivec3(180, 89, 89));
    vec3 part = at - vec3(low), f = vec3(0);
    for (int k = 0; k < 8; k++) {
        bvec3 up = bvec3((k & 1) != 0, (k & 2) != 0, (k & 4) != 0);
        ivec3 corner = ivec3(up.x ? high.x : low.x, up.y ? high.y : low.y, up.z ? high.z : low.z);
        vec3 w = vec3(up.x ? part.x : 1.0 - part.x, up.y ? part.y : 1.0 - part.y, up.z ? part.z : 1.0 - part.z);
        f += w.x*w.y*w.z*texelFetch(merl, ivec3(corner.x%180, corner.y, corner.z), 0).rgb;
    }
    return f*wi.z;
}
${TABLE_SAMPLER}`,
  bind: (gl, program, brdf) => {
    gl.activeTexture(gl.TEXTURE7);
    gl.bindTexture(gl.TEXTURE_3D, (brdf as Merl).texture(gl));
    gl.uniform1i(gl.getUniformLocation(program, "merl"), 7);
    gl.activeTexture(gl.TEXTURE0);
    bindTable(gl, program, brdf);
  },
};

export class Merl extends Measured {
  readonly shading = SHADING;
  private readonly angles = new Float64Array(3);

  /** `values`: red, green, blue for each azimuth, difference and half angle. */
  constructor(
    name: string,
    private readonly values: Float32Array,
  ) {
    super(name);
  }

  protected makeTexture(gl: WebGL2RenderingContext): WebGLTexture {
    const texture = gl.createTexture()!;
    gl.bindTexture(gl.TEXTURE_3D, texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
    gl.texStorage3D(gl.TEXTURE_3D, 1, gl.RGB32F, AZIMUTH, DIFFERENCE, HALF);
    gl.texSubImage3D(gl.TEXTURE_3D, 0, 0, 0, 0, AZIMUTH, DIFFERENCE, HALF, gl.RGB, gl.FLOAT, this.values);
    gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    return texture;
  }

  /** Linear between the measured angles. */
  protected look(wi: Vector, wo: Vector, sum: Float64Array): void {
    const { angles } = this;
    halfAngles(wi, wo, angles);
    const phi = angles[2] < 0 ? angles[2] + Math.PI : angles[2],
      right = Math.PI / 2;
    const at = [
      Math.min(HALF * Math.sqrt(angles[0] / right), HALF - 1),
      Math.min((DIFFERENCE * angles[1]) / right, DIFFERENCE - 1),
      Math.min((AZIMUTH * phi) / Math.PI, AZIMUTH),
    ];
    const low = at.map(Math.floor),
      tops = [HALF - 1, DIFFERENCE - 1, AZIMUTH],
      high = low.map((x, k) => Math.min(x + 1, tops[k])),
      part = at.map((x, k) => x - low[k]);
    sum.fill(0);
    for (let corner = 0; corner < 8; corner++) {
      const isUp = [corner & 1, corner & 2, corner & 4],
        [h, d, p] = isUp.map((up, k) => (up ? high[k] : low[k]));
      const weight = isUp.reduce((w, up, k) => w * (up ? part[k] : 1 - part[k]), 1),
        index = 3 * ((h * DIFFERENCE + d) * AZIMUTH + (p % AZIMUTH));
      for (let c = 0; c < 3; c++) sum[c] += weight * this.values[index + c];
    }
  }
}

/** Reads and checks a file; negative numbers, where nothing was measured, become 0. */
export function readMerl(name: string, bytes: ArrayBuffer): Merl {
  if (bytes.byteLength < HEADER) throw new Error(`${name}: has ${bytes.byteLength} bytes; ${FORM}`);
  const view = new DataView(bytes),
    sizes = [0, 4, 8].map(at => view.getUint32(at, true));
  if (sizes[0] !== HALF || sizes[1] !== DIFFERENCE || sizes[2] !== AZIMUTH)
    throw new Error(`${name}: its sizes are ${sizes.join(", ")}; ${FORM}`);
  if (bytes.byteLength !== BYTES) throw new Error(`${name}: has ${bytes.byteLength} bytes; ${FORM}`);
  const values = new Float32Array(3 * COUNT);
  for (let channel = 0; channel < 3; channel++)
    for (let i = 0; i < COUNT; i++) {
      const at = HEADER + 8 * (channel * COUNT + i),
        x = view.getFloat64(at, true);
      if (!Number.isFinite(x)) throw new Error(`${name}: byte ${at}: the number is not finite`);
      values[3 * i + channel] = Math.max(x, 0) * SCALE[channel];
    }
  return new Merl(name, values);
}
