/* sampler.test.mjs: the sampler of what has nothing but values: its density is that of its samples, its estimates are
 * those of the cosine's, and have less noise.
 *
 * SPDX-License-Identifier: MIT */
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { modules } from "./modules.mjs";
import { draws } from "./materials.mjs";

let page, tables, chi, brdfs, angles, library, fits, quadrature;
before(async () => {
  page = await modules();
  [tables, chi, brdfs, angles, library, fits, quadrature] = await Promise.all(
    [
      "brdf/table_sampler",
      "brdf/chi_square",
      "brdf/brdf",
      "brdf/angles",
      "facet/library",
      "brdf/fits",
      "brdf/quadrature",
    ].map(page.load),
  );
});
after(() => page.close());

/** A model of the library as what has nothing but values. */
function valuesOf(spec) {
  const wasm = readFileSync(join(process.env.FACET_PAGE ?? "build/web", "facet.wasm"));
  const facet = library.instantiate(new WebAssembly.Module(wasm)),
    brdf = facet.prepare(spec);
  return { kind: "file", label: spec, text: spec, eval: (wi, wo) => brdf.eval(wi, wo), whole: brdf };
}

const SUBJECTS = {
  "fit:chrome": [0, 45, 89.9],
  "fit:gold-metallic-paint3": [0.5, 60],
  "fit:pink-felt": [45, 75],
  "ward alpha_x=.05 alpha_y=.4 ks=.8 kd=.1": [0, 20, 70],
  "ggx alpha=.002 ks=1": [45],
  "lambert kd=.5": [60],
};
const made = new Map();
async function subject(name) {
  if (!made.has(name)) {
    const brdf = name.startsWith("fit:") ? await fits.loadFit(name.slice(4)) : valuesOf(name);
    made.set(name, { brdf, sampler: new tables.TableSampler(tables.makeTables(brdf)) });
  }
  return made.get(name);
}
const N_TESTS = Object.values(SUBJECTS).flat().length,
  LEVEL = 1 - 0.99 ** (1 / N_TESTS); // of each test, 0.01 for all of them together (Sidak)

for (const [name, thetas] of Object.entries(SUBJECTS))
  test(`samples of ${name} have their density, which sums to 1`, async () => {
    const { sampler } = await subject(name);
    for (const theta of thetas) {
      const n = 20000,
        { p, mass, lost, degrees } = chi.chiSquareOf(sampler, angles.direction(-theta, 200), n, 1);
      assert.ok(p > LEVEL, `${theta} degrees: p = ${p}, level ${LEVEL}`);
      assert.ok(degrees > 300, `${degrees} degrees of freedom`);
      // Five standard deviations of the share that is lost, and what the grid of a million points leaves.
      const allowed = 5 * Math.sqrt(Math.max(lost, 1 / n) / n) + 5e-4;
      assert.ok(Math.abs(mass + lost - 1) < allowed, `${theta} degrees: ${mass} + ${lost}`);
    }
  });

test("a density that is not that of the samples fails", async () => {
  const { sampler } = await subject("fit:gold-metallic-paint3"),
    wo = angles.direction(-45, 200);
  const tenth = { ...sampler, isDelta: false, sample: (o, u) => sampler.sample(o, u) };
  const off = new Map([
    ["of another angle", (wi, o) => sampler.pdf(wi, brdfs.sameDirections(o.x.length, angles.direction(-47, 200)))],
    ["without the cosine", (wi, o) => sampler.pdf(wi, o).map((x, i) => x - (0.125 * Math.max(wi.z[i], 0)) / Math.PI)],
    ["a tenth more", (wi, o) => sampler.pdf(wi, o).map(x => 1.1 * x)],
  ]);
  for (const [what, pdf] of off) {
    const { p } = chi.chiSquareOf({ ...tenth, pdf }, wo, 20000, 1);
    assert.ok(p < 1e-4, `${what}: p = ${p}`);
  }
});

test("the tail of chi-square is that of the printed tables", () => {
  // Abramowitz and Stegun, Handbook of Mathematical Functions, table 26.8.
  for (const [x, degrees, p] of [
    [3.84146, 1, 0.05],
    [18.307, 10, 0.05],
    [2.15585, 10, 0.995],
    [140.169, 100, 0.005],
  ])
    assert.ok(Math.abs(chi.chiSquareTail(x, degrees) / p - 1) < 1e-4, `${x}, ${degrees}`);
});

