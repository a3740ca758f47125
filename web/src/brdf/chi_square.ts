/* chi_square.ts: Pearson's test of a sampler that is no part of the library against its density, as `facet verify` makes
 * it: verify/sampler_density.h.
 *
 * Cells are bands of cos theta_i, cut into sectors of azimuth, by quantiles of a first run.  What they should hold is the
 * density summed over a grid around the mirror's direction, a million points or more that gather there.
 * SPDX-License-Identifier: MIT */
import type { ChiSquareAnswer } from "../workers/messages";
import { newDirections, sameDirections, setDirection, type Directions, type Sampling } from "./brdf";
import { BANDS, CELLS, cellOf, SECTORS } from "./cells";
import { versine, RINGS } from "./table_sampler";

const LEVEL = 0.01,
  LEAST_EXPECTED = 5, // of a cell; cells below it are counted as one
  FINE = 16, // rings of the grid in one of the tables', so that no ring of theirs is cut
  TURNS = 1024,
  MORE_TURNS = 8192; // where the horizon cuts the lobe into narrow cells

/** Of numbers in [0,1), the same for the same seed (splitmix32). */
function uniforms(n: number, seed: number): Directions {
  let state = seed;
  const draw = (): number => {
    state = (state + 0x9e3779b9) | 0;
    let t = state ^ (state >>> 16);
    t = Math.imul(t, 0x21f0aaad);
    t = Math.imul(t ^ (t >>> 15), 0x735a2d97);
    return ((t ^ (t >>> 15)) >>> 8) * 2 ** -24;
  };
  const to = newDirections(n);
  for (let i = 0; i < n; i++) setDirection(to, i, [draw(), draw(), draw()]);
  return to;
}

/** ln of the gamma function of half a whole number. */
function logGammaOfHalf(twice: number): number {
  let sum = twice % 2 ? Math.log(Math.PI) / 2 : 0;
  for (let x = twice - 2; x > 0; x -= 2) sum += Math.log(x / 2);
  return sum;
}

