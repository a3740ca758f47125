/* sums.ts: a picture of 32-bit floats to draw into and to read from, with depth.
 *
 * SPDX-License-Identifier: MIT */

export interface Sums {
  readonly framebuffer: WebGLFramebuffer;
  readonly texture: WebGLTexture;
  readonly depth: WebGLRenderbuffer;
  readonly width: number;
  readonly height: number;
}

export function createSums(gl: WebGL2RenderingContext, width: number, height: number): Sums {
  const framebuffer = gl.createFramebuffer()!,
    texture = gl.createTexture()!,
    depth = gl.createRenderbuffer()!;
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, width, height);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
  gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, width, height);
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
  gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
  return { framebuffer, texture, depth, width, height };
}

export function deleteSums(gl: WebGL2RenderingContext, sums: Sums): void {
  gl.deleteFramebuffer(sums.framebuffer);
  gl.deleteTexture(sums.texture);
  gl.deleteRenderbuffer(sums.depth);
}

export function bindSums(gl: WebGL2RenderingContext, sums: Sums): void {
  gl.bindFramebuffer(gl.FRAMEBUFFER, sums.framebuffer);
  gl.viewport(0, 0, sums.width, sums.height);
}
