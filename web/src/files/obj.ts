/* obj.ts: Wavefront objects (.obj) as meshes: v, vn, vt and f; all else is passed over.
 *
 * They have y up and face z, and are turned so that z is up and they face the viewer; they are moved and scaled into the
 * unit ball.  Where there are no normals, those of the faces around a point are averaged by their areas.  The tangent, the
 * material's x, runs along the first texture coordinate, and without them around the vertical axis.
 * SPDX-License-Identifier: MIT */
import type { Shape } from "../gl/shapes";

const MOST_TRIANGLES = 1e6,
  MOST_NUMBERS = 1 << 24;

/** Numbers that grow; all of them finite. */
class Numbers {
  private room = new Float32Array(3072);
  n = 0;

  push(x: number): void {
    if (this.n === this.room.length) {
      const more = new Float32Array(2 * this.room.length);
      more.set(this.room);
      this.room = more;
    }
    this.room[this.n++] = x;
  }

  get all(): Float32Array {
    return this.room.subarray(0, this.n);
  }
}

interface Parsed {
  readonly points: Float32Array;
  readonly normals: Float32Array;
  readonly coordinates: Float32Array;
  /** Of each corner of each triangle: point, coordinates, normal; -1 where there is none. */
  readonly corners: readonly number[];
}

function parse(name: string, text: string): Parsed {
  const points = new Numbers(),
    normals = new Numbers(),
    coordinates = new Numbers(),
    corners: number[] = [];
  let number = 0;
  const bad = (what: string): never => {
    throw new Error(`${name}:${number}: ${what}`);
  };
  const read = (words: readonly string[], n: number, to: Numbers): void => {
    for (let k = 1; k <= n; k++) {
      const x = words[k] === undefined ? NaN : Number(words[k]);
      if (!(Math.abs(x) < 1e30)) bad(`"${words.slice(0, 5).join(" ").slice(0, 60)}" has no ${n} numbers`);
      to.push(x);
    }
    if (to.n > MOST_NUMBERS) bad("has too many points; 5 million are read at most");
  };
  /** From 1 on, or from the last one backwards. */
  const place = (word: string | undefined, n: number): number => {
    if (!word) return -1;
    const k = Number(word),
      i = k < 0 ? n + k : k - 1;
    if (!Number.isInteger(k) || i < 0 || i >= n) bad(`"${word.slice(0, 20)}" is none of the ${n} before it`);
    return i;
  };
  const face = (words: readonly string[]): void => {
    const polygon = words.slice(1).map(word => {
      const [v, t, n] = word.split("/");
      if (!v) bad(`"${word.slice(0, 20)}" is no corner of a face`);
      return [place(v, points.n / 3), place(t, coordinates.n / 2), place(n, normals.n / 3)];
    });
    if (polygon.length < 3) bad("a face has at least three corners");
    for (let k = 2; k < polygon.length; k++)
      for (const corner of [polygon[0], polygon[k - 1], polygon[k]]) corners.push(...corner);
    if (corners.length > 9 * MOST_TRIANGLES) bad("has more triangles than are read, a million");
  };
  for (let from = 0; from < text.length;) {
    let end = text.indexOf("\n", from);
    if (end < 0) end = text.length;
    number++;
    const line = text.slice(from, end).trim();
    from = end + 1;
    if (!/^(v|vn|vt|f)\s/.test(line)) continue;
    const words = line.split(/\s+/);
    if (words[0] === "v") read(words, 3, points);
    else if (words[0] === "vn") read(words, 3, normals);
    else if (words[0] === "vt") read(words.length < 3 ? [...words, "0"] : words, 2, coordinates);
    else face(words);
  }
  if (!corners.length) throw new Error(`${name}: has no faces; a .obj file has lines "v X Y Z" and "f A B C"`);
  return { points: points.all, normals: normals.all, coordinates: coordinates.all, corners };
}

/** One vertex for each corner that differs, and the three of each triangle. */
function weld({ points, corners }: Parsed): { used: number[][]; indices: Uint32Array } {
  const last = new Int32Array(points.length / 3).fill(-1), // the last vertex at a point, and the one there before
    before: number[] = [],
    used: number[][] = [],
    indices = new Uint32Array(corners.length / 3);
  for (let i = 0; i < indices.length; i++) {
    const [p, t, n] = [corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]];
    let at = last[p];
    while (at >= 0 && !(used[at][1] === t && used[at][2] === n)) at = before[at];
    if (at < 0) {
      at = used.length;
      used.push([p, t, n]);
      before.push(last[p]);
      last[p] = at;
    }
    indices[i] = at;
  }
  return { used, indices };
}

