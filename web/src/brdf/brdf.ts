/* brdf.ts: what every reflection model on the page can do, wherever it comes from.
 *
 * Directions are unit vectors away from the surface, in its frame with n = (0,0,1): wi to the light, wo to the viewer.
 * SPDX-License-Identifier: MIT */

/** n directions, as arrays of coordinates. */
export interface Directions {
  readonly x: Float32Array;
  readonly y: Float32Array;
  readonly z: Float32Array;
}

export interface Rgb {
  readonly r: Float32Array;
  readonly g: Float32Array;
  readonly b: Float32Array;
}

/** "facet": a model of the library.  "file": a .brdf file of Disney's BRDF Explorer.  "measured": a MERL file.
 *  "fit": a neural network fitted to a MERL material, which is no measurement. */
export type BrdfKind = "facet" | "file" | "measured" | "fit";

export interface Brdf {
  readonly kind: BrdfKind;
  readonly label: string;
  /** Changes whenever the values do. */
  readonly text: string;
  /** f cos(theta_i), 1/sr; 0 below the horizon. */
  eval(wi: Directions, wo: Directions): Rgb;
}

/** Directions that are drawn for a viewer by three numbers in [0,1) each, and their density; 0 where there is none. */
export interface Sampling {
  readonly isDelta: boolean;
  pdf(wi: Directions, wo: Directions): Float32Array;
  sample(wo: Directions, u: Directions): { readonly wi: Directions; readonly pdf: Float32Array };
}

export function newDirections(n: number): Directions {
  return { x: new Float32Array(n), y: new Float32Array(n), z: new Float32Array(n) };
}

export function setDirection(to: Directions, i: number, from: readonly number[]): void {
  to.x[i] = from[0];
  to.y[i] = from[1];
  to.z[i] = from[2];
}

/** n times the same direction. */
export function sameDirections(n: number, from: readonly number[]): Directions {
  return {
    x: new Float32Array(n).fill(from[0]),
    y: new Float32Array(n).fill(from[1]),
    z: new Float32Array(n).fill(from[2]),
  };
}
