/* chart.ts: curves in Cartesian coordinates, as SVG.
 *
 * Colours and fonts are attributes, not styles, so that what is exported looks like what is seen.
 * SPDX-License-Identifier: MIT */
import { select } from "d3-selection";
import { line } from "d3-shape";
import type { Theme } from "../state/theme";
import { drawAxis, fitScale, shownValue, type AxisSpec, type Box, type Numeric } from "./axis";
import { addText, type Group } from "./formula";

export interface Series {
  readonly label: string;
  readonly colour: string;
  readonly dash: string;
  readonly x: ArrayLike<number>;
  readonly y: ArrayLike<number>;
  /** A thinner, dashed line that goes with another one. */
  readonly isSecond?: boolean;
}

/** A vertical line at x with a name, e.g. of a direction. */
export interface Mark {
  readonly x: number;
  readonly label: string;
  readonly colour: string;
}

export interface ChartSpec {
  readonly x: AxisSpec;
  readonly y: AxisSpec;
  readonly series: readonly Series[];
  readonly marks?: readonly Mark[];
}

/** Where the chart drew, for the pointer. */
export interface Drawn {
  readonly box: Box;
  readonly x: Numeric;
  readonly y: Numeric;
}

export function clear(svg: SVGSVGElement, width: number, height: number): Group {
  const root = select(svg).attr("viewBox", `0 0 ${width} ${height}`).attr("width", width).attr("height", height);
  root.selectAll("*").remove();
  return root.append("g") as unknown as Group;
}

function* shownValues(spec: ChartSpec): Generator<number> {
  for (const { y } of spec.series) for (let i = 0; i < y.length; i++) yield shownValue(spec.y.scale ?? "linear", y[i]);
}

function addMarks(to: Group, spec: ChartSpec, drawn: Drawn): void {
  for (const mark of spec.marks ?? []) {
    const x = drawn.x(mark.x),
      { top, height } = drawn.box;
    to.append("line")
      .attr("x1", x)
      .attr("x2", x)
      .attr("y1", top)
      .attr("y2", top + height)
      .attr("stroke", mark.colour)
      .attr("stroke-width", 1)
      .attr("stroke-dasharray", "2 4");
    addText(to, mark.label, { x, y: top - 6, ink: mark.colour, anchor: "middle", size: 12 });
  }
}

let n_clips = 0;

export function drawChart(svg: SVGSVGElement, spec: ChartSpec, width: number, height: number, theme: Theme): Drawn {
  const box = { left: 66, top: 26, width: width - 66 - 22, height: height - 26 - 52 };
  const root = clear(svg, width, height),
    kind = spec.y.scale ?? "linear";
  const x = fitScale(spec.x, [], [box.left, box.left + box.width]);
  const y = fitScale(spec.y, shownValues(spec), [box.top + box.height, box.top]);
  const drawn = { box, x, y };
  drawAxis(root, "bottom", box, spec.x, x, theme);
  drawAxis(root, "left", box, spec.y, y, theme);
  const clip = `clip-${++n_clips}`;
  root
    .append("clipPath")
    .attr("id", clip)
    .append("rect")
    .attr("x", box.left)
    .attr("y", box.top - 2)
    .attr("width", box.width)
    .attr("height", box.height + 4);
  const inside = root.append("g").attr("clip-path", `url(#${clip})`);
  for (const { x: xs, y: ys, colour, dash, isSecond } of spec.series) {
    const path = line<number>()
      .defined((_, i) => Number.isFinite(shownValue(kind, ys[i])))
      .x((_, i) => x(xs[i]))
      .y((_, i) => y(shownValue(kind, ys[i])));
    inside
      .append("path")
      .attr("class", "curve")
      .attr("d", path(ys as ArrayLike<number> & Iterable<number>))
      .attr("fill", "none")
      .attr("stroke", colour)
      .attr("stroke-width", isSecond ? 1.4 : 2)
      .attr("stroke-linejoin", "round")
      .attr("stroke-dasharray", dash || null);
  }
  addMarks(root, spec, drawn);
  return drawn;
}
