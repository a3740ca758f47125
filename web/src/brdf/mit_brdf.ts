/* mit_brdf.ts: anisotropic BRDFs measured at MIT, linear between the middles of the bins; files/mit.ts reads them.
 *
 * Bins that were not measured are left out; where none of the sixteen around was, f is 0.  Azimuths are of the directions
 * to the surface, as Disney's BRDF Explorer has them.
 * SPDX-License-Identifier: MIT */
import type { Shading } from "../gl/shading";
import { bindTable, TABLE_SAMPLER } from "../gl/table_glsl";
import type { Vector } from "./angles";
import { halves } from "./half_floats";
import { Measured } from "./measured";

export interface MitData {
  /** Of theta_in, theta_out, phi_diff and phi_in, which is fastest. */
  readonly bins: readonly [number, number, number, number];
  /** Whether phi_diff is from 0 to pi instead of 2 pi. */
  readonly isHalfTurn: boolean;
  /** Red, green and blue as half floats; negative where nothing was measured. */
  readonly values: Uint16Array;
}

const WIDTH = 4096,
  UNIT = 5;

const SHADING: Shading = {
  text: `
uniform highp sampler2D mit_values;
uniform ivec4 mit_bins;
uniform bool is_half_turn;
vec3 shade_eval(vec3 wi, vec3 wo)
{
    if (wi.z <= 0.0 || wo.z <= 0.0) return vec3(0);
    const float TURN = 6.28318531, RIGHT = 1.57079633;
    float phi = abs(wi.x) + abs(wi.y) > 0.0 ? atan(-wi.y, -wi.x) : 0.0;
    float other = abs(wo.x) + abs(wo.y) > 0.0 ? atan(-wo.y, -wo.x) : 0.0, between = fract((other - phi)/TURN);
    if (is_half_turn) between = 2.0*min(between, 1.0 - between);
    vec4 share = vec4(atan(length(wi.xy), wi.z)/RIGHT, atan(length(wo.xy), wo.z)/RIGHT, between, fract(phi/TURN));
    vec4 at = share*vec4(mit_bins) - 0.5;
    ivec4 low = ivec4(floor(at));
    vec4 part = at - vec4(low);
    vec3 sum = vec3(0);
    float weights = 0.0;
    for (int k = 0; k < 16; k++) {
        ivec4 up = ivec4(k & 1, (k >> 1) & 1, (k >> 2) & 1, k >> 3), bin = low + up;
        bin.xy = clamp(bin.xy, ivec2(0), mit_bins.xy - 1);
        bin.z = is_half_turn ? clamp(bin.z, 0, mit_bins.z - 1) : (bin.z + mit_bins.z)%mit_bins.z;
        bin.w = (bin.w + mit_bins.w)%mit_bins.w;
        vec4 w = mix(1.0 - part, part, vec4(up));
        int i = ((bin.x*mit_bins.y + bin.y)*mit_bins.z + bin.z)*mit_bins.w + bin.w;
        vec3 f = texelFetch(mit_values, ivec2(i%${WIDTH}, i/${WIDTH}), 0).rgb;
        float weight = w.x*w.y*w.z*w.w;
        if (min(f.r, min(f.g, f.b)) < 0.0) continue;
        sum += weight*f;
        weights += weight;
    }
    return weights > 0.0 ? sum/weights*wi.z : vec3(0);
}
${TABLE_SAMPLER}`,
  bind: (gl, program, brdf) => {
    const { data } = brdf as MitBrdf;
    gl.activeTexture(gl.TEXTURE0 + UNIT);
    gl.bindTexture(gl.TEXTURE_2D, (brdf as MitBrdf).texture(gl));
    gl.uniform1i(gl.getUniformLocation(program, "mit_values"), UNIT);
    gl.uniform4iv(gl.getUniformLocation(program, "mit_bins"), data.bins);
    gl.uniform1i(gl.getUniformLocation(program, "is_half_turn"), data.isHalfTurn ? 1 : 0);
    gl.activeTexture(gl.TEXTURE0);
    bindTable(gl, program, brdf);
  },
};

const fraction = (x: number): number => x - Math.floor(x);

export class MitBrdf extends Measured {
  readonly shading = SHADING;
  private readonly half = halves();

  constructor(
    name: string,
    readonly data: MitData,
  ) {
    super(name);
  }

  protected makeTexture(gl: WebGL2RenderingContext): WebGLTexture {
    const { values } = this.data,
      n = values.length / 3,
      width = Math.min(WIDTH, n),
      height = Math.ceil(n / WIDTH);
    if (Math.max(width, height) > (gl.getParameter(gl.MAX_TEXTURE_SIZE) as number))
      throw new Error(`${this.name}: has more bins than this browser's WebGL can hold`);
    const texture = gl.createTexture()!;
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 2);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGB16F, width, height);
    const whole = Math.floor(n / width),
      rest = n - whole * width;
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, whole, gl.RGB, gl.HALF_FLOAT, values);
    if (rest)
      gl.texSubImage2D(
        gl.TEXTURE_2D,
        ...([0, 0, whole, rest, 1, gl.RGB, gl.HALF_FLOAT, values.subarray(3 * whole * width)] as const),
      );
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    return texture;
  }

  private readonly share = new Float64Array(4);
  private readonly low = new Int32Array(4);
  private readonly part = new Float64Array(4);

  protected look(wi: Vector, wo: Vector, sum: Float64Array): void {
    const right = Math.PI / 2,
      turn = 2 * Math.PI,
      phi = wi[0] || wi[1] ? Math.atan2(-wi[1], -wi[0]) : 0,
      other = wo[0] || wo[1] ? Math.atan2(-wo[1], -wo[0]) : 0,
      between = fraction((other - phi) / turn);
    this.share[0] = Math.atan2(Math.hypot(wi[0], wi[1]), wi[2]) / right;
    this.share[1] = Math.atan2(Math.hypot(wo[0], wo[1]), wo[2]) / right;
    this.share[2] = this.data.isHalfTurn ? 2 * Math.min(between, 1 - between) : between;
    this.share[3] = fraction(phi / turn);
    this.interpolate(sum);
  }

  /** Linear between the bins around `share`. */
  private interpolate(sum: Float64Array): void {
    const { share, low, part, half } = this,
      { bins, isHalfTurn, values } = this.data;
    for (let k = 0; k < 4; k++) {
      const at = share[k] * bins[k] - 0.5;
      low[k] = Math.floor(at);
      part[k] = at - low[k];
    }
    let weights = 0;
    sum.fill(0);
    for (let corner = 0; corner < 16; corner++) {
      let weight = 1,
        index = 0;
      for (let k = 0; k < 4; k++) {
        const isUp = (corner >> k) & 1,
          bin = low[k] + isUp,
          isRound = k === 3 || (k === 2 && !isHalfTurn);
        weight *= isUp ? part[k] : 1 - part[k];
        index = index * bins[k] + (isRound ? (bin + bins[k]) % bins[k] : Math.min(Math.max(bin, 0), bins[k] - 1));
      }
      const [r, g, b] = [half[values[3 * index]], half[values[3 * index + 1]], half[values[3 * index + 2]]];
      if (Math.min(r, g, b) < 0) continue;
      sum[0] += weight * r;
      sum[1] += weight * g;
      sum[2] += weight * b;
      weights += weight;
    }
    if (weights > 0) for (let c = 0; c < 3; c++) sum[c] /= weights;
  }
}
