/* samples.tsx: directions that the sampler draws, seen from above, over their density.
 *
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import { direction } from "../brdf/angles";
import { newDirections, sameDirections, setDirection, type Brdf, type Sampling } from "../brdf/brdf";
import { samplingOf } from "../brdf/sampling";
import { plainLabel } from "../chart/axis";
import { clear } from "../chart/chart";
import { addText, type Group } from "../chart/formula";
import type { State } from "../state/state";
import { sequentialColour } from "../state/theme";
import { paintCells, Panels, type Layers } from "./panels";

const SIDE = 160,
  DECADES = 4;

/** The same numbers for every picture: the points move, they do not jump (mulberry32). */
function uniforms(n: number): Float32Array {
  let state = 2024;
  return Float32Array.from({ length: n }, () => {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 8) * 2 ** -24;
  });
}

function drawDisc(root: Group, x: number, y: number, radius: number, layers: Layers): void {
  const { theme } = layers,
    ink = "rgba(255,255,255,0.35)";
  for (const angle of [30, 60])
    root
      .append("circle")
      .attr("cx", x)
      .attr("cy", y)
      .attr("r", radius * Math.sin((angle * Math.PI) / 180))
      .attr("fill", "none")
      .attr("stroke", ink);
  root.append("circle").attr("cx", x).attr("cy", y).attr("r", radius).attr("fill", "none").attr("stroke", theme.faint);
  for (const angle of [30, 60, 90])
    addText(root, `${angle}°`, {
      // Inside the two rings, and outside the last one.
      x: x + radius * Math.sin((angle * Math.PI) / 180) * Math.SQRT1_2 + (angle === 90 ? 3 : -4),
      y: y + radius * Math.sin((angle * Math.PI) / 180) * Math.SQRT1_2 + (angle === 90 ? 10 : 0),
      anchor: angle === 90 ? "start" : "end",
      ink: angle === 90 ? theme.faint : "#ffffff",
      size: 10.5,
    });
}

/** The density over the disc, on a logarithmic scale of four decades; its largest value. */
function paintDensity(layers: Layers, sampling: Sampling, wo: readonly number[], box: DOMRect, page: number[]): number {
  const wi = newDirections(SIDE * SIDE);
  for (let row = 0; row < SIDE; row++)
    for (let column = 0; column < SIDE; column++) {
      const x = (2 * (column + 0.5)) / SIDE - 1,
        y = 1 - (2 * (row + 0.5)) / SIDE,
        rest = 1 - x * x - y * y;
      setDirection(wi, row * SIDE + column, rest > 0 ? [x, y, Math.sqrt(rest)] : [0, 0, -1]);
    }
  const pdf = sampling.pdf(wi, sameDirections(SIDE * SIDE, wo));
  const most = pdf.reduce((a, b) => Math.max(a, b), 0);
  paintCells(layers, box, SIDE, (column, row) => {
    const i = row * SIDE + column;
    if (wi.z[i] < 0) return page;
    return sequentialColour(pdf[i] > 0 ? 1 + Math.log10(pdf[i] / most) / DECADES : 0);
  });
  return most;
}

function drawSamples(layers: Layers, brdf: Brdf, state: State): string {
  const { size, theme, svg } = layers,
    root = clear(svg, size.width, size.height);
  const radius = Math.max(30, Math.min(size.width, size.height) / 2 - 14),
    x = size.width / 2,
    y = size.height / 2;
  const sampling = samplingOf(brdf),
    wo = direction(-state.theta, state.phi),
    n = Math.round(state.samples);
  const page = theme.name === "dark" ? [21, 24, 28] : [255, 255, 255];
  const box = new DOMRect(x - radius, y - radius, 2 * radius, 2 * radius);
  const most = sampling.isDelta ? 0 : paintDensity(layers, sampling, wo, box, page);
  drawDisc(root, x, y, radius, layers);
  const u = uniforms(3 * n),
    { wi, pdf } = sampling.sample(sameDirections(n, wo), {
      x: u.subarray(0, n),
      y: u.subarray(n, 2 * n),
      z: u.subarray(2 * n),
    });
  let above = "",
    below = "",
    lost = 0,
    nBelow = 0;
  for (let i = 0; i < n; i++) {
    if (!(pdf[i] > 0)) lost++;
    else {
      const dot = `M${(x + radius * wi.x[i]).toFixed(1)},${(y - radius * wi.y[i]).toFixed(1)}h0`;
      if (wi.z[i] > 0) above += dot;
      else {
        below += dot;
        nBelow++;
      }
    }
  }
  for (const [path, ink] of [
    [above, "#ffffff"],
    [below, "#f0b429"],
  ])
    root
      .append("path")
      .attr("class", "samples")
      .attr("d", path || null)
      .attr("stroke", ink)
      .attr("stroke-width", 2.2)
      .attr("stroke-linecap", "round")
      .attr("stroke-opacity", 0.75);
  const view = [x + radius * wo[0], y - radius * wo[1]];
  root
    .append("circle")
    .attr("cx", view[0])
    .attr("cy", view[1])
    .attr("r", 5)
    .attr("fill", theme.page)
    .attr("stroke", theme.lines[1])
    .attr("stroke-width", 2);
  addText(root, "ω_o", { x: view[0], y: view[1] - 10, ink: "#ffffff", anchor: "middle", weight: 600 });
  const density = sampling.isDelta
    ? "mirror directions"
    : `density up to ${plainLabel(Number(most.toPrecision(3)))}/sr`;
  return `${density}, ${n} samples, ${lost} give none${nBelow ? `, ${nBelow} go through (orange)` : ""}`;
}

export function Samples({ state }: { state: State }): JSX.Element {
  return <Panels state={state} name="samples" draw={(layers, brdf) => drawSamples(layers, brdf, state)} />;
}
