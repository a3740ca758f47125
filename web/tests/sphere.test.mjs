/* sphere.test.mjs: the lit sphere, which the generated GLSL shades, is the C library's pixel for pixel; and every
 * generated file is valid for WebGL.
 *
 * SPDX-License-Identifier: MIT */
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, open, serve } from "./browser.mjs";
import { models, sphereDirections } from "./materials.mjs";

const program = process.env.FACET_PROGRAM ?? "build/dev/facet",
  folder = process.env.FACET_PAGE ?? "build/web";

let site, browser;
before(async () => {
  site = await serve();
  browser = await launch();
});
after(async () => {
  await browser.close();
  site.close();
});

const SPECS = [
  "gtr alpha=.2 gamma=.7 ks=.9,.7,.3",
  "gtr alpha=.3 gamma=6 masking=published",
  "ggx alpha_x=.1 alpha_y=.4 metal=Cu",
  "ggx alpha=.6 energy=multi ks=.9,.5,.2",
  "beckmann alpha=.3 ior=1.7 kd=.2,.3,.5",
  "phong exponent=30",
  "ward alpha_x=.1 alpha_y=.3",
  "disney base_color=.8,.2,.1 roughness=.4 sheen=1 clearcoat=1",
  "metallic_roughness base_color=.9,.6,.3 metallic=.5 roughness=.5",
  "glass alpha=.3",
  "lambert kd=.2,.5,.8",
];
const LIGHT = { theta: 40, phi: 45 };

/** What `facet eval` gives for all of them: f cos theta_i. */
function evaluate(spec, pairs) {
  const rows = pairs.map(({ wi, wo }) => [...wi, ...wo].join(",")).join("\n");
  const input = `wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n${rows}\n`;
  const text = execFileSync(program, ["eval", spec, "--csv", "-"], { input, encoding: "utf8", maxBuffer: 2 ** 28 });
  return text
    .trim()
    .split("\n")
    .slice(1)
    .map(line => line.split(",").slice(9, 12).map(Number));
}

test("a sphere lit by the generated GLSL is the C library's within 1/255 at every pixel", async t => {
  const { page, complaints, close } = await open(browser, site.address, "view=sphere&m=lambert", {
    size: { width: 860, height: 620 },
  });
  let nPixels = 0,
    nExact = 0;
  for (const spec of SPECS) {
    await page.evaluate(hash => (location.hash = hash), `view=sphere&m=${encodeURIComponent(spec)}`);
    await page.waitForFunction(text => document.querySelector(".spec").value === text, spec);
    await page.locator("canvas[data-is-done=true]").waitFor({ timeout: 120000 });
    await page.evaluate(() => new Promise(resolve => requestAnimationFrame(() => requestAnimationFrame(resolve))));
    const { box, width, height, pixels } = await page.evaluate(() => {
      const canvas = document.querySelector(".figure canvas"),
        copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
      copy.drawImage(canvas, 0, 0);
      const box = JSON.parse(document.querySelector(".tile-name").dataset.box);
      const data = copy.getImageData(0, 0, canvas.width, canvas.height).data;
      return { box, width: canvas.width, height: canvas.height, pixels: [...data] };
    });
    assert.equal(pixels.length, 4 * width * height);
    const pairs = [],
      places = [],
      radius = 0.47 * box.side;
    for (let row = 0; row < height; row++)
      for (let column = 0; column < width; column++) {
        const x = (column + 0.5 - box.left - box.side / 2) / radius,
          y = (box.top + box.side / 2 - row - 0.5) / radius;
        if (x * x + y * y >= 0.98) continue; // the edge is mixed with the page
        const pair = sphereDirections(x, y, LIGHT);
        // Where the light grazes, rounding decides whether it is there.
        if (Math.abs(pair.wi[2]) < 1e-5) continue;
        pairs.push(pair);
        places.push(4 * (row * width + column));
      }
    assert.ok(pairs.length > 10000, `${pairs.length} pixels`);
    const values = evaluate(spec, pairs);
    let worst = 0,
      at = 0;
    values.forEach((rgb, k) => {
      for (let c = 0; c < 3; c++) {
        const isLit = pairs[k].wi[2] > 0;
        const expected = 255 * Math.min(1, Math.max(0, isLit ? Math.PI * rgb[c] : 0)) ** (1 / 2.2);
        const off = Math.abs(pixels[places[k] + c] - expected);
        if (off > worst) [worst, at] = [off, k];
        nPixels++;
        if (off <= 0.5) nExact++;
      }
    });
    // A byte is within a half of what it stands for; another half is left for the shader's own rounding.
    assert.ok(worst <= 1, `${spec}: off by ${worst.toFixed(2)}/255 at wi ${pairs[at].wi}, wo ${pairs[at].wo}`);
  }
  t.diagnostic(
    `${nPixels} values of ${SPECS.length} materials, ${((100 * nExact) / nPixels).toFixed(3)} % the nearest byte`,
  );
  assert.deepEqual(complaints, []);
  await close();
});

test("every generated GLSL file compiles in WebGL 2", async () => {
  const names = readdirSync(join(folder, "glsl")).filter(name => name.endsWith(".glsl"));
  assert.ok(names.length >= models().length);
  const { page, close } = await open(browser, site.address);
  for (const name of names) {
    const text = readFileSync(join(folder, "glsl", name), "utf8"),
      calls = [...text.matchAll(/^bsdf_sample (\w+)_sample\(/gm)]
        .map(match => match[1])
        .filter(model => text.includes(`${model}_load(`));
    assert.ok(calls.length > 0, name);
    const log = await page.evaluate(
      ([source, models]) => {
        const gl = document.createElement("canvas").getContext("webgl2"),
          shader = gl.createShader(gl.FRAGMENT_SHADER);
        const body = models
          .map(
            model => `{ ${model}_params p = ${model}_load(w_${model}); vec3 v = vec3(0, 0, 1);
        r += vec4(${model}_eval(p, v, v)*${model}_pdf(p, v, v), ${model}_sample(p, v, v).pdf); }`,
          )
          .join("\n");
        const uniforms = models.map(model => `uniform uvec4 w_${model}[${model.toUpperCase()}_WORDS];`).join("\n");
        gl.shaderSource(
          shader,
          `#version 300 es\n${source}\n${uniforms}\nout vec4 r;\nvoid main() { r = vec4(0); ${body} }`,
        );
        gl.compileShader(shader);
        const log = gl.getShaderParameter(shader, gl.COMPILE_STATUS) ? "" : gl.getShaderInfoLog(shader);
        gl.getExtension("WEBGL_lose_context").loseContext();
        return log;
      },
      [text, calls],
    );
    assert.equal(log, "", name);
  }
  await close();
});
