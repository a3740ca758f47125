/* files.test.mjs: files that are dropped or chosen become materials, or a message; materials and views are saved.
 *
 * SPDX-License-Identifier: MIT */
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { launch, open, screenshot, serve } from "./browser.mjs";
import { exr, hdr, mit, PYRAMID } from "./made_files.mjs";
import { facet, sphereDirections } from "./materials.mjs";
import { modules } from "./modules.mjs";

const root = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
const program = process.env.FACET_PROGRAM ?? "build/dev/facet";

let site, browser, scratch;
before(async () => {
  site = await serve();
  browser = await launch();
  scratch = mkdtempSync(join(tmpdir(), "facet-web-"));
});
after(async () => {
  await browser.close();
  site.close();
  rmSync(scratch, { recursive: true });
});

/* All quirks at once: text behind `analytic`, a line that begins with # in the shader, whole numbers for floats, a const
 * that is none, an int in a loop, a parameter with a name that the page's own shaders use. */
const BLINN = `analytic made for a test

# a comment
::begin parameters
float n 1 1000 20 and more
bool divide 0
color tint .8 .6 .4
::end parameters

::begin shader
#define LOST 1
const float PI = 3.14159265;
float power(float x, int k) { float p = 1; for (int i = 0; i < k; i++) p *= x; return p; }
vec3 BRDF( vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y )
{
    const vec3 H = normalize(L + V); // not a constant of GLSL ES
    float d = max(0, dot(N, H));
    float f = (n + 2)/(2*PI)*pow(d, n)*power(1, 3);
    if (divide) f /= dot(N, L);
    return vec3(f)*tint.xyz;
}
::end shader
`;

const file = (name, text) => ({ name, mimeType: "application/octet-stream", buffer: Buffer.from(text) });
const chosen = page => page.locator("input[type=file]");
const shown = (page, name, row = 0) =>
  page.locator(".readout tbody tr").nth(row).locator(`[data-value=${name}]`).textContent().then(Number);

test("a .brdf file of Disney's Explorer is compiled and shown with its parameters", async () => {
  const { page, complaints, close } = await open(browser, site.address, "m=lambert&of=f&scale=linear&view=curves");
  await chosen(page).setInputFiles(file("my blinn.brdf", BLINN));
  await page.waitForFunction(() => document.querySelectorAll("path.curve").length === 2);
  // At the mirror's direction H is N: f = 22/(2 pi) tint, in single precision.
  for (const [name, tint] of [
    ["f_r", 0.8],
    ["f_g", 0.6],
    ["f_b", 0.4],
  ]) {
    const expected = (22 / (2 * Math.PI)) * tint,
      found = await shown(page, name, 1);
    assert.ok(Math.abs(found / expected - 1) < 1e-5, `${name}: ${found}, ${expected}`);
  }
  const typed = page.locator("[data-parameter=n] .typed");
  await typed.fill("2");
  await typed.press("Enter");
  await page.waitForFunction(
    () => new URLSearchParams(location.hash.slice(1)).getAll("m")[1] === "file:my_blinn.brdf n=2",
  );
  const after = await shown(page, "f_r", 1),
    expected = (4 / (2 * Math.PI)) * 0.8;
  assert.ok(Math.abs(after / expected - 1) < 1e-5, `${after}, ${expected}`);
  await page.getByLabel("divide", { exact: true }).selectOption("1");
  await page.waitForFunction(() => location.hash.includes("divide"));
  const divided = await shown(page, "f_r", 1);
  assert.ok(Math.abs(divided / (expected / Math.SQRT1_2) - 1) < 1e-5, `${divided}`);
  for (const view of ["lobe", "slice", "sphere", "object"]) {
    await page.getByRole("tab", { name: view }).click();
    await page.waitForSelector(".figure canvas");
    if (view === "sphere") await page.locator("canvas[data-is-done=true]").waitFor();
    await screenshot(page, `brdf-file-${view}`);
  }
  await chosen(page).setInputFiles(
    file("kept.bparam", "bparam /somewhere/my blinn.brdf\n::begin parameters\nfloat n 1 9 7\n::end parameters\n"),
  );
  await page.waitForFunction(() => document.querySelectorAll(".entry").length === 3);
  assert.match(page.url(), /my_blinn.brdf/);
  const [kept] = readFileSync(await saved(page, ".bparam"), "utf8").match(/^float n .*$/m);
  assert.equal(kept, "float n 1.000000 1000.000000 7.000000");
  assert.match(readFileSync(join(scratch, "my_blinn.bparam"), "utf8"), /^bparam my_blinn\.brdf\n::begin parameters\n/);
  await chosen(page).setInputFiles(join(scratch, "my_blinn.bparam"));
  await page.waitForTimeout(300);
  assert.equal(await page.locator(".message").count(), 0, "what was saved can be opened");
  assert.deepEqual(complaints, []);
  await close();
});

