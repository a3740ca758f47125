/* modules.mjs: the page's own modules, for tests that need no browser.
 *
 * SPDX-License-Identifier: MIT */
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { createServer } from "vite";

const folder = process.env.FACET_PAGE ?? "build/web";

/** load("brdf/fits") is src/brdf/fits.ts; fetch finds the files of the built page. */
export async function modules() {
  const server = await createServer({
    configFile: false,
    root: new URL("..", import.meta.url).pathname,
    logLevel: "error",
    server: { middlewareMode: true, watch: null, hmr: false, ws: false },
    define: { FACET_STAMP: JSON.stringify("tests") },
    optimizeDeps: { noDiscovery: true },
  });
  globalThis.document = { baseURI: "http://page/" };
  globalThis.fetch = async url => {
    const bytes = await readFile(join(folder, new URL(url).pathname));
    return { ok: true, arrayBuffer: async () => bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length) };
  };
  return { load: path => server.ssrLoadModule(`/src/${path}.ts`), close: () => server.close() };
}