/** The mean of f cos over the density, of all three channels together, and its spread; and that of the same by the
 *  cosine, whose own samples of a narrow lobe are too few to show it. */
function estimate(brdf, sampler, wo, n, draw) {
  const viewers = brdfs.sameDirections(n, wo),
    u = brdfs.newDirections(n);
  for (let i = 0; i < n; i++) brdfs.setDirection(u, i, [draw(), draw(), draw()]);
  const { wi, pdf } = sampler.sample(viewers, u),
    { r, g, b } = brdf.eval(wi, viewers),
    values = Array.from(r, (x, i) => (x + g[i] + b[i]) / 3);
  const meanOf = of => values.reduce((a, x, i) => a + (pdf[i] > 0 ? of(x, i) : 0), 0) / n,
    mean = meanOf((x, i) => x / pdf[i]),
    spread = square => Math.sqrt(Math.max(0, square - mean ** 2));
  return {
    mean,
    own: spread(meanOf((x, i) => (x / pdf[i]) ** 2)),
    cosine: spread(meanOf((x, i) => (x ** 2 * Math.PI) / wi.z[i] / pdf[i])),
  };
}

/** The same mean by the cosine's sampler, which needs no table. */
function byCosine(brdf, wo, n, draw) {
  const wi = brdfs.newDirections(n);
  for (let i = 0; i < n; i++) {
    const z2 = draw(),
      phi = 2 * Math.PI * draw();
    brdfs.setDirection(wi, i, [Math.sqrt(1 - z2) * Math.cos(phi), Math.sqrt(1 - z2) * Math.sin(phi), Math.sqrt(z2)]);
  }
  const { r, g, b } = brdf.eval(wi, brdfs.sameDirections(n, wo));
  return r.reduce((sum, x, i) => sum + (((x + g[i] + b[i]) / 3) * Math.PI) / wi.z[i], 0) / n;
}

for (const [name, thetas] of Object.entries(SUBJECTS))
  test(`in a furnace ${name} is as bright as by the cosine, with less noise`, async t => {
    const { brdf, sampler } = await subject(name),
      draw = draws(11),
      n = 20000;
    for (const theta of thetas.filter(angle => angle < 89)) {
      const wo = angles.direction(-theta, 200),
        { mean, own, cosine } = estimate(brdf, sampler, wo, n, draw),
        other = byCosine(brdf, wo, n, draw);
      assert.ok(Math.abs(mean - other) < 5 * Math.hypot(own, cosine) * n ** -0.5, `${theta}: ${mean}, ${other}`);
      // Against a third way, which draws nothing: the library's, or a rule of 9216 points that is good to 0.5 %.
      const rgb = brdf.whole?.albedo(wo).reflected ?? quadrature.albedoOf(brdf, theta, 200),
        exact = (rgb[0] + rgb[1] + rgb[2]) / 3;
      assert.ok(
        Math.abs(mean - exact) < 5 * own * n ** -0.5 + (brdf.whole ? 1e-4 : 0.005) * exact,
        `${theta}: ${mean}, ${exact} by quadrature`,
      );
      const noise = [own, cosine].map(spread => spread / mean);
      t.diagnostic(`${name} at ${theta} degrees: noise ${noise.map(x => x.toFixed(2)).join(", by the cosine ")}`);
      // What the cosine draws perfectly is a little noisier by cells; all else is at least as good.
      assert.ok(noise[0] < Math.max(noise[1], 0.15), `${theta}: ${noise}`);
      assert.ok(noise[0] < 0.7, `${theta}: ${noise}`);
    }
  });

test("a black material has directions with a density, too", async () => {
  const black = (wi, z) => ({ r: new Float32Array(z), g: new Float32Array(z), b: new Float32Array(z) }),
    brdf = { kind: "file", label: "black", text: "black", eval: wi => black(wi, wi.x.length) },
    sampler = new tables.TableSampler(tables.makeTables(brdf));
  const { p, mass, lost } = chi.chiSquareOf(sampler, angles.direction(-30, 0), 20000, 1);
  assert.ok(p > 0.001 && mass > 0.5 && Math.abs(mass + lost - 1) < 0.02, `${p} ${mass} ${lost}`);
});
