/* spheres.ts: lit spheres, one a tile: seen from far away, lit by one direction.
 *
 * The tangent runs along the circles of latitude, from left to right.
 * SPDX-License-Identifier: MIT */
import type { Brdf } from "../brdf/brdf";
import { HEAD, Programs, QUAD_VERTEX } from "./programs";
import type { Shading } from "./shading";

const REST = `
uniform vec2 centre;
uniform float radius, exposure;
uniform vec3 light;
uniform bool has_cosine;
out vec4 result;
void main()
{
    vec2 p = (gl_FragCoord.xy - centre)/radius;
    float r2 = dot(p, p);
    vec3 n = vec3(p, sqrt(max(1.0 - r2, 0.0)));
    vec3 t = normalize(vec3(n.z, 0, -n.x)), b = cross(n, t);
    vec3 wi = vec3(dot(t, light), dot(b, light), dot(n, light)), wo = vec3(t.z, b.z, n.z);
    vec3 f = wi.z > 0.0 && wo.z > 0.0 ? shade_eval(wi, wo) : vec3(0);
    if (!has_cosine) f /= max(wi.z, 1e-6);
    vec3 seen = pow(clamp(exposure*f, 0.0, 1.0), vec3(1.0/2.2));
    result = vec4(seen, clamp(0.5 + radius*(1.0 - sqrt(r2)), 0.0, 1.0));
}`;

export interface Tile {
  /** In pixels of the canvas, from its lower left. */
  readonly x: number;
  readonly y: number;
  readonly radius: number;
}

export interface Lighting {
  readonly light: readonly number[];
  readonly exposure: number;
  readonly hasCosine: boolean;
}

export class SphereRenderer {
  private readonly programs: Programs;

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.programs = new Programs(gl, QUAD_VERTEX, HEAD, REST);
    gl.enable(gl.SCISSOR_TEST);
  }

  clear(): void {
    const { gl } = this;
    gl.viewport(0, 0, gl.canvas.width, gl.canvas.height);
    gl.scissor(0, 0, gl.canvas.width, gl.canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }

  /** Whether it could be drawn now. */
  draw(tile: Tile, shading: Shading, brdf: Brdf, lighting: Lighting): boolean {
    const { gl } = this,
      program = this.programs.of(shading);
    if (!program) return false;
    const place = (name: string): WebGLUniformLocation | null => gl.getUniformLocation(program, name);
    gl.useProgram(program);
    const side = Math.ceil(2 * tile.radius) + 4;
    gl.scissor(Math.floor(tile.x - side / 2), Math.floor(tile.y - side / 2), side, side);
    gl.uniform2f(place("centre"), tile.x, tile.y);
    gl.uniform1f(place("radius"), tile.radius);
    gl.uniform1f(place("exposure"), lighting.exposure);
    gl.uniform3f(place("light"), lighting.light[0], lighting.light[1], lighting.light[2]);
    gl.uniform1i(place("has_cosine"), lighting.hasCosine ? 1 : 0);
    shading.bind(gl, program, brdf);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    return true;
  }
}
