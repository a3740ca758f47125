/* programs.ts: programs made of a view's own text and a material's, compiled once, in the background where WebGL can.
 *
 * SPDX-License-Identifier: MIT */
import type { Shading } from "./shading";

export class ShaderProblem extends Error {}

interface Made {
  readonly program: WebGLProgram;
  isReady: boolean;
}

function compile(gl: WebGL2RenderingContext, kind: number, text: string): WebGLShader {
  const shader = gl.createShader(kind)!;
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  return shader;
}

export class Programs {
  private readonly made = new Map<string, Made>();
  private readonly parallel: { COMPLETION_STATUS_KHR: number } | null;

  constructor(
    private readonly gl: WebGL2RenderingContext,
    private readonly vertex: string,
    private readonly head: string,
    private readonly rest: string,
    mayWait = true,
  ) {
    this.parallel = mayWait ? gl.getExtension("KHR_parallel_shader_compile") : null;
  }

  /** The program, or undefined while it is being compiled; ShaderProblem if it cannot be. */
  of(shading: Shading): WebGLProgram | undefined {
    const { gl } = this;
    let one = this.made.get(shading.text);
    if (!one) {
      const program = gl.createProgram()!;
      gl.attachShader(program, compile(gl, gl.VERTEX_SHADER, this.vertex));
      gl.attachShader(program, compile(gl, gl.FRAGMENT_SHADER, this.head + shading.text + this.rest));
      gl.linkProgram(program);
      this.made.set(shading.text, (one = { program, isReady: false }));
    }
    if (one.isReady) return one.program;
    if (this.parallel && !gl.getProgramParameter(one.program, this.parallel.COMPLETION_STATUS_KHR)) return undefined;
    if (!gl.getProgramParameter(one.program, gl.LINK_STATUS)) {
      const logs = (gl.getAttachedShaders(one.program) ?? []).map(shader => gl.getShaderInfoLog(shader) ?? "");
      throw new ShaderProblem(
        logs
          .concat(gl.getProgramInfoLog(one.program) ?? "")
          .join("\n")
          .trim(),
      );
    }
    one.isReady = true;
    return one.program;
  }
}

export const QUAD_VERTEX = `#version 300 es
void main()
{
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(4.0*corner - 1.0, 0, 1); // a triangle that covers the picture
}`;

export const HEAD = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler3D;
`;
