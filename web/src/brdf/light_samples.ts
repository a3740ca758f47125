/* light_samples.ts: directions to an environment, drawn by its brightness; z is up, as materials have it.
 *
 * One in eight is drawn evenly, so that no direction is too rare.  Roberts' additive recurrence in two dimensions spreads
 * them, so that any number of them in a row covers all the light there is.
 * SPDX-License-Identifier: MIT */
import { pixelDirection, type Environment } from "./environment";

export interface Lights {
  readonly directions: Float32Array;
  /** Radiance over the density, red, green, blue. */
  readonly powers: Float32Array;
}

const EVEN = 0.125;

interface Table {
  /** Of the pixels in order, up to and with each. */
  readonly sums: Float64Array;
  readonly density: Float64Array;
}

const tables = new WeakMap<Environment, Table>();

function tableOf(environment: Environment): Table {
  let table = tables.get(environment);
  if (table) return table;
  const { width, height, pixels } = environment,
    n = width * height,
    weights = new Float64Array(n),
    area = (row: number): number =>
      ((2 * Math.PI) / width) * (Math.cos((row * Math.PI) / height) - Math.cos(((row + 1) * Math.PI) / height));
  let total = 0;
  for (let i = 0; i < n; i++) {
    const luminance = 0.2126 * pixels[4 * i] + 0.7152 * pixels[4 * i + 1] + 0.0722 * pixels[4 * i + 2];
    total += weights[i] = luminance * area(Math.floor(i / width));
  }
  const sums = new Float64Array(n),
    density = new Float64Array(n);
  let sum = 0;
  for (let i = 0; i < n; i++) {
    const solidAngle = area(Math.floor(i / width)),
      share = EVEN * (solidAngle / (4 * Math.PI)) + (1 - EVEN) * (weights[i] / total);
    density[i] = share / solidAngle;
    sums[i] = sum += share;
  }
  tables.set(environment, (table = { sums, density }));
  return table;
}

/** The first entry that is above x. */
function find(sums: Float64Array, x: number): number {
  let low = 0,
    high = sums.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (sums[middle] > x) high = middle;
    else low = middle + 1;
  }
  return low;
}

/** Numbers `first` to `first + n - 1` of the sequence. */
export function lightSamples(environment: Environment, first: number, n: number): Lights {
  const { sums, density } = tableOf(environment),
    { width, height, pixels } = environment;
  const lights = { directions: new Float32Array(3 * n), powers: new Float32Array(3 * n) };
  for (let k = 0; k < n; k++) {
    const u = ((first + k + 0.5) * 0.7548776662466927) % 1,
      v = ((first + k + 0.5) * 0.5698402909980532) % 1;
    const pixel = find(sums, u * sums[sums.length - 1]),
      before = pixel ? sums[pixel - 1] : 0;
    const inside = (u * sums[sums.length - 1] - before) / (sums[pixel] - before);
    const column = (pixel % width) + v - 0.5,
      row = Math.floor(pixel / width) + inside - 0.5;
    const [x, y, z] = pixelDirection(column, row, width, height);
    lights.directions.set([x, -z, y], 3 * k);
    for (let c = 0; c < 3; c++) lights.powers[3 * k + c] = pixels[4 * pixel + c] / density[pixel];
  }
  return lights;
}