type Three = readonly [number, number, number];
const at3 = (from: ArrayLike<number>, i: number): Three => [from[3 * i], from[3 * i + 1], from[3 * i + 2]];
const less = (a: Three, b: Three): Three => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross = (a: Three, b: Three): Three => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

/** Adds to each corner of each triangle. */
function addTo(sums: Float32Array, i: number, v: Three): void {
  for (let k = 0; k < 3; k++) sums[3 * i + k] += v[k];
}

/** To length 1, or `instead`. */
function unit(of: Float32Array, i: number, instead: Three): void {
  const [x, y, z] = at3(of, i),
    length = Math.hypot(x, y, z);
  if (length > 1e-30) of.set([x / length, y / length, z / length], 3 * i);
  else of.set(instead, 3 * i);
}

/** z up, around the origin, in the unit ball. */
function placed(name: string, points: Float32Array, used: readonly number[][]): Float32Array {
  const low = [Infinity, Infinity, Infinity],
    high = [-Infinity, -Infinity, -Infinity],
    position = new Float32Array(3 * used.length);
  used.forEach(([point], i) => {
    const [x, y, z] = at3(points, point);
    [x, -z, y].forEach((c, k) => {
      position[3 * i + k] = c;
      low[k] = Math.min(low[k], c);
      high[k] = Math.max(high[k], c);
    });
  });
  const centre = low.map((c, k) => (c + high[k]) / 2);
  let radius = 0;
  for (let i = 0; i < position.length; i++) position[i] -= centre[i % 3];
  for (let i = 0; i < used.length; i++) radius = Math.max(radius, Math.hypot(...at3(position, i)));
  if (!(radius > 0)) throw new Error(`${name}: all its points are one`);
  for (let i = 0; i < position.length; i++) position[i] /= radius;
  return position;
}

export function readObj(name: string, text: string): Shape {
  const parsed = parse(name, text),
    { used, indices } = weld(parsed),
    position = placed(name, parsed.points, used),
    smooth = new Float32Array(parsed.points.length),
    normal = new Float32Array(position.length),
    tangent = new Float32Array(position.length);
  for (let t = 0; t < indices.length; t += 3) {
    const [a, b, c] = indices.subarray(t, t + 3),
      p = at3(position, a),
      [e, f] = [less(at3(position, b), p), less(at3(position, c), p)],
      area = cross(e, f),
      [ua, ub, uc] = [a, b, c].map(i => used[i][1]);
    for (const i of [a, b, c]) addTo(smooth, used[i][0], area);
    if (Math.min(ua, ub, uc) < 0) continue;
    const [s, r] = [ub, uc].map(i => [0, 1].map(k => parsed.coordinates[2 * i + k] - parsed.coordinates[2 * ua + k])),
      turn = Math.sign(s[0] * r[1] - r[0] * s[1]);
    const along = e.map((x, k) => turn * (x * r[1] - f[k] * s[1])) as unknown as Three;
    for (const i of [a, b, c]) addTo(tangent, i, along);
  }
  used.forEach(([point, , given], i) => {
    const [x, y, z] = given < 0 ? [0, 0, 0] : at3(parsed.normals, given);
    normal.set(given < 0 ? at3(smooth, point) : [x, -z, y], 3 * i);
    unit(normal, i, [0, 0, 1]);
    const n = at3(normal, i),
      t = at3(tangent, i),
      up = t[0] * n[0] + t[1] * n[1] + t[2] * n[2];
    // Across the normal; where the coordinates give none, around the vertical axis.
    tangent.set(
      t.map((x, k) => x - up * n[k]),
      3 * i,
    );
    if (Math.hypot(...at3(tangent, i)) < 1e-6 * Math.hypot(...t) + 1e-20) tangent.set([-n[1], n[0], 0], 3 * i);
    unit(tangent, i, [1, 0, 0]);
  });
  return { position, normal, tangent, indices };
}
