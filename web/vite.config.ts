/* vite.config.ts: how the page is put together.  FACET_BUILD is the folder with facet.wasm and glsl/, FACET_PAGE the
 * folder to write; tools/web.sh sets both.
 *
 * SPDX-License-Identifier: MIT */
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { defineConfig } from "vite";

const root = resolve(__dirname, "..");
const inputs = resolve(root, process.env.FACET_INPUTS ?? "build/web-inputs");

// Files that keep their names are asked for with the library's hash, so that no browser mixes versions.
const stamp = createHash("sha256")
  .update(readFileSync(resolve(inputs, "facet.wasm")))
  .digest("hex")
  .slice(0, 12);

export default defineConfig({
  root: __dirname,
  base: "./",
  publicDir: inputs,
  define: { FACET_STAMP: JSON.stringify(stamp) },
  build: {
    outDir: resolve(root, process.env.FACET_PAGE ?? "build/web"),
    emptyOutDir: true,
    target: "es2022",
    assetsInlineLimit: 0,
  },
  worker: { format: "es" },
  plugins: [{ name: "stamp", transformIndexHtml: html => html.replace("facet.wasm", `facet.wasm?${stamp}`) }],
});
