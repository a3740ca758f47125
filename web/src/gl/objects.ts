/* objects.ts: objects under light from all around, until there are enough samples, each of which is a direction drawn by
 * the brightness of the light and one drawn by the material, weighted by the power heuristic.
 *
 * [veach97] Veach, Robust Monte Carlo Methods for Light Transport Simulation, 1997, section 9.2.
 * Sums are kept in two textures of 32-bit floats in turn: red, green, blue, and how many samples.
 * SPDX-License-Identifier: MIT */
import * as twgl from "twgl.js";
import type { Brdf } from "../brdf/brdf";
import type { Environment } from "../brdf/environment";
import { densityMap, lightSamples, materialNumbers } from "../brdf/light_samples";
import type { State } from "../state/state";
import type { Camera } from "./camera";
import { HEAD, Programs, QUAD_VERTEX } from "./programs";
import type { Shading } from "./shading";
import type { Shape } from "./shapes";
import { bindSums, createSums, deleteSums, type Sums } from "./sums";

export const MOST_SAMPLES = 4096;
/* Samples of a round: so many that it takes about a frame. */
const LEAST_EACH = 1,
  MOST_EACH = 16,
  SHORT = 10,
  LONG = 25, // ms
  // Where a single sample of the whole picture takes longer than this (WebGL in software), a coarser picture is made.
  TOO_LONG = 150,
  LOW_QUALITY = 0.5;

const VERTEX = `#version 300 es
uniform vec3 right, up, out_;
uniform vec2 scale, shift;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 tangent;
out vec3 n, t;
void main()
{
    n = normal;
    t = tangent;
    gl_Position = vec4(scale*vec2(dot(right, position), dot(up, position)) + shift, -0.4*dot(out_, position), 1);
}`;

/* Two programs, one for each way to draw directions, and a pass for each sample: of loops around a sampler the optimiser
 * of software rendering (SwiftShader) takes minutes. */
const START = `
uniform vec3 out_;
uniform float n_added;
uniform bool is_alone; // without the other way
uniform sampler2D before;
in vec3 n, t;
out vec4 result;
float weight_of(float own, float other) { float ratio = is_alone ? 0.0 : other/own; return 1.0/(1.0 + ratio*ratio); }
void main()
{
    vec3 axis = normalize(dot(n, out_) < 0.0 ? -n : n), x = normalize(t - dot(t, axis)*axis), y = cross(axis, x);
    vec3 wo = normalize(vec3(dot(out_, x), dot(out_, y), max(dot(out_, axis), 0.01))), sum = vec3(0);
`,
  END = `
    result = texelFetch(before, ivec2(gl_FragCoord.xy), 0) + vec4(sum, n_added);
}`;

const BY_LIGHT = `
uniform vec3 light, power;
uniform float density;
${START}
    vec3 wi = vec3(dot(light, x), dot(light, y), dot(light, axis)), f = shade_eval(wi, wo);
    if (f != vec3(0)) sum = f*power*weight_of(density, shade_pdf(wi, wo));
${END}`;

const BY_MATERIAL = `
uniform vec3 numbers;
uniform sampler2D environment; // radiance, and the density with which directions to it are drawn
// An offset for each pixel, so that neighbours do not err alike.
vec3 offset_of(uvec2 pixel)
{
    uvec3 v = uvec3(pixel, pixel.x ^ 0x9e3779b9u)*1664525u + 1013904223u;
    v.x += v.y*v.z; v.y += v.z*v.x; v.z += v.x*v.y;
    v ^= v >> 16u;
    v.x += v.y*v.z; v.y += v.z*v.x; v.z += v.x*v.y;
    return vec3(v >> 8u)/16777216.0;
}
vec4 light_from(vec3 v)
{
    ivec2 size = textureSize(environment, 0);
    vec2 at = vec2(fract(atan(v.x, v.y)/6.28318531), acos(clamp(v.z, -1.0, 1.0))/3.14159265);
    return texelFetch(environment, min(ivec2(at*vec2(size)), size - 1), 0);
}
${START}
    vec3 wi;
    float pdf;
    vec3 weight = shade_sample(wo, fract(numbers + offset_of(uvec2(gl_FragCoord.xy))), wi, pdf);
    vec4 light = light_from(x*wi.x + y*wi.y + axis*wi.z);
    if (weight != vec3(0)) sum = weight*light.rgb*weight_of(pdf, light.a);
${END}`;