test("Disney's parameters for a file that is not there any more are said to be so", async () => {
  const { page, close } = await open(browser, site.address, "m=file:lost.brdf+n%3D3");
  assert.match(
    await page.getByRole("alert").textContent(),
    /lost\.brdf is not in the address: drop the file here again/,
  );
  await close();
});

const BAD = {
  "empty.brdf": ["", /empty\.brdf:1: .*begins with "analytic"/],
  "word.brdf": ["bogus\n", /word\.brdf:1: begins with "bogus"/],
  "shader.brdf": ["analytic\n::begin parameters\n::end parameters\n", /has no vec3 BRDF/],
  "kind.brdf": ["analytic\n::begin parameters\nint k 1\n::end parameters\n", /kind\.brdf:3: "int" is no kind/],
  "bool.brdf": ["analytic\n::begin parameters\nbool b true\n::end parameters\n", /bool\.brdf:3: write bool NAME 0/],
  "open.brdf": ["analytic\n::begin shader\nvec3 BRDF(\n", /shader has no ::end/],
  "nested.brdf": ["analytic\n::begin a\n::begin b\n", /nested\.brdf:3: ::begin b inside a/],
  "code.brdf": [BLINN.replace("max(0", "maximum(0"), /the shader does not compile: .*maximum/],
  "short.binary": ["1234", /short\.binary: has 4 bytes; a MERL file is/],
  "sizes.binary": ["123456789012345", /its sizes are/],
  "alone.bparam": ["bparam /a/b.brdf\n", /belongs to b\.brdf: drop that file first/],
  "picture.jpg": ["JFIF", /is none of \.brdf/],
  "huge.hdr": ["#?RADIANCE\n\n-Y 100000 +X 200000\n", /huge\.hdr: has 200000 x 100000 pixels; 16384 x 8192/],
  "short.exr": ["v/1", /short\.exr: is no OpenEXR file/],
  "empty.obj": ["# nothing\n", /empty\.obj: has no faces/],
  "short.dat": ["1234", /short\.dat: has 4 bytes/],
};

test("a bad file gets a message and nothing else", async () => {
  const { page, complaints, close } = await open(browser, site.address);
  for (const [name, [text, wanted]] of Object.entries(BAD)) {
    await chosen(page).setInputFiles(file(name, text));
    await page.waitForFunction(part => document.querySelector(".message")?.textContent.includes(part), name);
    assert.match(await page.locator(".message").textContent(), wanted, name);
    assert.equal(await page.locator(".entry").count(), 3, name);
  }
  await screenshot(page, "bad-file");
  await page.getByRole("button", { name: "close the message" }).click();
  assert.equal(await page.locator(".message").count(), 0);
  assert.deepEqual(complaints, []);
  await close();
});

