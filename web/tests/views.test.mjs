/* views.test.mjs: every view shows something, in light and dark, wide and narrow, without complaints.
 *
 * SPDX-License-Identifier: MIT */
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, open, PHONE, screenshot, serve } from "./browser.mjs";

let site, browser;
before(async () => {
  site = await serve();
  browser = await launch();
});
after(async () => {
  await browser.close();
  site.close();
});

const METALS =
  "m=ggx+alpha%3D.3+metal%3DAu&m=disney+base_color%3D.8,.2,.1+roughness%3D.4&m=beckmann+alpha%3D.2+ks%3D.2,.4,.9";
const CURVES = ["D", "Lambda", "G1", "F", "f", "fcos", "pdf", "theta-h", "theta-d", "error"];

/** What is there once a view is whole, and how many distinct colours a canvas must have to show something. */
const VIEWS = {
  lobe: { state: "scale=shifted", ready: "canvas" },
  slice: { state: METALS, ready: ".panel canvas" },
  samples: { state: "m=ggx+alpha%3D.3&m=glass+alpha%3D.3&theta=60", ready: "path.samples[d]" },
  checks: {
    state: "m=ggx+alpha%3D.5&m=gtr+alpha%3D.3+gamma%3D6+masking%3Dpublished",
    ready: ".panel-note:has-text('p =')",
  },
  sphere: { state: METALS, ready: "canvas[data-is-done=true]" },
  object: {
    state: "m=disney+base_color%3D.8,.2,.1+roughness%3D.4&object=vase",
    ready: "canvas[data-samples]:not([data-samples='0'])",
  },
  traced: { state: "m=ggx+alpha%3D.1+metal%3DCu&m=glass", ready: "canvas[data-passes]:not([data-passes='0'])" },
};

/** How many of the pixels of the first canvas differ from the first one. */
async function drawnPixels(page) {
  return page.evaluate(() => {
    const from = document.querySelector(".figure canvas"),
      copy = new OffscreenCanvas(from.width, from.height).getContext("2d");
    copy.drawImage(from, 0, 0);
    const pixels = new Uint32Array(copy.getImageData(0, 0, from.width, from.height).data.buffer);
    return pixels.filter(pixel => pixel !== pixels[0]).length;
  });
}

for (const curve of CURVES)
  test(`the curve ${curve} is drawn, also polar and in the dark`, async () => {
    const m = curve === "error" ? "m=gtr+alpha%3D.1+gamma%3D.5&m=gtr+alpha%3D.1+gamma%3D6" : METALS,
      scale = curve === "D" ? "log" : "linear";
    for (const [polar, scheme] of [
      [0, "light"],
      [1, "dark"],
    ]) {
      const state = `of=${curve}&scale=${scale}&polar=${polar}&${m}`;
      const { page, complaints, close } = await open(browser, site.address, state, { scheme });
      await page.waitForSelector(".curve");
      // Disney's model has no Fresnel term that could be shown alone; it has a distribution of normals.
      const expected = curve === "error" || curve === "F" ? 2 : 3;
      assert.equal(await page.locator("path.curve").count(), expected);
      for (const d of await page.locator("path.curve").evaluateAll(all => all.map(one => one.getAttribute("d"))))
        assert.ok(d && d.length > 500 && !d.includes("NaN"), `${curve}: ${d?.slice(0, 80)}`);
      await screenshot(page, `curves-${curve}-${polar ? "polar-dark" : "light"}`);
      assert.deepEqual(complaints, []);
      await close();
    }
  });

test("red, green and blue are three curves of the values that the channels have alone", async () => {
  const gold = "of=fcos&scale=linear&m=ggx+alpha%3D.3+metal%3DAu";
  const { page, complaints, close } = await open(browser, site.address, `${gold}&channel=colours`);
  await page.waitForFunction(() => document.querySelectorAll("path.curve").length === 3);
  const peak = path => Math.min(...path.match(/,[\d.]+/g).map(y => Number(y.slice(1))));
  const [red, green, blue] = (
    await page.locator("path.curve").evaluateAll(all => all.map(one => one.getAttribute("d")))
  ).map(peak);
  assert.ok(red < green && green < blue, `gold is yellow: ${red} ${green} ${blue} from above`);
  await screenshot(page, "curves-colours");
  await page.locator(".menu select").first().selectOption("albedo");
  await page.waitForFunction(
    () => (document.querySelector(".curve")?.getAttribute("d").match(/L/g) ?? []).length >= 20,
  );
  assert.ok(!(await page.locator(".curve").getAttribute("d")).includes("NaN"));
  assert.deepEqual(complaints, []);
  await close();
});

