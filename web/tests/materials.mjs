/* materials.mjs: random specs that the library accepts, from the table that `facet materials --json` prints; the
 * directions of a lit sphere.
 *
 * SPDX-License-Identifier: MIT */
import { execFileSync, spawnSync } from "node:child_process";

const program = process.env.FACET_PROGRAM ?? "build/dev/facet";

export function facet(...words) {
  return execFileSync(program, words, { encoding: "utf8" });
}

/** Numbers in [0,1), the same for the same seed (splitmix64). */
export function draws(seed) {
  let state = BigInt(seed);
  const mask = (1n << 64n) - 1n;
  return () => {
    state = (state + 0x9e3779b97f4a7c15n) & mask;
    let z = state;
    z = ((z ^ (z >> 30n)) * 0xbf58476d1ce4e5b9n) & mask;
    z = ((z ^ (z >> 27n)) * 0x94d049bb133111ebn) & mask;
    return Number((z ^ (z >> 31n)) >> 11n) * 2 ** -53;
  };
}

function randomValue(parameter, draw) {
  if (parameter.kind === "choice") {
    const choices = Array.isArray(parameter.choices) ? parameter.choices : parameter.choices.split("|");
    return choices[Math.floor(draw() * choices.length)];
  }
  const number = () => {
    const { low, high } = parameter,
      t = draw();
    const x = low > 0 && high / low >= 100 ? low * (high / low) ** t : low + (high - low) * t;
    return String(Math.min(Math.max(Number(x.toPrecision(4)), low), high));
  };
  return parameter.kind === "colour" && draw() < 0.5 ? [number(), number(), number()].join(",") : number();
}

/** A model and up to four of its parameters. */
export function randomSpec(models, draw) {
  for (;;) {
    const model = models[Math.floor(draw() * models.length)];
    const given = model.parameters.filter(() => draw() < 3 / model.parameters.length);
    const spec = [model.name, ...given.map(one => `${one.name}=${randomValue(one, draw)}`)].join(" ");
    if (spawnSync(program, ["eval", spec, "--wi", "0,0,1", "--wo", "0,0,1"]).status === 0) return spec;
  }
}

export function models() {
  const table = JSON.parse(facet("materials", "--json"));
  return Array.isArray(table) ? table : (table.models ?? table.materials);
}

/** The directions of the pixel whose middle is (x, y) of the unit disc: as gl/spheres.ts has them, written once more. */
export function sphereDirections(x, y, { theta, phi }) {
  const n = [x, y, Math.sqrt(1 - x * x - y * y)],
    length = Math.hypot(n[0], n[2]),
    degree = Math.PI / 180;
  const t = [n[2] / length, 0, -n[0] / length],
    b = [n[1] * t[2], n[2] * t[0] - n[0] * t[2], -n[1] * t[0]];
  const s = Math.sin(theta * degree),
    light = [s * Math.cos(phi * degree), s * Math.sin(phi * degree), Math.cos(theta * degree)];
  const dot = (a, c) => a[0] * c[0] + a[1] * c[1] + a[2] * c[2];
  return { wi: [dot(t, light), dot(b, light), dot(n, light)], wo: [t[2], b[2], n[2]] };
}