const DISPLAY = `${HEAD}
uniform sampler2D sums;
uniform float exposure, n_all, quality;
out vec4 result;
void main()
{
    vec4 sum = texelFetch(sums, ivec2(gl_FragCoord.xy*quality), 0);
    vec3 mean = sum.a > 0.0 ? sum.rgb/sum.a : vec3(0);
    result = vec4(pow(clamp(exposure*mean, 0.0, 1.0), vec3(1.0/2.2)), clamp(sum.a/n_all, 0.0, 1.0));
}`;

export interface ObjectTile {
  readonly x: number;
  readonly y: number;
  readonly side: number;
  readonly shading: Shading;
  readonly brdf: Brdf;
}

export interface ObjectScene {
  /** Changes whenever the sums must begin again. */
  readonly key: string;
  readonly tiles: readonly ObjectTile[];
  readonly shape: Shape;
  readonly environment: Environment;
  readonly sampling: State["sampling"];
  readonly camera: Camera;
  readonly exposure: number;
}

export class ObjectRenderer {
  /** By the light, by the material. */
  private readonly programs: readonly Programs[];
  private readonly display: twgl.ProgramInfo;
  private sums: Sums[] = [];
  private mesh: { shape: Shape; vao: WebGLVertexArrayObject; buffers: WebGLBuffer[] } | undefined;
  private light: { environment: Environment; texture: WebGLTexture } | undefined;
  /** Pixels of the sums for a pixel of the canvas. */
  private quality = 1;
  private key = "";
  private frame = 0;
  private each = LEAST_EACH;
  private n_done = 0;
  private round: { fence: WebGLSync; begun: number } | undefined;
  private rest = 0;

  constructor(private readonly gl: WebGL2RenderingContext) {
    if (!gl.getExtension("EXT_color_buffer_float"))
      throw new Error("This view sums in floats, which this browser's WebGL cannot draw to (EXT_color_buffer_float).");
    this.programs = [BY_LIGHT, BY_MATERIAL].map(rest => new Programs(gl, VERTEX, HEAD, rest));
    this.display = twgl.createProgramInfo(gl, [QUAD_VERTEX, DISPLAY]);
  }

  get samples(): number {
    return this.n_done;
  }

  private resize(): void {
    const { gl, quality } = this,
      width = Math.ceil(gl.canvas.width * quality),
      height = Math.ceil(gl.canvas.height * quality);
    const size = this.sums[0];
    if (size && size.width === width && size.height === height) return;
    for (const old of this.sums) deleteSums(gl, old);
    this.sums = [createSums(gl, width, height), createSums(gl, width, height)];
    this.key = "";
  }