test("albedos arrive from the worker, and agree with facet's", async () => {
  const { page, complaints, close } = await open(browser, site.address, "of=albedo&scale=linear&m=lambert+kd%3D.5");
  await page.waitForFunction(
    () => (document.querySelector(".curve")?.getAttribute("d").match(/L/g) ?? []).length >= 20,
  );
  const heights = await page.locator(".curve").evaluate(path => {
    const ys = path
      .getAttribute("d")
      .match(/[-\d.]+,([-\d.]+)/g)
      .map(pair => Number(pair.split(",")[1]));
    return Math.max(...ys) - Math.min(...ys);
  });
  assert.ok(heights < 0.01, "a Lambertian albedo is the same at all angles");
  assert.deepEqual(complaints, []);
  await close();
});

for (const [view, { state, ready }] of Object.entries(VIEWS))
  for (const [name, options] of Object.entries({
    light: {},
    "phone-dark": { size: PHONE, scheme: "dark" },
  }))
    test(`the view ${view} is drawn, ${name}`, async () => {
      const { page, complaints, close } = await open(browser, site.address, `view=${view}&${state}`, options);
      await page.locator(ready).first().waitFor({ timeout: 120000 });
      await page.waitForTimeout(300);
      const drawn = await drawnPixels(page);
      assert.ok(drawn > 1000, `${view}: ${drawn} pixels are drawn`);
      const width = await page.evaluate(() => document.documentElement.scrollWidth);
      assert.ok(width <= (options.size?.width ?? 1320), `the page is ${width} wide`);
      await screenshot(page, `${view}-${name}`);
      assert.deepEqual(complaints, []);
      await close();
    });

test("the furnaces and the chi-square test say what facet verify says", async () => {
  const m = "m=ggx+alpha%3D.5&m=gtr+alpha%3D.3+gamma%3D6+masking%3Dpublished";
  const { page, close } = await open(browser, site.address, `view=checks&${m}`);
  await page.waitForFunction(() => document.querySelectorAll(".furnace tr[data-is-done=true]").length === 2);
  const weak = await page.locator("[data-value=weak]").allTextContents();
  assert.ok(Math.abs(Number(weak[0]) - 1) < 1e-5, `exact masking: ${weak[0]}`);
  assert.ok(Math.abs(Number(weak[1]) - 1) > 1e-4, `published masking: ${weak[1]}`);
  await page.waitForFunction(() => document.querySelectorAll(".panel-note")[1]?.textContent.startsWith("p ="));
  assert.match(await page.locator(".panel-note").first().textContent(), /holds/);
  await close();
});

test("a lobe follows its direction and its view", async () => {
  const { page, close } = await open(browser, site.address, "view=lobe&m=ggx+alpha%3D.3");
  const shot = () => page.locator(".figure canvas").evaluate(canvas => canvas.toDataURL());
  await page.waitForSelector("svg.can-turn circle");
  const first = await shot();
  await page.locator("svg.can-turn").focus();
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => location.hash.includes("turn="));
  const second = await shot();
  assert.notEqual(first, second);
  const handle = page.locator("svg.can-turn circle");
  const box = await handle.boundingBox();
  await page.mouse.move(box.x + 6, box.y + 6);
  await page.mouse.down();
  await page.mouse.move(box.x + 80, box.y - 30, { steps: 4 });
  await page.mouse.up();
  await page.waitForFunction(() => /[#&]theta=/.test(location.hash));
  assert.notEqual(await shot(), second);
  await close();
});

test("materials are hidden, shown alone, copied and removed", async () => {
  const { page, close } = await open(browser, site.address);
  await page.waitForSelector(".curve");
  const curves = n => page.waitForFunction(count => document.querySelectorAll("path.curve").length === count, n);
  await page.getByRole("button", { name: "hide" }).first().click();
  await curves(2);
  await page.getByRole("button", { name: "show this one alone" }).nth(1).click();
  await curves(1);
  await page.getByRole("button", { name: "show this one alone" }).nth(1).click();
  await page.getByRole("button", { name: "show", exact: true }).click();
  await page.getByRole("button", { name: "copy", exact: true }).first().click();
  await curves(4);
  await page.getByRole("button", { name: "remove" }).first().click();
  await curves(3);
  await page.getByLabel("add a material").selectOption("ward");
  await page.waitForFunction(() => document.querySelectorAll(".entry").length === 4);
  await close();
});

test("every view can be reached by keyboard, with a focus that is seen", async () => {
  const { page, close } = await open(browser, site.address);
  await page.getByRole("tab", { name: "Curves" }).focus();
  for (const view of ["lobe", "slice", "samples", "checks", "sphere", "object", "traced"]) {
    await page.keyboard.press("ArrowRight");
    await page.waitForFunction(name => new URLSearchParams(location.hash.slice(1)).get("view") === name, view);
    const outline = await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle);
    assert.equal(outline, "solid", view);
  }
  // Keys that come faster than frames are all counted: round by one tab more than there are.
  await page.evaluate(() => {
    for (let k = 0; k < 9; k++)
      document.activeElement.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight", bubbles: true }));
  });
  assert.equal(
    await page.evaluate(() => new URLSearchParams(location.hash.slice(1)).get("view") ?? "curves"),
    "curves",
  );
  await close();
});
