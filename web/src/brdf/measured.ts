/* measured.ts: what measured files have in common: a name, a value for a pair of directions, a texture for each canvas.
 *
 * SPDX-License-Identifier: MIT */
import type { Shaded, Shading } from "../gl/shading";
import type { Vector } from "./angles";
import type { Directions, Rgb } from "./brdf";

export abstract class Measured implements Shaded {
  readonly kind = "measured";
  abstract readonly shading: Shading;
  private readonly textures = new WeakMap<WebGL2RenderingContext, WebGLTexture>();

  constructor(readonly name: string) {}

  get label(): string {
    return `measured ${this.name}`;
  }

  get text(): string {
    return `file:${this.name}`;
  }

  /** f of two directions above the horizon, into `sum`. */
  protected abstract look(wi: Vector, wo: Vector, sum: Float64Array): void;

  /** The measurements for the shading. */
  protected abstract makeTexture(gl: WebGL2RenderingContext): WebGLTexture;

  texture(gl: WebGL2RenderingContext): WebGLTexture {
    let texture = this.textures.get(gl);
    if (!texture) this.textures.set(gl, (texture = this.makeTexture(gl)));
    return texture;
  }

  eval(wi: Directions, wo: Directions): Rgb {
    const n = wi.x.length,
      rgb = { r: new Float32Array(n), g: new Float32Array(n), b: new Float32Array(n) },
      sum = new Float64Array(3);
    for (let i = 0; i < n; i++) {
      if (!(wi.z[i] > 0 && wo.z[i] > 0)) continue;
      this.look([wi.x[i], wi.y[i], wi.z[i]], [wo.x[i], wo.y[i], wo.z[i]], sum);
      rgb.r[i] = sum[0] * wi.z[i];
      rgb.g[i] = sum[1] * wi.z[i];
      rgb.b[i] = sum[2] * wi.z[i];
    }
    return rgb;
  }
}
