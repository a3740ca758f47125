/* traced.tsx: a ball of each material on a floor, path traced by workers that go on while nothing else happens.
 *
 * Each worker has a libfacet and paths of its own, and no memory is shared: this works from any static server.
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import type { Brdf } from "../brdf/brdf";
import type { Environment } from "../brdf/environment";
import { FacetBrdf } from "../facet/facet_brdf";
import { useAround } from "../session";
import { visibleEntries, type State } from "../state/state";
import { lineColour } from "../state/theme";
import type { TraceMessage, TracePart } from "../workers/tracer.worker";
import { Figure } from "./figure";
import { missingFile } from "./object";

const WIDTH = 384,
  HEIGHT = 320,
  MOST_PASSES = 2048,
  MOST_WORKERS = 4;

/** The workers of one picture, and what they have summed. */
class Picture {
  private readonly workers: Worker[];
  private sums = new Float32Array(3 * WIDTH * HEIGHT);
  private key = "";
  private environment: Environment | undefined;
  private begun = 0;
  passes = 0;

  constructor(module: WebAssembly.Module, n: number, tell: () => void) {
    this.workers = Array.from({ length: n }, () => {
      const worker = new Worker(new URL("../workers/tracer.worker.ts", import.meta.url), { type: "module" });
      worker.postMessage({ module } satisfies TraceMessage);
      worker.onmessage = (event: MessageEvent<TracePart>) => {
        if (event.data.key !== `${this.begun}|${this.key}`) return;
        const { sums } = event.data;
        for (let i = 0; i < sums.length; i++) this.sums[i] += sums[i];
        this.passes += event.data.passes;
        tell();
      };
      return worker;
    });
  }

  show(brdf: Brdf, environment: Environment): void {
    const isLit = environment === this.environment,
      key = brdf.text;
    if (isLit && key === this.key) return;
    // Parts of the picture before may still be on their way.
    if (!isLit) this.begun++;
    this.environment = environment;
    this.key = key;
    this.passes = 0;
    this.sums.fill(0);
    const passes = Math.ceil(MOST_PASSES / this.workers.length);
    const scene = { key: `${this.begun}|${key}`, text: brdf.text, width: WIDTH, height: HEIGHT, passes };
    this.workers.forEach((worker, k) =>
      worker.postMessage({
        ...(isLit ? {} : { environment }),
        scene: { ...scene, seed: 1 + k },
      } satisfies TraceMessage),
    );
  }

  paint(canvas: HTMLCanvasElement, exposure: number): void {
    const context = canvas.getContext("2d")!,
      image = context.createImageData(WIDTH, HEIGHT),
      scale = exposure / Math.max(this.passes, 1);
    for (let i = 0; i < WIDTH * HEIGHT; i++) {
      for (let c = 0; c < 3; c++)
        image.data[4 * i + c] = Math.round(255 * Math.min(1, Math.max(0, this.sums[3 * i + c] * scale)) ** (1 / 2.2));
      image.data[4 * i + 3] = 255;
    }
    context.putImageData(image, 0, 0);
  }

  close(): void {
    for (const worker of this.workers) worker.terminate();
  }
}

function Ball(props: {
  brdf: FacetBrdf;
  place: number;
  state: State;
  environment: Environment;
  n: number;
}): JSX.Element {
  const { brdf, place, state, environment, n } = props;
  const { session, theme } = useAround();
  const canvas = useRef<HTMLCanvasElement>(null),
    picture = useRef<Picture | null>(null);
  const [passes, setPasses] = useState(0);
  const exposure = useRef(1);
  exposure.current = 2 ** state.exposure;
  useEffect(() => {
    let frame = 0;
    const paint = (): void => {
      frame = 0;
      if (!picture.current || !canvas.current) return;
      picture.current.paint(canvas.current, exposure.current);
      setPasses(picture.current.passes);
    };
    picture.current = new Picture(session.module, n, () => (frame ||= requestAnimationFrame(paint)));
    return () => {
      cancelAnimationFrame(frame);
      picture.current?.close();
    };
  }, [n]);
  useEffect(() => {
    const timer = setTimeout(() => picture.current?.show(brdf, environment), 30);
    return () => clearTimeout(timer);
  }, [brdf.text, environment, n]);
  useEffect(() => picture.current?.paint(canvas.current!, exposure.current), [state.exposure]);
  return (
    <div class="panel traced">
      <p class="panel-title">
        <i class="dot" style={{ background: lineColour(theme, place) }} />
        <span data-export-text>{brdf.label}</span>
      </p>
      <canvas ref={canvas} width={WIDTH} height={HEIGHT} data-passes={passes} />
      <p class="panel-note" data-export-text>
        {passes} of {MOST_PASSES} paths a pixel
      </p>
    </div>
  );
}

export function Traced({ state }: { state: State }): JSX.Element {
  const { session } = useAround();
  const shown = visibleEntries(state).flatMap(({ entry, place }) => {
    const { brdf } = session.resolve(entry);
    return brdf ? [{ entry, place, brdf }] : [];
  });
  const traced = shown.filter(one => one.brdf instanceof FacetBrdf);
  const cores = Math.max(1, (navigator.hardwareConcurrency || 2) - 1);
  const n = Math.max(1, Math.min(MOST_WORKERS, Math.floor(cores / Math.max(traced.length, 1))));
  const environment = session.environment(state);
  if (!environment)
    return (
      <p class="problem" role="alert">
        {missingFile(state.environment)}
      </p>
    );
  return (
    <Figure name="traced">
      <div class="panels traced-panels">
        {traced.map(({ entry, place, brdf }) => (
          <Ball key={entry.id} {...{ place, state, environment, n }} brdf={brdf as FacetBrdf} />
        ))}
      </div>
      {shown.length > traced.length && (
        <p class="explains">Files, measurements and fits have no sampler to trace with: see Sphere and Object.</p>
      )}
    </Figure>
  );
}
