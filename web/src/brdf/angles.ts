/* angles.ts: directions from angles, in degrees; the conventions of `facet plot`.
 *
 * SPDX-License-Identifier: MIT */

export type Vector = [number, number, number];

export const DEGREE = Math.PI / 180;

/** At theta from the normal; negative theta is on the other side of it. */
export function direction(theta: number, phi: number): Vector {
  // Exactly in the surface at 90 degrees, where a cosine of 6e-17 would be above it.
  const t = theta * DEGREE,
    p = phi * DEGREE,
    cosine = Math.abs(theta) === 90 ? 0 : Math.cos(t);
  return [Math.sin(t) * Math.cos(p), Math.sin(t) * Math.sin(p), cosine];
}

/** At `away` from the direction (theta, phi), `around` it, counted from the plane of that direction and the normal. */
export function around(theta: number, phi: number, away: number, turn: number): Vector {
  const [x, y, z] = direction(away, turn),
    t = theta * DEGREE,
    p = phi * DEGREE;
  const along = Math.cos(t) * x + Math.sin(t) * z;
  return [
    along * Math.cos(p) - y * Math.sin(p),
    along * Math.sin(p) + y * Math.cos(p),
    Math.cos(t) * z - Math.sin(t) * x,
  ];
}

/** Both directions from the half vector's and the difference's angles (Rusinkiewicz 1998). */
export function fromHalfAngles(thetaH: number, phiH: number, thetaD: number, phiD: number): { wi: Vector; wo: Vector } {
  return { wi: around(thetaH, phiH, thetaD, phiD), wo: around(thetaH, phiH, -thetaD, phiD) };
}

export function dot(a: readonly number[], b: readonly number[]): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

export function normalised(v: readonly number[]): Vector {
  const length = Math.hypot(v[0], v[1], v[2]);
  return [v[0] / length, v[1] / length, v[2] / length];
}

export function cross(a: readonly number[], b: readonly number[]): Vector {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}