test("a dropped MERL file is measured data beside the models", async () => {
  const count = 90 * 90 * 180,
    bytes = Buffer.alloc(12 + 24 * count);
  [90, 90, 180].forEach((n, k) => bytes.writeUInt32LE(n, 4 * k));
  // f is 0.2, 0.3 and 0.4, but for a peak at theta_h = 0 in green.
  const f = [0.2 * 1500, (0.3 * 1500) / 1.15, (0.4 * 1500) / 1.66];
  for (let c = 0; c < 3; c++)
    for (let i = 0; i < count; i++)
      bytes.writeDoubleLE(c === 1 && i < 90 * 180 ? 2 * f[c] : f[c], 12 + 8 * (c * count + i));
  const path = join(scratch, "made.binary");
  writeFileSync(path, bytes);
  const { page, complaints, close } = await open(
    browser,
    site.address,
    "m=lambert&of=f&scale=linear&theta=30&theta2=30",
  );
  await chosen(page).setInputFiles(path);
  await page.waitForFunction(() => document.querySelectorAll("path.curve").length === 2, undefined, {
    timeout: 120000,
  });
  const found = await Promise.all(["f_r", "f_g", "f_b"].map(name => shown(page, name, 1)));
  [0.2, 0.6, 0.4].forEach((value, k) => assert.ok(Math.abs(found[k] / value - 1) < 1e-5, `${found}`));
  await page.getByRole("tab", { name: "Sphere" }).click();
  await page.locator("canvas[data-is-done=true]").waitFor({ timeout: 120000 });
  await screenshot(page, "merl-sphere");
  assert.deepEqual(complaints, []);
  await close();
});

/** A drop onto the page, as a file manager makes it. */
async function dropped(page, name, bytes) {
  const transfer = await page.evaluateHandle(
    ([name, base64]) => {
      const data = new DataTransfer();
      data.items.add(new File([Uint8Array.from(atob(base64), c => c.charCodeAt(0))], name));
      return data;
    },
    [name, Buffer.from(bytes).toString("base64")],
  );
  await page.dispatchEvent("body", "dragover", { dataTransfer: transfer });
  await page.waitForSelector(".drop-here");
  await page.dispatchEvent("body", "drop", { dataTransfer: transfer });
}

/** The mean of the opaque pixels of an object, red, green, blue, linear, once there are n samples. */
async function meanColour(page, n) {
  await page.waitForFunction(least => Number(document.querySelector(".figure canvas")?.dataset.samples) >= least, n, {
    timeout: 120000,
  });
  return page.evaluate(() => {
    const from = document.querySelector(".figure canvas"),
      copy = new OffscreenCanvas(from.width, from.height).getContext("2d");
    copy.drawImage(from, 0, 0);
    const { data } = copy.getImageData(0, 0, from.width, from.height),
      sums = [0, 0, 0, 0];
    for (let i = 0; i < data.length; i += 4)
      if (data[i + 3] === 255) {
        for (let c = 0; c < 3; c++) sums[c] += (data[i + c] / 255) ** 2.2;
        sums[3]++;
      }
    return sums.map(sum => sum / sums[3]);
  });
}

const SMALL = { width: 400, height: 700 };

