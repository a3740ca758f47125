/* quadrature.ts: the directional albedo of what has nothing but values: files, measurements and their fits.
 *
 * The library integrates its own models, to many digits; here the midpoint rule over a square, mapped so that points
 * gather around the mirror's direction: the square of the angle from it for steps, as lobes are narrow there.
 * SPDX-License-Identifier: MIT */
import { around, direction } from "./angles";
import { newDirections, sameDirections, setDirection, type Brdf } from "./brdf";

const RINGS = 96,
  TURNS = 96;

export function albedoOf(brdf: Brdf, theta: number, phi: number): number[] {
  const n = RINGS * TURNS,
    wi = newDirections(n),
    weights = new Float64Array(n);
  for (let i = 0; i < RINGS; i++) {
    const t = (i + 0.5) / RINGS,
      away = 180 * t * t,
      sine = Math.sin((away * Math.PI) / 180);
    const weight = sine * ((2 * t * Math.PI) / RINGS) * ((2 * Math.PI) / TURNS);
    for (let k = 0; k < TURNS; k++) {
      setDirection(wi, i * TURNS + k, around(theta, phi, away, (360 * (k + 0.5)) / TURNS));
      weights[i * TURNS + k] = weight;
    }
  }
  const { r, g, b } = brdf.eval(wi, sameDirections(n, direction(-theta, phi)));
  return [r, g, b].map(values => values.reduce((sum, value, i) => sum + (wi.z[i] > 0 ? value * weights[i] : 0), 0));
}
