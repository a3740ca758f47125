/* object.test.mjs: objects under light from all around: as bright as they must be, and with little noise.
 *
 * SPDX-License-Identifier: MIT */
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, open, screenshot, serve } from "./browser.mjs";

let site, browser;
before(async () => {
  site = await serve();
  browser = await launch();
});
after(async () => {
  await browser.close();
  site.close();
});

const SMALL = { width: 400, height: 700 };

/** The linear values, 0 to 1, of the opaque pixels at each of these numbers of samples, three for a pixel; NaN elsewhere. */
async function values(material, rest, marks, prepare = () => {}, size = SMALL) {
  const state = `view=object&m=${encodeURIComponent(material)}&${rest}`;
  const { page, complaints, close } = await open(browser, site.address, state, { size });
  await prepare(page);
  const rounds = [];
  for (const mark of marks) {
    await page.waitForFunction(n => Number(document.querySelector(".figure canvas")?.dataset.samples) >= n, mark, {
      timeout: 120000,
    });
    const bytes = await page.evaluate(() => {
      const from = document.querySelector(".figure canvas"),
        copy = new OffscreenCanvas(from.width, from.height).getContext("2d");
      copy.drawImage(from, 0, 0);
      return Array.from(copy.getImageData(0, 0, from.width, from.height).data);
    });
    if (mark === marks[0]) {
      const query = new URLSearchParams(rest);
      await screenshot(
        page,
        `object-${query.get("environment")}-${material.split(/[ :]/)[0]}-${query.get("sampling")}`,
      );
    }
    rounds.push(
      Float64Array.from({ length: (3 * bytes.length) / 4 }, (_, i) => {
        const at = 4 * Math.floor(i / 3);
        return bytes[at + 3] === 255 ? (bytes[at + (i % 3)] / 255) ** 2.2 : NaN;
      }),
    );
  }
  assert.deepEqual(complaints, []);
  await close();
  return rounds;
}

function meanOf(numbers) {
  const there = numbers.filter(Number.isFinite);
  assert.ok(there.length > 30000, `${there.length} values`);
  return there.reduce((sum, x) => sum + x, 0) / there.length;
}

/* In a furnace of 1, at half the exposure.  The directions by the material all have the weight 1, but for the byte that is
 * kept; of those by the light, which all pixels share, the mean over the ball has a spread of some 10 % at 16 samples and
 * less than 2 % at 128, since they are spread evenly. */
const WHITE = [
  ["lambert kd=1", "material", 16, 0.002],
  ["lambert kd=1", "light", 128, 0.02],
  ["lambert kd=1", "both", 128, 0.02],
  ["ggx alpha=.02 energy=multi", "material", 16, 0.002],
  ["ggx alpha=.02 energy=multi", "both", 16, 0.002],
  ["glass wall=thin", "both", 16, 0.002],
];
for (const [material, sampling, n, allowed] of WHITE)
  test(`a white ball in a white furnace is white: ${material}, by ${sampling}`, async () => {
    const [found] = await values(material, `environment=furnace&exposure=-1&sampling=${sampling}`, [n]);
    const mean = meanOf(found) / 0.5;
    assert.ok(Math.abs(mean - 1) < allowed, `${mean}`);
  });

const rms = (a, b) => Math.sqrt(meanOf(a.map((x, i) => (x - b[i]) ** 2)));

/* Against 120 samples, whose own noise is a third of that of 16 or less. */
test("a sharp material has less than half the noise by light and material than by light alone", async t => {
  const rest = "environment=spots&sampling=",
    sharp = "ggx alpha=.02 metal=Au";
  const [early, late] = await values(sharp, rest + "both", [16, 120]),
    [alone] = await values(sharp, rest + "light", [16]);
  const both = rms(early, late),
    light = rms(alone, late);
  t.diagnostic(`16 samples: ${both.toFixed(3)} by both, ${light.toFixed(3)} by light alone`);
  assert.ok(both < light / 2, `${both}, ${light}`);
});

/* A .brdf file has no sampler of its own.  Its estimate by the material alone is that by the light, which knows nothing of
 * the tables; and with both it has less noise than by the light. */
const GLOSSY = `analytic
::begin parameters
float n 1 10000 2000
::end parameters
::begin shader
vec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y)
{
    return vec3(0.05 + 0.2*(n + 2.0)/6.2831853*pow(max(dot(N, normalize(L + V)), 0.0), n));
}
::end shader
`;
test("a file without a sampler is as bright by its tables as by the light, with less noise", async t => {
  const drop = page =>
    page
      .locator("input[type=file]")
      .setInputFiles({ name: "glossy.brdf", mimeType: "text/plain", buffer: Buffer.from(GLOSSY) });
  const of = (rest, marks) => values("file:glossy.brdf", rest, marks, drop, { width: 320, height: 560 });
  const [early, late] = await of("environment=spots&sampling=both", [16, 48]),
    [alone] = await of("environment=spots&sampling=light", [16]);
  const both = rms(early, late),
    light = rms(alone, late);
  t.diagnostic(`16 samples of a glossy file: ${both.toFixed(3)} by both, ${light.toFixed(3)} by light alone`);
  assert.ok(both < light / 2, `${both}, ${light}`);
  // In a furnace, where no pixel is too bright to be shown.  The light's own directions, which all pixels share, leave
  // some 2 % at 32 samples.
  const [tables] = await of("environment=furnace&sampling=material", [16]),
    [mixed] = await of("environment=furnace&sampling=both", [32]);
  const [a, b] = [meanOf(tables), meanOf(mixed)];
  t.diagnostic(`in a furnace ${a.toFixed(4)} by the tables, ${b.toFixed(4)} by both`);
  assert.ok(Math.abs(a / b - 1) < 0.04, `${a} by the tables, ${b} by both`);
});