test("dropped light and objects are seen, and asked for where they are gone", async () => {
  const state = "view=curves&exposure=-1&sampling=material&m=lambert+kd%3D1";
  const { page, complaints, close } = await open(browser, site.address, state, { size: SMALL });
  await dropped(
    page,
    "red.hdr",
    hdr(32, 16, () => [1, 0.5, 0.25], { coding: "new" }),
  );
  await page.waitForFunction(() => location.hash.includes("environment=file%3Ared.hdr"));
  assert.equal(await page.locator("#tab-object").getAttribute("aria-selected"), "true");
  const [r, g, b] = await meanColour(page, 4);
  for (const [found, wanted] of [
    [g / r, 0.5],
    [b / r, 0.25],
    [r, 0.5],
  ])
    assert.ok(Math.abs(found / wanted - 1) < 0.04, `${r} ${g} ${b}`);
  await dropped(
    page,
    "green.exr",
    exr(32, 16, () => [0.25, 1, 0.25], { compression: 2 }),
  );
  await page.waitForFunction(() => location.hash.includes("environment=file%3Agreen.exr"));
  await page.waitForTimeout(200);
  const green = await meanColour(page, 4);
  assert.ok(Math.abs(green[0] / green[1] / 0.25 - 1) < 0.04, `${green}`);
  const ball = await page.locator(".figure canvas").evaluate(canvas => canvas.toDataURL());
  await dropped(page, "pyramid.obj", PYRAMID);
  await page.waitForFunction(() => location.hash.includes("object=file%3Apyramid.obj"));
  await page.waitForTimeout(200);
  await meanColour(page, 4);
  assert.notEqual(await page.locator(".figure canvas").evaluate(canvas => canvas.toDataURL()), ball);
  await screenshot(page, "dropped-pyramid");
  const menus = await page.locator(".menu select").evaluateAll(all => all.map(one => one.value));
  assert.deepEqual(menus.slice(0, 2), ["file:green.exr", "file:pyramid.obj"]);
  await page.goBack();
  await page.waitForFunction(() => !location.hash.includes("object="));
  await page.goForward();
  await page.waitForFunction(() => location.hash.includes("object="));
  await page.getByRole("tab", { name: "Traced" }).click();
  await page.locator("canvas[data-passes]:not([data-passes='0'])").waitFor();
  assert.deepEqual(complaints, []);
  await page.reload();
  await page.waitForSelector("[role=alert]");
  assert.match(await page.getByRole("alert").textContent(), /green\.exr is not in the address: drop the file here/);
  await page.getByRole("tab", { name: "Object" }).click();
  await page.waitForFunction(() => document.querySelector("[role=alert]")?.textContent.includes("green.exr"));
  await dropped(
    page,
    "green.exr",
    exr(32, 16, () => [0.25, 1, 0.25]),
  );
  await page.waitForFunction(() => document.querySelector("[role=alert]")?.textContent.includes("pyramid.obj"));
  await dropped(page, "pyramid.obj", PYRAMID);
  await meanColour(page, 1);
  assert.equal(await page.locator("[role=alert]").count(), 0);
  await close();
});

