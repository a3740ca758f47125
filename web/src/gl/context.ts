/* context.ts: a WebGL 2 context for a canvas, and its end.
 *
 * SPDX-License-Identifier: MIT */

/** Undefined where the browser has no WebGL 2. */
export function openGl(canvas: HTMLCanvasElement): WebGL2RenderingContext | undefined {
  const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true, premultipliedAlpha: false });
  return gl ?? undefined;
}

/** Browsers allow few contexts: one that is not used any more is given back at once. */
export function closeGl(gl: WebGL2RenderingContext | undefined): void {
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
}

export function fitCanvas(canvas: HTMLCanvasElement, width: number, height: number): number {
  const ratio = Math.min(devicePixelRatio || 1, 2),
    w = Math.max(1, Math.round(width * ratio)),
    h = Math.max(1, Math.round(height * ratio));
  if (canvas.width !== w) canvas.width = w;
  if (canvas.height !== h) canvas.height = h;
  canvas.style.width = `${width}px`;
  canvas.style.height = `${height}px`;
  return ratio;
}

export const NO_GL = "This view needs WebGL 2, which this browser does not offer.";
