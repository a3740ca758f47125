/* lobes.ts: surfaces around a point, translucent, the smaller ones over the larger ones.
 *
 * SPDX-License-Identifier: MIT */
import * as twgl from "twgl.js";
import type { Camera } from "./camera";

const VERTEX = `#version 300 es
in vec3 position;
uniform vec3 right, up, out_;
uniform vec2 scale, shift;
uniform float size;
out vec3 at;
void main()
{
    at = size*position;
    gl_Position = vec4(scale.x*dot(right, at) + shift.x, scale.y*dot(up, at) + shift.y, -0.4*dot(out_, at), 1);
}`;

const FRAGMENT = `#version 300 es
precision highp float;
in vec3 at;
uniform vec3 out_;
uniform vec4 colour;
uniform float is_lit;
out vec4 result;
void main()
{
    vec3 n = normalize(cross(dFdx(at), dFdy(at)) + vec3(1e-12));
    vec3 light = normalize(out_ + vec3(-0.4, -0.3, 0.7));
    float shade = mix(1.0, 0.45 + 0.55*abs(dot(n, light)), is_lit);
    result = vec4(shade*colour.rgb, colour.a);
}`;

export interface Surface {
  readonly positions: Float32Array;
  /** The length of 1 in the positions' units. */
  readonly size: number;
  readonly colour: readonly number[];
}

function circle(radius: number): number[] {
  return [...Array(97).keys()].flatMap(i => [
    radius * Math.cos((i * Math.PI) / 48),
    radius * Math.sin((i * Math.PI) / 48),
    0,
  ]);
}

export class LobeRenderer {
  private readonly program: twgl.ProgramInfo;
  private readonly surface: twgl.BufferInfo;
  private readonly circles: twgl.BufferInfo[];

  constructor(
    private readonly gl: WebGL2RenderingContext,
    indices: Uint16Array,
  ) {
    this.program = twgl.createProgramInfo(gl, [VERTEX, FRAGMENT]);
    this.surface = twgl.createBufferInfoFromArrays(gl, {
      position: { numComponents: 3, data: new Float32Array(3), drawType: gl.DYNAMIC_DRAW },
      indices,
    });
    this.circles = [1, 2 / 3, 1 / 3].map(radius =>
      twgl.createBufferInfoFromArrays(gl, { position: { numComponents: 3, data: circle(radius) } }),
    );
  }

  /** `scale`: of 1 in clip space, across and up; `shift`: where the origin is. */
  draw(camera: Camera, scale: number[], shift: number[], surfaces: readonly Surface[], grid: number[]): void {
    const { gl, program } = this;
    gl.viewport(0, 0, gl.canvas.width, gl.canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(program.program);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    twgl.setUniforms(program, { right: camera.right, up: camera.up, out_: camera.out, scale, shift });
    gl.disable(gl.DEPTH_TEST);
    this.circles.forEach((ring, k) => {
      twgl.setBuffersAndAttributes(gl, program, ring);
      twgl.setUniforms(program, { size: 1, is_lit: 0, colour: [...grid.slice(0, 3), k ? 0.8 : 1] });
      gl.drawArrays(gl.LINE_STRIP, 0, ring.numElements);
    });
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    for (const { positions, size, colour } of surfaces) this.drawSurface(positions, size, colour);
  }

  /** Its nearest layer alone: first the depths, then the colours. */
  private drawSurface(positions: Float32Array, size: number, colour: readonly number[]): void {
    const { gl, program, surface } = this;
    twgl.setAttribInfoBufferFromArray(gl, surface.attribs!.position, positions);
    twgl.setBuffersAndAttributes(gl, program, surface);
    twgl.setUniforms(program, { size, is_lit: 1, colour: [...colour, 0.8] });
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.colorMask(false, false, false, false);
    twgl.drawBufferInfo(gl, surface);
    gl.colorMask(true, true, true, true);
    twgl.drawBufferInfo(gl, surface);
  }
}