  private load(scene: ObjectScene): void {
    const { gl } = this;
    if (this.mesh?.shape !== scene.shape) {
      const { position, normal, tangent, indices } = scene.shape;
      for (const old of this.mesh?.buffers ?? []) gl.deleteBuffer(old);
      if (this.mesh) gl.deleteVertexArray(this.mesh.vao);
      const vao = gl.createVertexArray()!,
        buffers = [0, 1, 2, 3].map(() => gl.createBuffer()!);
      gl.bindVertexArray(vao);
      [position, normal, tangent].forEach((data, k) => {
        gl.bindBuffer(gl.ARRAY_BUFFER, buffers[k]);
        gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
        gl.enableVertexAttribArray(k);
        gl.vertexAttribPointer(k, 3, gl.FLOAT, false, 0, 0);
      });
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffers[3]);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
      gl.bindVertexArray(null);
      this.mesh = { shape: scene.shape, vao, buffers };
    }
    if (this.light?.environment !== scene.environment) {
      const { width, height } = scene.environment,
        texture = this.light?.texture ?? gl.createTexture()!;
      gl.activeTexture(gl.TEXTURE0);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      const texels = densityMap(scene.environment);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, texels);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
      this.light = { environment: scene.environment, texture };
    }
  }

  /** Whether the last round is over, and as much time again for the rest of the page has passed. */
  private isFree(): boolean {
    const { gl, round } = this,
      now = performance.now();
    if (round) {
      if (gl.clientWaitSync(round.fence, gl.SYNC_FLUSH_COMMANDS_BIT, 0) === gl.TIMEOUT_EXPIRED) return false;
      gl.deleteSync(round.fence);
      const took = now - round.begun;
      if (took < SHORT && this.each < MOST_EACH) this.each *= 2;
      if (took > LONG && this.each > LEAST_EACH) this.each /= 2;
      if (took > TOO_LONG && this.frame > 1) this.quality = LOW_QUALITY;
      this.rest = now + (took > LONG ? Math.min(took, 500) : 0);
      this.round = undefined;
    }
    return now >= this.rest;
  }

  /** One more round of samples, if the last one is over; whether there are enough. */
  draw(scene: ObjectScene): boolean {
    if (!this.isFree()) return false;
    this.resize();
    this.load(scene);
    if (this.key !== scene.key) {
      this.key = scene.key;
      this.frame = this.n_done = 0;
    }
    const ways = this.programs.filter((_, k) => scene.sampling !== (k ? "light" : "material"));
    const programs = ways.map(way => scene.tiles.map(tile => way.of(tile.shading)));
    if (programs.flat().some(program => !program)) return false;
    if (this.samples < MOST_SAMPLES) this.accumulate(scene, programs as WebGLProgram[][]);
    this.show(scene.exposure);
    this.round = { fence: this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0)!, begun: performance.now() };
    return this.samples >= MOST_SAMPLES;
  }

  /** One pass for each way to draw directions. */
  private accumulate(scene: ObjectScene, ways: readonly (readonly WebGLProgram[])[]): void {
    const { gl } = this;
    if (this.frame === 0) {
      bindSums(gl, this.sums[0]);
      gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
    }
    const lights = lightSamples(scene.environment, this.n_done, this.each),
      numbers = materialNumbers(this.n_done, this.each);
    for (let sample = 0; sample < this.each; sample++)
      ways.forEach((programs, k) => {
        const [from, to] = this.sums;
        bindSums(gl, to);
        this.copy(from, to);
        gl.enable(gl.DEPTH_TEST);
        gl.disable(gl.BLEND);
        gl.clear(gl.DEPTH_BUFFER_BIT);
        gl.bindVertexArray(this.mesh!.vao);
        scene.tiles.forEach((tile, i) => {
          const place = (name: string): WebGLUniformLocation | null => gl.getUniformLocation(programs[i], name),
            three = (of: Float32Array): Float32Array => of.subarray(3 * sample, 3 * sample + 3);
          gl.useProgram(programs[i]);
          gl.uniform1i(place("is_alone"), Number(ways.length === 1));
          gl.uniform1f(place("n_added"), k === 0 ? 1 : 0);
          gl.uniform3fv(place("light"), three(lights.directions));
          gl.uniform3fv(place("power"), three(lights.powers));
          gl.uniform1f(place("density"), lights.densities[sample]);
          gl.uniform3fv(place("numbers"), three(numbers));
          this.drawTile(scene, tile, programs[i], from);
        });
        gl.bindVertexArray(null);
        gl.disable(gl.DEPTH_TEST);
        this.sums = [to, from];
      });
    this.frame++;
    this.n_done += this.each;
  }

  /** A subpixel's offset moves with each frame, and so edges are smooth; what it leaves keeps its sum. */
  private copy(from: Sums, to: Sums): void {
    const { gl } = this,
      { width, height } = from;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, from.framebuffer);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, to.framebuffer);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, to.framebuffer);
  }

  private drawTile(scene: ObjectScene, tile: ObjectTile, program: WebGLProgram, before: Sums): void {
    const { gl, frame } = this,
      { width, height } = gl.canvas,
      { camera } = scene;
    const place = (name: string): WebGLUniformLocation | null => gl.getUniformLocation(program, name);
    const jitter = [((frame + 0.5) * 0.7548776662) % 1, ((frame + 0.5) * 0.5698402909) % 1];
    gl.uniform3fv(place("right"), camera.right);
    gl.uniform3fv(place("up"), camera.up);
    gl.uniform3fv(place("out_"), camera.out);
    gl.uniform2f(place("scale"), (0.92 * tile.side) / width, (0.92 * tile.side) / height);
    gl.uniform2f(
      place("shift"),
      (2 * (tile.x + jitter[0] - 0.5)) / width - 1,
      (2 * (tile.y + jitter[1] - 0.5)) / height - 1,
    );
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, this.light!.texture);
    gl.uniform1i(place("environment"), 1);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, before.texture);
    gl.uniform1i(place("before"), 0);
    tile.shading.bind(gl, program, tile.brdf);
    gl.drawElements(gl.TRIANGLES, scene.shape.indices.length, gl.UNSIGNED_INT, 0);
  }

  private show(exposure: number): void {
    const { gl, display } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, gl.canvas.width, gl.canvas.height);
    gl.useProgram(display.program);
    twgl.setUniforms(display, {
      sums: this.sums[0].texture,
      exposure,
      quality: this.quality,
      n_all: Math.max(1, this.samples),
    });
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }
}
