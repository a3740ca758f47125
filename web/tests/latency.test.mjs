/* latency.test.mjs: how long the page takes from a slider to the picture: reported, for machines differ.
 *
 * SPDX-License-Identifier: MIT */
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, open, serve } from "./browser.mjs";

let site, browser;
before(async () => {
  site = await serve();
  browser = await launch();
});
after(async () => {
  await browser.close();
  site.close();
});

for (const view of ["curves&of=D", "curves&of=fcos", "lobe", "slice", "samples"])
  test(`a slider moves ${view}`, async t => {
    const { page, close } = await open(browser, site.address, `view=${view}`);
    await page.waitForTimeout(500);
    const times = await page.evaluate(async () => {
      const slider = document.querySelector("[data-parameter=alpha] .slider"),
        times = [];
      for (let k = 0; k < 40; k++) {
        slider.value = String(300 + 10 * k);
        slider.dispatchEvent(new Event("input", { bubbles: true }));
        // The page draws in the next frame, before this.
        times.push(await new Promise(resolve => requestAnimationFrame(begun => resolve(performance.now() - begun))));
      }
      return times.slice(5).sort((a, b) => a - b);
    });
    assert.match(await page.locator(".spec").first().inputValue(), /alpha=0?\.\d+/);
    t.diagnostic(
      `${view}: ${times[Math.floor(times.length / 2)].toFixed(1)} ms of a frame, at most ${times.at(-1).toFixed(1)} ms`,
    );
    await close();
  });
