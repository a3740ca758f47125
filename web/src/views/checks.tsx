/* checks.tsx: is it right: samples against their density as a chi-square heat map, and both furnaces in numbers.
 *
 * The worker computes with the C code of `facet verify`.
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import { useEffect, useState } from "preact/hooks";
import { scaleLinear } from "d3-scale";
import { direction } from "../brdf/angles";
import type { Brdf } from "../brdf/brdf";
import { cellOf, SECTORS } from "../brdf/cells";
import { albedoOf } from "../brdf/quadrature";
import { tableSampler } from "../brdf/table_sampler";
import { drawAxis } from "../chart/axis";
import { clear } from "../chart/chart";

import { useAround } from "../session";
import { visibleEntries, type State } from "../state/state";
import { divergingColour } from "../state/theme";
import { numbersQueue } from "../workers/queue";
import type { ChiSquareAnswer, FurnaceAnswer } from "../workers/messages";
import { FurnaceTable } from "./furnace_table";
import { paintCells, Panels, type Layers } from "./panels";

const SIDE = 160,
  POOLED = 5; // what a cell of the test expects at least
const DEGREE = Math.PI / 180;

export interface Checked {
  readonly furnace?: FurnaceAnswer | undefined;
  /** null: it has no density. */
  readonly chiSquare?: ChiSquareAnswer | null;
}

const known = new Map<string, Checked>();
const MOST_KEPT = 64;

function keep(key: string, more: Checked): void {
  known.set(key, { ...known.get(key), ...more });
  if (known.size > MOST_KEPT) known.delete(known.keys().next().value!);
}

function keyOf(brdf: Brdf, state: State): string {
  return [brdf.text, state.theta, state.phi, state.samples].join("|");
}

async function check(module: WebAssembly.Module, brdf: Brdf, state: State, signal: AbortSignal): Promise<void> {
  const key = keyOf(brdf, state),
    wo = direction(-state.theta, state.phi),
    text = brdf.text;
  const queue = numbersQueue(module),
    n = Math.round(state.samples) * 20;
  if (brdf.kind !== "facet") {
    const none = { transmitted: [0, 0, 0], weak: NaN, allowedWeak: NaN, deviation: NaN, allowed: NaN };
    keep(key, { furnace: { reflected: albedoOf(brdf, state.theta, state.phi), ...none } });
    const { tables } = tableSampler(brdf);
    keep(key, { chiSquare: await queue.ask<ChiSquareAnswer>({ kind: "table-chi-square", tables, wo, n }, signal) });
    return;
  }
  keep(key, { furnace: await queue.ask<FurnaceAnswer | undefined>({ kind: "furnace", text, wo }, signal) });
  const request = { kind: "chi-square", text, wo, n } as const;
  keep(key, { chiSquare: (await queue.ask<ChiSquareAnswer | undefined>(request, signal)) ?? null });
}

function useChecks(state: State): (brdf: Brdf) => Checked {
  const { session } = useAround();
  const [, again] = useState(0);
  const brdfs = visibleEntries(state).flatMap(({ entry }) => session.resolve(entry).brdf ?? []);
  const keys = brdfs.map(brdf => keyOf(brdf, state)).join("\n");
  useEffect(() => {
    const stop = new AbortController();
    const timer = setTimeout(() => {
      for (const brdf of brdfs)
        if (known.get(keyOf(brdf, state))?.chiSquare === undefined)
          void check(session.module, brdf, state, stop.signal).then(() => again(n => n + 1));
    }, 80);
    return () => {
      clearTimeout(timer);
      stop.abort();
    };
  }, [keys]);
  return brdf => known.get(keyOf(brdf, state)) ?? {};
}

/** From the first inner border to the last, and half as far again on both sides. */
function windowOf(answer: ChiSquareAnswer): { x: [number, number]; y: [number, number] } {
  let first = Infinity,
    last = -Infinity;
  for (let band = 0; band < answer.nBands; band++) {
    first = Math.min(first, answer.azimuths[band * (SECTORS + 1) + 1]);
    last = Math.max(last, answer.azimuths[band * (SECTORS + 1) + SECTORS - 1]);
  }
  const grow = (a: number, b: number, low: number, high: number): [number, number] => [
    Math.max(a - 0.5 * (b - a), low),
    Math.min(b + 0.5 * (b - a), high),
  ];
  const theta = (k: number): number => Math.acos(answer.cosines[k]) / DEGREE;
  const most = answer.cosines[0] < 0 ? 180 : 90;
  return {
    x: grow(first / DEGREE, last / DEGREE, -180, 180),
    y: grow(theta(answer.nBands - 1), theta(1), 0, most),
  };
}

function drawHeatMap(layers: Layers, answer: ChiSquareAnswer): void {
  const { size, theme, svg } = layers;
  const box = { left: 56, top: 8, width: Math.max(60, size.width - 72), height: Math.max(60, size.height - 60) };
  const { x, y } = windowOf(answer);
  paintCells(layers, box, SIDE, (column, row) => {
    const azimuth = (x[0] + ((column + 0.5) / SIDE) * (x[1] - x[0])) * DEGREE;
    const cosine = Math.cos((y[0] + (1 - (row + 0.5) / SIDE) * (y[1] - y[0])) * DEGREE);
    const cell = cellOf(answer, cosine, azimuth),
      expected = answer.expected[cell];
    return divergingColour((answer.observed[cell] - expected) / Math.sqrt(Math.max(expected, POOLED)) / 4);
  });
  const root = clear(svg, size.width, size.height),
    quiet = { ...theme, grid: "transparent" };
  const across = scaleLinear(x, [box.left, box.left + box.width]),
    up = scaleLinear(y, [box.top + box.height, box.top]);
  drawAxis(root, "left", box, { label: "θ_i [degrees]" }, up, quiet);
  drawAxis(root, "bottom", box, { label: "φ_i from the mean direction [degrees]" }, across, quiet);
}

function drawChiSquare(layers: Layers, checked: Checked): string {
  const { chiSquare } = checked;
  if (!chiSquare) {
    layers.canvas.width = 0;
    return chiSquare === null ? "no density to test" : "testing …";
  }
  drawHeatMap(layers, chiSquare);
  const { p, level, n, degrees, statistic, isSecond } = chiSquare,
    holds = p >= level;
  const shown = p < 1e-4 ? p.toExponential(1) : p.toFixed(3);
  return `p = ${shown} ${holds ? "holds" : "FAILS"} (level ${level}${isSecond ? ", second try" : ""}); χ² = ${statistic.toFixed(0)} of ${degrees} cells, ${n} samples`;
}

export function ChecksView({ state }: { state: State }): JSX.Element {
  const checked = useChecks(state);
  return (
    <>
      <FurnaceTable state={state} checked={checked} />
      <p class="explains" data-export-text>
        Samples less what the density lets expect, from −4 (blue) to 4 (vermilion) standard deviations of each cell
      </p>
      <Panels state={state} name="chi-square" draw={(layers, brdf) => drawChiSquare(layers, checked(brdf))} />
    </>
  );
}