/** The probability that chi-square of so many degrees is above x: the regularised incomplete gamma function. */
export function chiSquareTail(x: number, degrees: number): number {
  const a = degrees / 2,
    z = x / 2;
  if (!(z > 0)) return 1;
  const front = Math.exp(a * Math.log(z) - z - logGammaOfHalf(degrees));
  if (z < a + 1) {
    let term = 1 / a,
      sum = term;
    for (let n = 1; term > 1e-16 * sum; n++) sum += term *= z / (a + n);
    return Math.max(0, 1 - front * sum);
  }
  // The continued fraction, by Lentz's method.
  let b = z + 1 - a,
    c = 1e300,
    d = 1 / b,
    h = d;
  for (let n = 1; n < 10000; n++) {
    const an = -n * (n - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    h *= c * d;
    if (Math.abs(c * d - 1) < 1e-15) break;
  }
  return front * h;
}

type Cells = Pick<ChiSquareAnswer, "mean" | "nBands" | "cosines" | "azimuths">;

const turned = (x: number, y: number, [mx, my]: readonly [number, number]): number =>
  Math.atan2(y * mx - x * my, x * mx + y * my);

/** Borders between equal shares of the samples. */
function makeCells(wi: Directions, pdf: Float32Array): Cells {
  const there = [...pdf.keys()].filter(i => pdf[i] > 0),
    sum = (of: Float32Array): number => there.reduce((all, i) => all + of[i], 0);
  const [x, y] = [sum(wi.x), sum(wi.y)],
    mean: [number, number] = x || y ? [x, y] : [1, 0];
  there.sort((a, b) => wi.z[a] - wi.z[b]);
  const cosines = new Float64Array(BANDS + 1).fill(1),
    azimuths = new Float64Array(BANDS * (SECTORS + 1));
  cosines[0] = 0;
  for (let band = 0; band < BANDS; band++) {
    const from = Math.floor((band * there.length) / BANDS),
      inside = there.slice(from, Math.floor(((band + 1) * there.length) / BANDS));
    if (band) cosines[band] = wi.z[there[from]];
    const angles = inside.map(i => turned(wi.x[i], wi.y[i], mean)).sort((a, b) => a - b),
      row = azimuths.subarray(band * (SECTORS + 1), (band + 1) * (SECTORS + 1));
    for (let k = 1; k < SECTORS; k++) row[k] = angles[Math.floor((k * angles.length) / SECTORS)];
    row[0] = -Math.PI;
    row[SECTORS] = Math.PI;
  }
  return { mean, nBands: BANDS, cosines, azimuths };
}

/** The density over the cells, and in all. */
function integrate(sampling: Sampling, wo: readonly number[], cells: Cells, to: Float64Array): number {
  const s = Math.hypot(wo[0], wo[1]),
    [c, d] = s > 1e-6 ? [-wo[0] / s, -wo[1] / s] : [1, 0],
    turns = wo[2] < 0.2 ? MORE_TURNS : TURNS,
    viewers = sameDirections(turns, wo),
    wi = newDirections(turns);
  let mass = 0;
  for (let ring = 0; ring < RINGS * FINE; ring++) {
    const [low, high] = [versine(ring / FINE), versine((ring + 1) / FINE)],
      v = (low + high) / 2,
      sine = Math.sqrt(v * (2 - v)),
      area = ((2 * Math.PI) / turns) * (high - low);
    for (let k = 0; k < turns; k++) {
      const turn = (2 * Math.PI * (k + 0.5)) / turns,
        along = sine * Math.cos(turn),
        side = sine * Math.sin(turn),
        flat = along * wo[2] + (1 - v) * s;
      setDirection(wi, k, [flat * c - side * d, flat * d + side * c, (1 - v) * wo[2] - along * s]);
    }
    const pdf = sampling.pdf(wi, viewers);
    for (let k = 0; k < turns; k++) {
      if (!(wi.z[k] > 0)) continue;
      to[cellOf(cells, wi.z[k], turned(wi.x[k], wi.y[k], cells.mean))] += pdf[k] * area;
      mass += pdf[k] * area;
    }
  }
  return mass;
}

export function chiSquareOf(sampling: Sampling, wo: readonly number[], n: number, seed: number): ChiSquareAnswer {
  const viewers = sameDirections(n, wo),
    pilot = sampling.sample(viewers, uniforms(n, 2 * seed)),
    cells = makeCells(pilot.wi, pilot.pdf),
    expected = new Float64Array(CELLS),
    observed = new Float64Array(CELLS);
  const mass = integrate(sampling, wo, cells, expected),
    { wi, pdf } = sampling.sample(viewers, uniforms(n, 2 * seed + 1));
  expected[CELLS - 1] = Math.max(0, 1 - mass);
  expected.forEach((share, i) => (expected[i] = n * share));
  let nLost = 0;
  for (let i = 0; i < n; i++)
    if (pdf[i] > 0) observed[cellOf(cells, wi.z[i], turned(wi.x[i], wi.y[i], cells.mean))]++;
    else nLost++;
  observed[CELLS - 1] = nLost;
  let statistic = 0,
    degrees = -1,
    poolExpected = 0,
    poolObserved = 0;
  const add = (o: number, e: number): void => {
    statistic += (o - e) ** 2 / e;
    degrees++;
  };
  for (let i = 0; i < CELLS; i++)
    if (expected[i] >= LEAST_EXPECTED) add(observed[i], expected[i]);
    else {
      poolExpected += expected[i];
      poolObserved += observed[i];
    }
  if (poolExpected >= LEAST_EXPECTED) add(poolObserved, poolExpected);
  // What should be nowhere, and is there.
  else if (poolObserved > poolExpected + 5 * Math.sqrt(poolExpected) + 5) statistic = Infinity;
  const p = statistic < Infinity ? chiSquareTail(statistic, degrees) : 0;
  return { p, statistic, degrees, mass, lost: nLost / n, level: LEVEL, n, ...cells, expected, observed };
}
