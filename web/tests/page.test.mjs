/* page.test.mjs: the page starts, shows the library's own numbers, and keeps its state in the address.
 *
 * SPDX-License-Identifier: MIT */
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { after, before, test } from "node:test";
import { launch, open, screenshot, serve } from "./browser.mjs";
import { draws, facet, models, randomSpec } from "./materials.mjs";

let site, browser;
before(async () => {
  site = await serve();
  browser = await launch();
});
after(async () => {
  await browser.close();
  site.close();
});

/** The page shows what its address says, once it has had two frames. */
async function show(page, state) {
  await page.evaluate(
    hash =>
      new Promise(resolve => {
        location.hash = hash;
        requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(resolve)));
      }),
    state,
  );
}

test("the first view has three materials and nothing to complain of", async t => {
  const { page, complaints, close } = await open(browser, site.address);
  await page.waitForSelector(".curve");
  assert.equal(await page.locator(".entry").count(), 3);
  assert.equal(await page.locator("path.curve").count(), 3);
  const first = await page.evaluate(() => performance.getEntriesByName("facet-first-view")[0].startTime);
  t.diagnostic(`first view ${first.toFixed(0)} ms after the navigation began`);
  await screenshot(page, "curves-D-light");
  assert.deepEqual(complaints, []);
  await close();
});

test("the numbers shown are those of facet eval for 100 random settings", async t => {
  const draw = draws(7),
    table = models(),
    { page, complaints, close } = await open(browser, site.address);
  for (let i = 0; i < 100; i++) {
    const spec = randomSpec(table, draw),
      angles = [89 * draw(), 360 * draw(), 90 * (2 * draw() - 1), 360 * draw() - 180].map(x => x.toFixed(3));
    const fixed = draw() < 0.5 ? "viewer" : "light";
    await show(
      page,
      new URLSearchParams({
        m: spec,
        theta: angles[0],
        phi: angles[1],
        theta2: angles[2],
        phi2: angles[3],
        fixed,
      }).toString(),
    );
    const shown = await page.evaluate(() => ({
      wi: document.querySelector(".directions").dataset.wi,
      wo: document.querySelector(".directions").dataset.wo,
      spec: document.querySelector(".spec").value,
      cells: Object.fromEntries(
        [...document.querySelectorAll(".readout [data-value]")].map(td => [td.dataset.value, td.textContent]),
      ),
    }));
    assert.equal(shown.spec, spec);
    const [names, values] = facet("eval", spec, "--wi", shown.wi, "--wo", shown.wo)
      .trim()
      .split("\n")
      .map(line => line.split(","));
    names.slice(6).forEach((name, k) => {
      const expected = Number(values[6 + k]),
        found = shown.cells[name] === "–" ? 0 : Number(shown.cells[name]);
      // The same digits: both are the same operations on the same floats.
      assert.equal(found, expected, `${spec} ${name}`);
    });
  }
  assert.deepEqual(complaints, []);
  await close();
});

test("moving a slider changes the picture, the spec and the address", async () => {
  const { page, close } = await open(browser, site.address, "m=ggx+alpha%3D.1");
  const curve = () => page.locator("path.curve").getAttribute("d");
  const before = await curve();
  await page.getByRole("slider", { name: "alpha", exact: true }).focus();
  await page.keyboard.press("PageUp");
  await page.waitForFunction(old => document.querySelector("path.curve").getAttribute("d") !== old, before);
  const spec = await page.locator(".spec").inputValue();
  assert.match(spec, /^ggx alpha=0\.\d+$/);
  await page.waitForFunction(text => new URLSearchParams(location.hash.slice(1)).get("m") === text, spec);
  await page.locator("[data-parameter=alpha] .name").dblclick();
  await page.waitForFunction(() => document.querySelector(".spec").value === "ggx");
  await close();
});

test("directions are typed, reset by a double click, and dragged in the view", async () => {
  const { page, close } = await open(browser, site.address, "m=ggx+alpha%3D.3&of=fcos&scale=linear");
  const typed = page.getByLabel("θₒ, value"),
    slider = page.getByRole("slider", { name: "θₒ" });
  const theta = async value => {
    for (let i = 0; i < 50 && (await typed.inputValue()) !== value; i++) await page.waitForTimeout(40);
    assert.equal(await typed.inputValue(), value);
  };
  await typed.fill("200");
  await typed.press("Enter");
  await theta("89.9");
  await typed.fill("30");
  await typed.press("Enter");
  await theta("30");
  await typed.dblclick();
  await page.waitForTimeout(100);
  await theta("30"); // a double click there selects the number
  await slider.dblclick();
  await theta("45");
  const box = await page.locator("svg.can-drag").boundingBox();
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.5 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.2 * box.width, box.y + 0.5 * box.height, { steps: 4 });
  await page.mouse.up();
  await page.waitForFunction(() => Number(new URLSearchParams(location.hash.slice(1)).get("theta")) > 50);
  await close();
});

