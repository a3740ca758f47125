/* tracer.ts: a small path tracer: a ball of the material on a matt floor, under an environment; y is up.
 *
 * Directions are drawn by the library, whole pictures at a time.  Light is found where a path leaves the scene, so that
 * what is seen is the sampler at work.  At most MOST_BOUNCES bounces, which glass and mirrors hardly reach.
 * SPDX-License-Identifier: MIT */
import type { Directions } from "../brdf/brdf";
import { lookUp, type Environment } from "../brdf/environment";
import type { FacetBrdf } from "../facet/facet_brdf";

const MOST_BOUNCES = 12,
  FLOOR_RADIUS = 7,
  FAR = 1e-3; // where the next ray begins: away from the surface that it leaves

/** xorshift128 of Marsaglia, started by splitmix32. */
function generator(seed: number): () => number {
  const state = new Uint32Array(4);
  for (let k = 0, z = seed; k < 4; k++) {
    z = (z + 0x9e3779b9) | 0;
    let t = Math.imul(z ^ (z >>> 16), 0x21f0aaad);
    t = Math.imul(t ^ (t >>> 15), 0x735a2d97);
    state[k] = t ^ (t >>> 15);
  }
  return () => {
    let t = state[3];
    const s = state[0];
    state[3] = state[2];
    state[2] = state[1];
    state[1] = s;
    t ^= t << 11;
    t ^= t >>> 8;
    state[0] = t ^ s ^ (s >>> 19);
    return (state[0] >>> 8) * 2 ** -24;
  };
}

/** The eye at (0, 1.5, 5.6) looks at the ball, of radius 1 around (0, 1, 0). */
const EYE = [0, 1.75, 5.6],
  TOWARDS = [0, -0.135, -1],
  VIEW = 0.29; // the tangent of half the height

/** One scene and the paths through it, one a pixel. */
export class Tracer {
  private readonly n: number;
  /** Origins, directions and throughputs, component by component. */
  private readonly o: Float32Array[];
  private readonly d: Float32Array[];
  private readonly w: Float32Array[];
  private readonly alive: Int32Array;
  private readonly random: () => number;
  private readonly sky = new Float64Array(3);

  constructor(
    private readonly brdf: FacetBrdf,
    private readonly environment: Environment,
    readonly width: number,
    readonly height: number,
    seed: number,
  ) {
    this.n = width * height;
    const three = (): Float32Array[] => [0, 1, 2].map(() => new Float32Array(this.n));
    [this.o, this.d, this.w] = [three(), three(), three()];
    this.alive = new Int32Array(this.n);
    this.random = generator(seed);
  }

  /** Adds one path for each pixel to `sums`: red, green, blue. */
  addPass(sums: Float32Array): void {
    this.start();
    let n = this.n;
    for (let bounce = 0; n && bounce < MOST_BOUNCES; bounce++) n = this.bounce(n, sums);
  }

  private start(): void {
    const { width, height, o, d, w, alive, random } = this,
      [fx, fy, fz] = TOWARDS,
      length = Math.hypot(fx, fy, fz),
      f = [fx / length, fy / length, fz / length];
    const up = [0, -f[2], f[1]]; // to the right is x
    for (let i = 0; i < this.n; i++) {
      const x = (2 * ((i % width) + random()) - width) / height,
        y = 1 - (2 * (Math.floor(i / width) + random())) / height;
      const v = [VIEW * x, f[1] + VIEW * y * up[1], f[2] + VIEW * y * up[2]],
        scale = 1 / Math.hypot(v[0], v[1], v[2]);
      for (let k = 0; k < 3; k++) {
        o[k][i] = EYE[k];
        d[k][i] = v[k] * scale;
        w[k][i] = 1;
      }
      alive[i] = i;
    }
  }

  /** The distance to the ball, and to the floor; Infinity if it is missed. */
  private hitBall(i: number): number {
    const { o, d } = this,
      y = o[1][i] - 1;
    const b = o[0][i] * d[0][i] + y * d[1][i] + o[2][i] * d[2][i],
      c = o[0][i] ** 2 + y * y + o[2][i] ** 2 - 1,
      root = b * b - c;
    if (root <= 0) return Infinity;
    const t = Math.sqrt(root);
    return -b - t > FAR ? -b - t : -b + t > FAR ? -b + t : Infinity;
  }

