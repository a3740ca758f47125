/* tracer.worker.ts: paths through one scene until it is told otherwise; sums are posted now and then.
 *
 * SPDX-License-Identifier: MIT */
import type { Environment } from "../brdf/environment";
import { instantiate, type Facet } from "../facet/library";
import { Tracer } from "./tracer";

export interface TraceScene {
  readonly key: string;
  readonly text: string;
  readonly width: number;
  readonly height: number;
  readonly seed: number;
  readonly passes: number;
}
export interface TraceMessage {
  readonly module?: WebAssembly.Module;
  /** For this scene and those that follow. */
  readonly environment?: Environment;
  /** null: rest. */
  readonly scene?: TraceScene | null;
}
export interface TracePart {
  readonly key: string;
  readonly passes: number;
  readonly sums: Float32Array;
}

let facet: Facet;
let environment: Environment;
let scene: TraceScene | null = null;
let tracer: Tracer | undefined;
let done = 0;
const breath = new MessageChannel();

/** A pass, and then whatever messages have come in the meantime. */
function pass(): void {
  if (!scene || !tracer || done >= scene.passes) return;
  const sums = new Float32Array(3 * scene.width * scene.height),
    begun = performance.now();
  let passes = 0;
  do {
    tracer.addPass(sums);
    passes++;
  } while (performance.now() - begun < 60 && done + passes < scene.passes);
  done += passes;
  self.postMessage({ key: scene.key, passes, sums } satisfies TracePart, { transfer: [sums.buffer] });
  breath.port2.postMessage(0);
}
breath.port1.onmessage = pass;

self.onmessage = (event: MessageEvent<TraceMessage>) => {
  if (event.data.module) facet = instantiate(event.data.module);
  if (event.data.environment) environment = event.data.environment;
  if (event.data.scene === undefined) return;
  const isResting = !scene || done >= scene.passes;
  scene = event.data.scene;
  done = 0;
  if (!scene) return;
  const { text, width, height, seed } = scene;
  tracer = new Tracer(facet.prepare(text), environment, width, height, seed);
  if (isResting) breath.port2.postMessage(0);
};