test("what the library refuses is said where it was typed", async () => {
  const { page, close } = await open(browser, site.address, "m=ggx");
  await page.locator(".spec").fill("ggx alpha=7");
  await page.keyboard.press("Enter");
  await page.getByRole("alert").waitFor();
  assert.match(await page.getByRole("alert").textContent(), /^alpha: .*out of range/);
  await close();
});

test("parameters that exclude each other replace each other", async () => {
  const { page, close } = await open(browser, site.address, "m=ggx+alpha%3D.2+ior%3D1.7");
  const typed = page.locator("[data-parameter=ks] .typed");
  await typed.fill(".9,.7,.3");
  await typed.press("Enter");
  await page.waitForFunction(() => document.querySelector(".spec").value === "ggx alpha=0.2 ks=0.9,0.7,0.3");
  await close();
});

test("an address survives a reload, and going back", async () => {
  const state = "m=ggx+alpha%3D.2&m=-lambert&view=curves&of=fcos&scale=linear&polar=1&theta=60";
  const { page, complaints, close } = await open(browser, site.address, state);
  await page.waitForSelector(".curve");
  assert.equal(await page.locator(".entry.is-hidden").count(), 1);
  await page.getByRole("radio", { name: "Cartesian" }).check({ force: true });
  await page.waitForFunction(() => !location.hash.includes("polar"));
  const address = page.url();
  await page.reload();
  await page.waitForSelector(".curve");
  assert.equal(page.url(), address);
  assert.equal(await page.getByRole("radio", { name: "Cartesian" }).isChecked(), true);
  await page.goBack();
  await page.waitForFunction(() => document.querySelector("input[value=polar]").checked);
  assert.deepEqual(complaints, []);
  await close();
});

test("going back undoes a whole slide, and a slide by keys", async () => {
  const { page, close } = await open(browser, site.address, "m=ggx+alpha%3D.1"),
    spec = () => page.locator(".spec").inputValue(),
    entries = () => page.evaluate(() => history.length);
  const shows = text => page.waitForFunction(one => document.querySelector(".spec").value === one, text);
  const slider = page.getByRole("slider", { name: "alpha", exact: true }),
    box = await slider.boundingBox(),
    first = await entries();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + box.height / 2);
  await page.mouse.down();
  for (let k = 1; k <= 20; k++) {
    await page.mouse.move(box.x + (0.5 + 0.01 * k) * box.width, box.y + box.height / 2);
    await page.waitForTimeout(20);
  }
  await page.mouse.up();
  assert.equal(await entries(), first + 1, "one entry for a slide");
  const slid = await spec();
  await page.waitForFunction(text => new URLSearchParams(location.hash.slice(1)).get("m") === text, slid);
  await page.getByRole("tab", { name: "Lobe" }).click();
  await page.getByRole("tab", { name: "Curves" }).click();
  await slider.focus();
  for (let k = 0; k < 5; k++) await page.keyboard.press("ArrowLeft");
  assert.equal(await entries(), first + 4, "one entry for keys in a row");
  const moved = await spec();
  assert.notEqual(moved, slid);
  await page.goBack();
  await shows(slid);
  await page.goBack();
  await page.goBack();
  await shows(slid);
  await page.goBack();
  await shows("ggx alpha=.1");
  await page.goForward();
  await shows(slid);
  // Another slide after going back is an entry of its own.
  await page.locator("[data-parameter=alpha] .name").dblclick();
  await shows("ggx");
  await page.goBack();
  await shows(slid);
  await close();
});

test(
  "facet explore serves the page to this machine",
  { skip: !process.env.FACET_PROGRAM && "needs the program" },
  async t => {
    assert.equal(facet("explore", "--path").trim(), process.env.FACET_PAGE);
    const program = spawn(process.env.FACET_PROGRAM, ["explore", "--port", "0", "--no-open"]);
    const ended = new Promise(resolve => program.on("exit", resolve));
    const address = await new Promise((resolve, reject) => {
      program.stdout.once("data", text => resolve(String(text).trim()));
      program.on("exit", () => reject(new Error("it ended: " + program.stderr.read())));
    });
    assert.match(address, /^http:\/\/127\.0\.0\.1:\d+\/$/);
    const { page, complaints, close } = await open(browser, address);
    await page.waitForSelector(".curve");
    assert.deepEqual(complaints, []);
    await close();
    program.kill("SIGINT");
    assert.equal(await ended, 0);
  },
);