  private hitFloor(i: number): number {
    const { o, d } = this,
      t = -o[1][i] / d[1][i];
    return t > FAR && Math.hypot(o[0][i] + t * d[0][i], o[2][i] + t * d[2][i]) < FLOOR_RADIUS ? t : Infinity;
  }

  /** Moves the paths `alive` on by one segment; how many remain. */
  private bounce(n: number, sums: Float32Array): number {
    const { o, d, w, alive, sky } = this,
      onBall: number[] = [];
    let nNext = 0;
    for (let k = 0; k < n; k++) {
      const i = alive[k],
        ball = this.hitBall(i),
        floor = this.hitFloor(i),
        t = Math.min(ball, floor);
      if (t === Infinity) {
        lookUp(this.environment, d[0][i], d[1][i], d[2][i], sky);
        for (let c = 0; c < 3; c++) sums[3 * i + c] += w[c][i] * sky[c];
        continue;
      }
      for (let c = 0; c < 3; c++) o[c][i] += t * d[c][i];
      if (ball < floor) onBall.push(i);
      else {
        this.scatterOnFloor(i);
        alive[nNext++] = i;
      }
    }
    return this.scatterOnBall(onBall, nNext);
  }

  /** A matt floor, with squares of two greys that fade into one with the distance. */
  private scatterOnFloor(i: number): void {
    const { o, d, w, random } = this,
      x = o[0][i],
      z = o[2][i];
    const isDark = (Math.floor(x / 0.7 + 0.5) + Math.floor(z / 0.7 + 0.5)) & 1,
      fade = Math.min(1, Math.hypot(x, z) / FLOOR_RADIUS);
    const albedo = 0.42 + (isDark ? -0.16 : 0.16) * (1 - fade * fade);
    const r = Math.sqrt(random()),
      phi = 2 * Math.PI * random();
    d[0][i] = r * Math.cos(phi);
    d[1][i] = Math.sqrt(Math.max(1 - r * r, 1e-6));
    d[2][i] = r * Math.sin(phi);
    o[1][i] = 0;
    for (let c = 0; c < 3; c++) w[c][i] *= albedo;
  }

  /** Draws directions for all points on the ball in one batch; tangents run around the vertical axis. */
  private scatterOnBall(at: readonly number[], nNext: number): number {
    const n = at.length,
      { o, d, w, alive, random } = this;
    if (!n) return nNext;
    const make = (): Directions => ({ x: new Float32Array(n), y: new Float32Array(n), z: new Float32Array(n) });
    const wo = make(),
      u = make(),
      frames = new Float32Array(9 * n);
    for (let k = 0; k < n; k++) {
      const i = at[k],
        nx = o[0][i],
        ny = o[1][i] - 1,
        nz = o[2][i],
        inverse = 1 / Math.max(Math.hypot(nx, nz), 1e-6);
      const tx = nz * inverse,
        tz = -nx * inverse;
      const bx = ny * tz,
        by = nz * tx - nx * tz,
        bz = -ny * tx;
      frames.set([tx, 0, tz, bx, by, bz, nx, ny, nz], 9 * k);
      const vx = -d[0][i],
        vy = -d[1][i],
        vz = -d[2][i];
      const x = vx * tx + vz * tz,
        y = vx * bx + vy * by + vz * bz,
        z = vx * nx + vy * ny + vz * nz,
        scale = 1 / Math.hypot(x, y, z);
      wo.x[k] = x * scale;
      wo.y[k] = y * scale;
      wo.z[k] = z * scale;
      u.x[k] = random();
      u.y[k] = random();
      u.z[k] = random();
    }
    const { wi, pdf, weight } = this.brdf.sample(wo, u);
    for (let k = 0; k < n; k++) {
      if (!(pdf[k] > 0)) continue;
      const i = at[k];
      for (let c = 0; c < 3; c++)
        d[c][i] = wi.x[k] * frames[9 * k + c] + wi.y[k] * frames[9 * k + 3 + c] + wi.z[k] * frames[9 * k + 6 + c];
      w[0][i] *= weight.r[k];
      w[1][i] *= weight.g[k];
      w[2][i] *= weight.b[k];
      alive[nNext++] = i;
    }
    return nNext;
  }
}
