/* half_angles.ts: Rusinkiewicz's coordinates of a pair of directions, as measurements are stored by them.
 *
 * SPDX-License-Identifier: MIT */

import type { Vector } from "./angles";

/** theta_h, theta_d and phi_d [rad] into `to`; both directions above the horizon. */
export function halfAngles(wi: Vector, wo: Vector, to: Float64Array): void {
  let hx = wi[0] + wo[0],
    hy = wi[1] + wo[1],
    hz = wi[2] + wo[2];
  const length = Math.hypot(hx, hy, hz);
  hx /= length;
  hy /= length;
  hz /= length;
  // wi turned so that h is the pole: its components along the meridian of h, across it, and along h.
  const sine = Math.hypot(hx, hy),
    c = sine > 0 ? hx / sine : 1,
    s = sine > 0 ? hy / sine : 0;
  const x = wi[0] * c * hz + wi[1] * s * hz - wi[2] * sine,
    y = -wi[0] * s + wi[1] * c,
    z = wi[0] * hx + wi[1] * hy + wi[2] * hz;
  to[0] = Math.atan2(sine, hz);
  to[1] = Math.atan2(Math.hypot(x, y), z);
  to[2] = Math.atan2(y, x);
}

/** The same for shaders. */
export const HALF_ANGLES_GLSL = `
vec3 half_angles(vec3 wi, vec3 wo)
{
    vec3 h = normalize(wi + wo);
    float s = length(h.xy);
    vec2 m = s > 0.0 ? h.xy/s : vec2(1, 0);
    float x = dot(wi.xy, m)*h.z - wi.z*s, y = wi.y*m.x - wi.x*m.y;
    return vec3(atan(s, h.z), atan(length(vec2(x, y)), dot(wi, h)), abs(x) + abs(y) > 0.0 ? atan(y, x) : 0.0);
}
`;