test("a measurement of MIT is shaded as it is evaluated", async () => {
  const value = (ti, to, pd, pi) => {
    const f = 0.3 + 0.2 * Math.cos(pi) * Math.sin(ti) + 0.1 * Math.cos(pd) * Math.sin(to);
    return pi > 1 && pi < 1.3 ? [-1, -1, -1] : [f, f / 2, 0.25];
  };
  const bytes = mit([9, 9, 24, 16], value),
    light = { theta: 30, phi: 60 };
  const loaded = await modules();
  const [{ readMit }, { MitBrdf }, { newDirections, setDirection }] = await Promise.all(
    ["files/mit", "brdf/mit_brdf", "brdf/brdf"].map(loaded.load),
  );
  const brdf = new MitBrdf("made.dat", await readMit("made.dat", new Blob([bytes])));
  await loaded.close();
  const { page, complaints, close } = await open(
    browser,
    site.address,
    `view=sphere&light_theta=${light.theta}&light_phi=${light.phi}&m=-lambert`,
    { size: { width: 860, height: 620 } },
  );
  await dropped(page, "made.dat", bytes);
  await page.waitForFunction(() => document.querySelectorAll(".entry").length === 2);
  await page.locator("canvas[data-is-done=true]").waitFor({ timeout: 120000 });
  await screenshot(page, "mit-sphere");
  const { box, width, height, pixels } = await page.evaluate(() => {
    const canvas = document.querySelector(".figure canvas"),
      copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
    copy.drawImage(canvas, 0, 0);
    const data = copy.getImageData(0, 0, canvas.width, canvas.height).data;
    const box = JSON.parse(document.querySelector(".tile-name").dataset.box);
    return { box, width: canvas.width, height: canvas.height, pixels: [...data] };
  });
  const pairs = [];
  for (let row = 0; row < height; row += 3)
    for (let column = 0; column < width; column += 3) {
      const radius = 0.47 * box.side,
        x = (column + 0.5 - box.left - box.side / 2) / radius,
        y = (box.top + box.side / 2 - row - 0.5) / radius;
      if (x * x + y * y >= 0.9) continue;
      const pair = sphereDirections(x, y, light);
      if (pair.wi[2] > 0.01) pairs.push({ ...pair, at: 4 * (row * width + column) });
    }
  assert.ok(pairs.length > 3000, `${pairs.length} pixels`);
  const [wi, wo] = [newDirections(pairs.length), newDirections(pairs.length)];
  pairs.forEach((pair, i) => {
    setDirection(wi, i, pair.wi);
    setDirection(wo, i, pair.wo);
  });
  const { r, g, b } = brdf.eval(wi, wo);
  let nOff = 0;
  pairs.forEach(({ at }, i) =>
    [r, g, b].forEach((values, c) => {
      const expected = 255 * Math.min(1, Math.PI * values[i]) ** (1 / 2.2);
      if (Math.abs(pixels[at + c] - expected) > 1) nOff++;
    }),
  );
  // Where a bin begins that was not measured, rounding decides which ones take part.
  assert.ok(nOff < 0.001 * pairs.length, `${nOff} of ${3 * pairs.length} values are off by more than 1/255`);
  for (const view of ["Curves", "Lobe", "Slice", "Samples", "Object"]) {
    await page.getByRole("tab", { name: view }).click();
    await page.waitForTimeout(300);
  }
  await meanColour(page, 4);
  assert.deepEqual(complaints, []);
  await close();
});

test("fits of MERL materials are called fits", async () => {
  const { page, complaints, close } = await open(browser, site.address, "m=fit:gold-metallic-paint3&of=fcos&scale=log");
  await page.waitForSelector(".curve");
  assert.match(await page.locator(".legend").textContent(), /fit of MERL gold-metallic-paint3/);
  const [r, g, b] = await Promise.all(["f_r", "f_g", "f_b"].map(name => shown(page, name)));
  assert.ok(r > g && g > b && b > 0, `gold is yellow: ${r} ${g} ${b}`);
  await screenshot(page, "fit");
  assert.deepEqual(complaints, []);
  await close();
});

async function saved(page, button) {
  await page.locator(".export summary").click();
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("button", { name: button }).click(),
  ]);
  const path = join(scratch, download.suggestedFilename());
  await download.saveAs(path);
  return path;
}

