/* albedo.ts: directional albedos: those of the library's models from a worker, others when the page is idle.
 *
 * SPDX-License-Identifier: MIT */
import { useEffect, useState } from "preact/hooks";
import { direction } from "../brdf/angles";
import type { Brdf } from "../brdf/brdf";
import { albedoOf } from "../brdf/quadrature";
import { useAround } from "../session";
import { visibleEntries, type State } from "../state/state";
import type { AlbedoAnswer } from "../workers/messages";
import { numbersQueue, type Queue } from "../workers/queue";
import type { Points } from "./curve_data";

/** What is known by now; undefined before the first value. */
export type AlbedoPoints = (brdf: Brdf) => Points | undefined;

/* Every fourth first, so that the curve has its shape early. */
const ANGLES = [...Array(24).keys()].map(i => Math.min(89, 4 * i));
const ORDER = [...ANGLES.keys()].sort((a, b) => (a % 4) - (b % 4) || a - b);

type Known = Map<number, readonly number[]>;
const MOST_KEPT = 64;
const known = new Map<string, Known>();

function entryOf(brdf: Brdf, phi: number): Known {
  const key = `${brdf.text}|${phi}`;
  let values = known.get(key);
  if (!values) {
    values = new Map();
    known.set(key, values);
    if (known.size > MOST_KEPT) known.delete(known.keys().next().value!);
  }
  return values;
}

function idle(signal: AbortSignal): Promise<void> {
  return new Promise(resolve =>
    setTimeout(() => {
      if (!signal.aborted) resolve();
    }),
  );
}

async function fill(queue: Queue, brdf: Brdf, phi: number, signal: AbortSignal, tell: () => void): Promise<void> {
  const values = entryOf(brdf, phi);
  for (const i of ORDER) {
    const theta = ANGLES[i];
    if (values.has(theta)) continue;
    if (signal.aborted) return;
    if (brdf.kind === "facet") {
      const answer = await queue.ask<AlbedoAnswer>(
        { kind: "albedo", text: brdf.text, wo: direction(-theta, phi) },
        signal,
      );
      values.set(theta, answer.reflected);
    } else {
      await idle(signal);
      values.set(theta, albedoOf(brdf, theta, phi));
    }
    tell();
  }
}

function channel(state: State, rgb: readonly number[]): number {
  if (state.channel === "luminance" || state.channel === "colours")
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
  return rgb[["red", "green", "blue"].indexOf(state.channel)];
}

export function useAlbedos(state: State): AlbedoPoints {
  const { session } = useAround();
  const [, again] = useState(0);
  const isWanted = state.view === "curves" && state.curve === "albedo";
  const brdfs = isWanted ? visibleEntries(state).flatMap(({ entry }) => session.resolve(entry).brdf ?? []) : [];
  useEffect(() => {
    if (!brdfs.length) return undefined;
    const stop = new AbortController();
    for (const brdf of brdfs)
      void fill(numbersQueue(session.module), brdf, state.phi, stop.signal, () => again(n => n + 1));
    return () => stop.abort();
  }, [brdfs.map(brdf => brdf.text).join("\n"), state.phi]);
  return brdf => {
    const values = [...entryOf(brdf, state.phi)].sort(([a], [b]) => a - b);
    if (!values.length) return undefined;
    return { x: Float64Array.from(values, ([theta]) => theta), y: values.map(([, rgb]) => channel(state, rgb)) };
  };
}
