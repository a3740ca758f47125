/* camera.ts: an orthographic camera that looks at the origin, for WebGL and for labels alike.
 *
 * SPDX-License-Identifier: MIT */
import { cross, DEGREE, dot, type Vector } from "../brdf/angles";

export interface Camera {
  readonly right: Vector;
  readonly up: Vector;
  /** To the eye. */
  readonly out: Vector;
}

/** `turn` about the normal and `tilt` above the surface, in degrees. */
export function cameraAt(turn: number, tilt: number): Camera {
  const a = turn * DEGREE,
    e = tilt * DEGREE;
  const right: Vector = [Math.cos(a), Math.sin(a), 0],
    out: Vector = [Math.sin(a) * Math.cos(e), -Math.cos(a) * Math.cos(e), Math.sin(e)];
  return { right, out, up: cross(out, right) };
}

/** Places in pixels: `centre` is the origin's, `scale` the length of 1. */
export function project(
  camera: Camera,
  v: readonly number[],
  centre: readonly number[],
  scale: number,
): [number, number] {
  return [centre[0] + scale * dot(camera.right, v), centre[1] - scale * dot(camera.up, v)];
}