test("a material is saved as spec, glTF, GLSL and C, which mean the same", async () => {
  const spec = "gtr alpha=.2 gamma=1.5 ks=.9,.7,.3 g2=separable";
  const { page, close } = await open(browser, site.address, `m=${encodeURIComponent(spec)}`);
  const [names, values] = facet("eval", spec, "--wi", "0,.6,.8", "--wo", "0,-.6,.8")
    .trim()
    .split("\n")
    .map(line => line.split(","));
  const expected = ["fcos_r", "fcos_g", "fcos_b", "pdf"].map(name => values[names.indexOf(name)]);
  assert.equal(readFileSync(await saved(page, "spec"), "utf8"), spec + "\n");
  const gltf = JSON.parse(readFileSync(await saved(page, "glTF"), "utf8"));
  assert.deepEqual(gltf.materials[0].extensions.FACET_materials_bsdf, {
    model: "gtr",
    alpha: 0.2,
    gamma: 1.5,
    ks: [0.9, 0.7, 0.3],
    g2: "separable",
  });
  const c = await saved(page, "C (.c)"),
    made = join(scratch, "material");
  execFileSync("cc", ["-I", join(root, "include"), c, join(dirname(program), "libfacet.a"), "-lm", "-o", made]);
  assert.equal(
    execFileSync(made, { encoding: "utf8" }).trim(),
    `${expected.slice(0, 3).join(" ")}, pdf ${expected[3]}`,
  );
  const glsl = readFileSync(await saved(page, "GLSL"), "utf8");
  const drawn = await page.evaluate(source => {
    const gl = document.createElement("canvas").getContext("webgl2");
    gl.getExtension("EXT_color_buffer_float");
    const program = gl.createProgram();
    const rest = "out vec4 r; void main() { r = vec4(material_eval(vec3(0, 0.6, 0.8), vec3(0, -0.6, 0.8)), 1); }";
    const vertex =
      "#version 300 es\nvoid main() { gl_Position = vec4(4*(gl_VertexID & 1) - 1, 4*(gl_VertexID >> 1) - 1, 0, 1); }";
    for (const [kind, text] of [
      [gl.VERTEX_SHADER, vertex],
      [gl.FRAGMENT_SHADER, `#version 300 es\n${source}\n${rest}`],
    ]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    gl.useProgram(program);
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, 1, 1);
    gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    gl.viewport(0, 0, 1, 1);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const pixel = new Float32Array(4);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.FLOAT, pixel);
    return [...pixel];
  }, glsl);
  // 32 roundings in a row, as tests/shaders allows.
  for (let k = 0; k < 3; k++)
    assert.ok(Math.abs(drawn[k] / Number(expected[k]) - 1) < 32 * 2 ** -24, `${drawn[k]}, ${expected[k]}`);
  await close();
});

/** In the page: the words of an SVG that overlap others, or stand outside. */
function overlaps(text) {
  const holder = document.createElement("div");
  holder.innerHTML = text;
  document.body.append(holder);
  const svg = holder.firstElementChild,
    frame = svg.getBoundingClientRect(),
    boxes = [...svg.querySelectorAll(":scope > text")].map(one => ({
      words: one.textContent,
      box: one.getBoundingClientRect(),
    }));
  const found = boxes
    .filter(({ box }) => box.left < frame.left - 1 || box.right > frame.right + 1)
    .map(({ words }) => `${words} is outside`);
  boxes.forEach(({ words, box }, i) =>
    boxes.slice(0, i).forEach(other => {
      const across = Math.min(box.right, other.box.right) - Math.max(box.left, other.box.left),
        down = Math.min(box.bottom, other.box.bottom) - Math.max(box.top, other.box.top);
      if (across > 2 && down > 6) found.push(`${words} over ${other.words}`);
    }),
  );
  holder.remove();
  return found;
}

test("every view is saved as SVG and PNG", async () => {
  const { page, complaints, close } = await open(browser, site.address);
  for (const view of ["curves", "lobe", "slice", "samples", "checks", "sphere", "object", "traced"]) {
    await page.getByRole("tab", { name: view }).click();
    await page.waitForTimeout(700);
    const svg = readFileSync(await saved(page, "SVG"), "utf8");
    assert.match(svg, /^<svg [\s\S]*<\/svg>$/, view);
    const isWell = await page.evaluate(
      text => !new DOMParser().parseFromString(text, "image/svg+xml").querySelector("parsererror"),
      svg,
    );
    assert.ok(isWell, `${view}: the SVG is well-formed`);
    assert.match(svg, view === "curves" ? /class="curve"/ : /<image /, view);
    assert.match(svg, /gtr alpha=.1 gamma=1.5/, view);
    // Each line of words is inside the picture, and no two of them overlap.
    const over = await page.evaluate(overlaps, svg);
    assert.deepEqual(over, [], view);
    const png = readFileSync(await saved(page, "PNG"));
    assert.equal(png.subarray(1, 4).toString(), "PNG", view);
    assert.ok(
      png.length > 8000 && png.readUInt32BE(16) > 1000,
      `${view}: ${png.length} bytes, ${png.readUInt32BE(16)} wide`,
    );
  }
  assert.deepEqual(complaints, []);
  await close();
});
