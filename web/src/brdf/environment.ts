/* environment.ts: light from all around, made here: y is up.  The object's shader and the path tracer see the same map.
 *
 * SPDX-License-Identifier: MIT */
import type { ENVIRONMENTS } from "../state/state";
import { dot, normalised, type Vector } from "./angles";

export type EnvironmentName = (typeof ENVIRONMENTS)[number];

/** Rows from the top to the bottom, columns by the azimuth from -z over x to z and back; linear RGB. */
export interface Environment {
  readonly width: number;
  readonly height: number;
  readonly pixels: Float32Array;
}

const WIDTH = 256,
  HEIGHT = 128;

const smooth = (low: number, high: number, x: number): number => {
  const t = Math.min(Math.max((x - low) / (high - low), 0), 1);
  return t * t * (3 - 2 * t);
};

/** A soft box: a rectangle around a direction, `half` as wide and high in radians, with soft edges. */
function softBox(v: Vector, towards: Vector, halfWidth: number, halfHeight: number): number {
  const c = normalised(towards),
    right = normalised([c[2], 0, -c[0]]),
    up: Vector = [
      c[1] * right[2] - c[2] * right[1],
      c[2] * right[0] - c[0] * right[2],
      c[0] * right[1] - c[1] * right[0],
    ];
  const depth = dot(v, c);
  if (depth <= 0) return 0;
  const x = Math.abs(dot(v, right) / depth) / Math.tan(halfWidth),
    y = Math.abs(dot(v, up) / depth) / Math.tan(halfHeight);
  return (1 - smooth(0.85, 1.05, x)) * (1 - smooth(0.85, 1.05, y));
}

const grey = (x: number): Vector => [x, x, x];
const plus = (a: Vector, scale: number, b: Vector): Vector => [
  a[0] + scale * b[0],
  a[1] + scale * b[1],
  a[2] + scale * b[2],
];

const RADIANCES: Record<EnvironmentName, (v: Vector) => Vector> = {
  studio: v => {
    let light = grey(0.1 + 0.16 * smooth(-0.2, 1, v[1]));
    light = plus(light, softBox(v, [-0.9, 0.75, 0.7], 0.42, 0.5), [4.2, 4.05, 3.75]);
    light = plus(light, softBox(v, [1, 0.25, 0.15], 0.16, 0.75), [2.6, 2.9, 3.4]);
    return plus(light, softBox(v, [0.1, 1, -0.75], 0.8, 0.16), [2, 2, 2]);
  },
  sky: v => {
    const up = smooth(-0.05, 0.9, v[1]),
      isGround = smooth(0.02, -0.04, v[1]);
    let light: Vector = [0.95 - 0.68 * up, 1.02 - 0.5 * up, 1.12 - 0.1 * up];
    const sun = dot(v, normalised([-0.55, 0.62, 0.56]));
    light = plus(light, smooth(0.985, 0.992, sun), [60, 52, 40]);
    light = plus(light, 0.8 * smooth(0.6, 1, sun), [0.7, 0.5, 0.3]);
    return light.map((x, k) => x * (1 - isGround) + isGround * [0.2, 0.18, 0.15][k]) as Vector;
  },
  furnace: () => grey(1),
  spots: v => {
    let light = grey(0.015);
    for (let k = 0; k < 6; k++) {
      const a = (k * Math.PI) / 3 + 0.3,
        height = k % 2 ? 0.35 : 0.9;
      const to = normalised([Math.cos(a), height, Math.sin(a)]);
      light = plus(light, smooth(0.975, 0.985, dot(v, to)), k % 2 ? [24, 15, 8] : [10, 15, 24]);
    }
    return light;
  },
};

/** The direction of the middle of a pixel. */
export function pixelDirection(column: number, row: number, width: number, height: number): Vector {
  const theta = ((row + 0.5) / height) * Math.PI,
    phi = ((column + 0.5) / width) * 2 * Math.PI,
    sine = Math.sin(theta);
  return [sine * Math.sin(phi), Math.cos(theta), -sine * Math.cos(phi)];
}

const made = new Map<EnvironmentName, Environment>();

export function environmentMap(name: EnvironmentName): Environment {
  let map = made.get(name);
  if (!map) {
    const pixels = new Float32Array(4 * WIDTH * HEIGHT);
    for (let row = 0, at = 0; row < HEIGHT; row++)
      for (let column = 0; column < WIDTH; column++, at += 4)
        pixels.set([...RADIANCES[name](pixelDirection(column, row, WIDTH, HEIGHT)), 1], at);
    made.set(name, (map = { width: WIDTH, height: HEIGHT, pixels }));
  }
  return map;
}

/** The radiance from a direction, of the nearest pixel, into `to`. */
export function lookUp(map: Environment, x: number, y: number, z: number, to: Float64Array): void {
  const { width, height, pixels } = map;
  const u = Math.atan2(x, -z) / (2 * Math.PI),
    v = Math.acos(Math.min(1, Math.max(-1, y))) / Math.PI;
  const column = Math.min(width - 1, Math.floor((u - Math.floor(u)) * width)),
    at = 4 * (Math.min(height - 1, Math.floor(v * height)) * width + column);
  to[0] = pixels[at];
  to[1] = pixels[at + 1];
  to[2] = pixels[at + 2];
}
