/* evaluator.ts: values of a material that exists as GLSL alone, for the views that plot numbers.
 *
 * Directions go in as two textures of floats, values come back from a third.
 * SPDX-License-Identifier: MIT */
import type { Brdf, Directions, Rgb } from "../brdf/brdf";
import { NO_GL, openGl } from "./context";
import { HEAD, Programs, QUAD_VERTEX } from "./programs";
import type { Shading } from "./shading";
import { bindSums, createSums, deleteSums, type Sums } from "./sums";

const REST = `
uniform sampler2D wi_map, wo_map;
out vec4 result;
void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    result = vec4(shade_eval(texelFetch(wi_map, at, 0).xyz, texelFetch(wo_map, at, 0).xyz), 1);
}`;
const WIDTH = 256;

class Evaluator {
  private readonly programs: Programs;
  private readonly maps: WebGLTexture[];
  private target: Sums | undefined;

  constructor(private readonly gl: WebGL2RenderingContext) {
    if (!gl.getExtension("EXT_color_buffer_float"))
      throw new Error("Files of GLSL need WebGL that draws floats (EXT_color_buffer_float).");
    this.programs = new Programs(gl, QUAD_VERTEX, HEAD, REST, false);
    this.maps = [0, 1].map(() => gl.createTexture()!);
  }

  /** ShaderProblem if it cannot be compiled. */
  check(shading: Shading): void {
    this.programs.of(shading);
  }

  private upload(k: number, { x, y, z }: Directions, height: number): void {
    const { gl } = this,
      texels = new Float32Array(4 * WIDTH * height);
    for (let i = 0; i < x.length; i++) texels.set([x[i], y[i], z[i], 0], 4 * i);
    gl.activeTexture(gl.TEXTURE0 + k);
    gl.bindTexture(gl.TEXTURE_2D, this.maps[k]);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, WIDTH, height, 0, gl.RGBA, gl.FLOAT, texels);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  }

  eval(brdf: Brdf, shading: Shading, wi: Directions, wo: Directions): Rgb {
    const { gl } = this,
      n = wi.x.length,
      height = Math.ceil(n / WIDTH),
      program = this.programs.of(shading)!;
    if (this.target?.height !== height) {
      if (this.target) deleteSums(gl, this.target);
      this.target = createSums(gl, WIDTH, height);
    }
    this.upload(0, wi, height);
    this.upload(1, wo, height);
    gl.useProgram(program);
    gl.uniform1i(gl.getUniformLocation(program, "wi_map"), 0);
    gl.uniform1i(gl.getUniformLocation(program, "wo_map"), 1);
    shading.bind(gl, program, brdf);
    bindSums(gl, this.target);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const texels = new Float32Array(4 * WIDTH * height);
    gl.readPixels(0, 0, WIDTH, height, gl.RGBA, gl.FLOAT, texels);
    const channel = (c: number): Float32Array => Float32Array.from({ length: n }, (_, i) => texels[4 * i + c]);
    return { r: channel(0), g: channel(1), b: channel(2) };
  }
}

let evaluator: Evaluator | undefined;

/** The page's one evaluator, made when it is first needed. */
export function theEvaluator(): Evaluator {
  if (!evaluator) {
    const gl = openGl(document.createElement("canvas"));
    if (!gl) throw new Error(NO_GL);
    evaluator = new Evaluator(gl);
  }
  return evaluator;
}
