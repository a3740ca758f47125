/* main.tsx: starts the page: facet.wasm, the state of the address, the page.
 *
 * SPDX-License-Identifier: MIT */
import { render } from "preact";
import { App } from "./app";
import { instantiate } from "./facet/library";
import { Session } from "./session";
import { Store } from "./state/store";

async function compile(): Promise<WebAssembly.Module> {
  const url = new URL(`./facet.wasm?${FACET_STAMP}`, document.baseURI);
  try {
    return await WebAssembly.compileStreaming(fetch(url));
  } catch (error) {
    if (!(error instanceof TypeError)) throw error;
    // A server that does not know the type application/wasm.
    return WebAssembly.compile(await (await fetch(url)).arrayBuffer());
  }
}

async function start(): Promise<void> {
  const page = document.getElementById("page")!;
  try {
    const module = await compile();
    const session = new Session(instantiate(module), module, new Store());
    page.textContent = "";
    render(<App session={session} />, page);
    requestAnimationFrame(() => performance.mark("facet-first-view"));
  } catch (error) {
    page.innerHTML = "<p class='loading' role='alert'></p>";
    page.firstElementChild!.textContent = `facet could not start: ${error instanceof Error ? error.message : String(error)}`;
    throw error;
  }
}

void start();
