/* browser.mjs: what the tests share: a plain static server on loopback, and Debian's Chromium without a window.
 *
 * FACET_PAGE is the built folder; FACET_SCREENSHOTS, if set, where pictures of the views are kept.
 * SPDX-License-Identifier: MIT */
import { existsSync, mkdirSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { chromium } from "playwright-core";

const TYPES = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".css": "text/css",
  ".svg": "image/svg+xml",
  ".wasm": "application/wasm",
};
const FLAGS = [
  "--no-sandbox",
  "--disable-gpu",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
  "--use-gl=angle",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
];

export const DESKTOP = { width: 1320, height: 860 },
  PHONE = { width: 390, height: 844 };
const folder = process.env.FACET_PAGE ?? "build/web";
const CHROMIUM = process.env.CHROMIUM ?? "/usr/bin/chromium";

/** Serves the built folder as any static server would; the address of its index. */
export async function serve() {
  const server = createServer(async (request, response) => {
    const path = decodeURIComponent(new URL(request.url, "http://localhost").pathname);
    const name = normalize(path).replace(/^\/+/, "") || "index.html";
    try {
      const bytes = await readFile(join(folder, name));
      response.writeHead(200, { "content-type": TYPES[extname(name)] ?? "application/octet-stream" }).end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise(resolve => server.listen(0, "127.0.0.1", resolve));
  return { address: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() };
}

export async function launch() {
  if (!existsSync(CHROMIUM)) throw new Error(`${CHROMIUM} is missing: apt-get install chromium`);
  return chromium.launch({ executablePath: CHROMIUM, headless: true, args: FLAGS });
}

/** A page at the address, with what it complains of; `state` is the part behind '#'. */
export async function open(browser, address, state = "", { size = DESKTOP, scheme = "light" } = {}) {
  const context = await browser.newContext({ viewport: size, colorScheme: scheme, acceptDownloads: true });
  const page = await context.newPage(),
    complaints = [];
  // Reading pixels makes software rendering wait, which the driver thinks worth a line.
  const matters = message =>
    ["error", "warning"].includes(message.type()) && !message.text().includes("GPU stall due to ReadPixels");
  page.on("console", message => matters(message) && complaints.push(message.text()));
  page.on("pageerror", error => complaints.push(String(error)));
  page.on("response", answer => answer.status() >= 400 && complaints.push(`${answer.status()} ${answer.url()}`));
  await page.goto(address + (state && "#" + state));
  await page.waitForSelector(".tabs");
  return { page, complaints, close: () => context.close() };
}

export async function screenshot(page, name) {
  const to = process.env.FACET_SCREENSHOTS;
  if (!to) return;
  mkdirSync(to, { recursive: true });
  await page.screenshot({ path: join(to, `${name}.png`) });
}
