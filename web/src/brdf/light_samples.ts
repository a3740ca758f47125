/* light_samples.ts: directions to an environment, drawn by its brightness, and numbers to draw others by a material; z
 * is up, as materials have it.
 *
 * One in eight is drawn evenly, so that no direction is too rare.  Roberts' additive recurrence in two dimensions spreads
 * them, so that any number of them in a row covers all the light there is.
 * SPDX-License-Identifier: MIT */
import type { Environment } from "./environment";

export interface Lights {
  readonly directions: Float32Array;
  /** Radiance over the density, red, green, blue. */
  readonly powers: Float32Array;
  /** 1/sr */
  readonly densities: Float32Array;
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
  const lights = {
    directions: new Float32Array(3 * n),
    powers: new Float32Array(3 * n),
    densities: new Float32Array(n),
  };
  for (let k = 0; k < n; k++) {
    const u = ((first + k + 0.5) * 0.7548776662466927) % 1,
      v = ((first + k + 0.5) * 0.5698402909980532) % 1;
    const pixel = find(sums, u * sums[sums.length - 1]),
      before = pixel ? sums[pixel - 1] : 0;
    const inside = (u * sums[sums.length - 1] - before) / (sums[pixel] - before);
    // Even over the pixel's solid angle, as its density says: in the cosine.
    const row = Math.floor(pixel / width),
      [top, bottom] = [row, row + 1].map(edge => Math.cos((edge * Math.PI) / height)),
      up = top + inside * (bottom - top),
      side = Math.sqrt(Math.max(0, 1 - up * up)),
      phi = (((pixel % width) + v) / width) * 2 * Math.PI;
    lights.directions.set([side * Math.sin(phi), side * Math.cos(phi), up], 3 * k);
    lights.densities[k] = density[pixel];
    for (let c = 0; c < 3; c++) lights.powers[3 * k + c] = pixels[4 * pixel + c] / density[pixel];
  }
  return lights;
}

/** Three numbers in [0, 1) for each of samples `first` to `first + n - 1`, of the like sequence in three dimensions. */
export function materialNumbers(first: number, n: number): Float32Array {
  const steps = [0.8191725133961645, 0.6710436067037893, 0.5497004779019703];
  return Float32Array.from({ length: 3 * n }, (_, i) => ((first + Math.floor(i / 3) + 0.5) * steps[i % 3]) % 1);
}

/** Red, green, blue, and the density with which lightSamples draws a direction of the pixel, 1/sr. */
export function densityMap(environment: Environment): Float32Array {
  const { density } = tableOf(environment),
    texels = environment.pixels.slice();
  for (let i = 0; i < density.length; i++) texels[4 * i + 3] = density[i];
  return texels;
}
