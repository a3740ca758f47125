/* polar.ts: curves over an angle from the normal, around the point that reflects.
 *
 * SPDX-License-Identifier: MIT */
import { line } from "d3-shape";
import type { Theme } from "../state/theme";
import { fitScale, plainLabel, shownValue } from "./axis";
import { clear, type ChartSpec } from "./chart";
import { addText, type Group } from "./formula";

/** The centre in pixels, and the radius of the largest circle. */
export interface PolarDrawn {
  readonly x: number;
  readonly y: number;
  readonly radius: number;
}

const DEGREE = Math.PI / 180;

function place(drawn: PolarDrawn, angle: number, radius: number): [number, number] {
  return [drawn.x + radius * Math.sin(angle * DEGREE), drawn.y - radius * Math.cos(angle * DEGREE)];
}

function arc(drawn: PolarDrawn, radius: number, from: number, to: number): string {
  const [x1, y1] = place(drawn, from, radius),
    [x2, y2] = place(drawn, to, radius);
  if (to - from >= 360)
    return `M${drawn.x - radius},${drawn.y}a${radius},${radius} 0 1 1 ${2 * radius},0a${radius},${radius} 0 1 1 ${-2 * radius},0`;
  return `M${x1},${y1}A${radius},${radius} 0 ${to - from > 180 ? 1 : 0} 1 ${x2},${y2}`;
}

function drawGrid(to: Group, drawn: PolarDrawn, low: number, high: number, theme: Theme): void {
  for (let angle = Math.ceil(low / 30) * 30; angle <= high; angle += 30) {
    if (angle === -180) continue;
    const [x, y] = place(drawn, angle, drawn.radius),
      [tx, ty] = place(drawn, angle, drawn.radius + 14);
    to.append("line").attr("x1", drawn.x).attr("y1", drawn.y).attr("x2", x).attr("y2", y).attr("stroke", theme.grid);
    addText(to, `${plainLabel(angle)}°`, { x: tx, y: ty + 4, ink: theme.faint, anchor: "middle", size: 11.5 });
  }
}

export function drawPolar(
  svg: SVGSVGElement,
  spec: ChartSpec,
  width: number,
  height: number,
  theme: Theme,
): PolarDrawn {
  const low = spec.x.low ?? -90,
    high = spec.x.high ?? 90,
    isFull = high > 90,
    kind = spec.y.scale ?? "linear";
  const root = clear(svg, width, height),
    room = height - 92;
  const radius = Math.max(40, Math.min((width - 96) / 2, isFull ? room / 2 : room));
  const drawn: PolarDrawn = {
    x: width / 2,
    y: isFull ? 32 + room / 2 : 32 + radius + Math.max(0, (room - radius) / 2),
    radius,
  };
  const values: number[] = [];
  for (const { y } of spec.series) for (let i = 0; i < y.length; i++) values.push(shownValue(kind, y[i]));
  const scale = fitScale(spec.y, values, [0, radius]);
  drawGrid(root, drawn, low, high, theme);
  const circles =
    kind === "log"
      ? scale.ticks(4).filter(t => Number.isInteger(Math.log10(t)) || scale.ticks(4).length < 4)
      : scale.ticks(4).filter(tick => tick > 0);
  for (const tick of circles) {
    const r = scale(tick);
    if (r < 8) continue;
    root
      .append("path")
      .attr("d", arc(drawn, r, low, high))
      .attr("fill", "none")
      .attr("stroke", theme.grid);
    addText(root, plainLabel(tick), { x: drawn.x + 4, y: drawn.y - r - 3, ink: theme.faint, size: 10.5 });
  }
  root
    .append("line")
    .attr("x1", drawn.x - radius)
    .attr("x2", drawn.x + radius)
    .attr("y1", drawn.y)
    .attr("y2", drawn.y)
    .attr("stroke", theme.faint)
    .attr("stroke-opacity", 0.6);
  for (const { x, y, colour, dash } of spec.series) {
    const at = (i: number): [number, number] =>
      place(drawn, x[i], Math.max(0, Math.min(scale(shownValue(kind, y[i])), radius * 1.02)));
    const isThere = (i: number): boolean => Number.isFinite(shownValue(kind, y[i])) && x[i] >= low && x[i] <= high;
    const path = line<number>()
      .defined((_, i) => isThere(i))
      .x((_, i) => at(i)[0])
      .y((_, i) => at(i)[1]);
    root
      .append("path")
      .attr("class", "curve")
      .attr("d", path(y as ArrayLike<number> & Iterable<number>))
      .attr("fill", "none")
      .attr("stroke", colour)
      .attr("stroke-width", 2)
      .attr("stroke-linejoin", "round")
      .attr("stroke-dasharray", dash || null);
  }
  for (const mark of spec.marks ?? []) {
    const [x, y] = place(drawn, mark.x, radius),
      [tx, ty] = place(drawn, mark.x, radius + 30);
    root
      .append("line")
      .attr("x1", drawn.x)
      .attr("y1", drawn.y)
      .attr("x2", x)
      .attr("y2", y)
      .attr("stroke", mark.colour)
      .attr("stroke-dasharray", "2 4");
    root
      .append("circle")
      .attr("cx", x)
      .attr("cy", y)
      .attr("r", 5)
      .attr("fill", theme.page)
      .attr("stroke", mark.colour)
      .attr("stroke-width", 2);
    addText(root, mark.label, { x: tx, y: ty + 4, ink: mark.colour, anchor: "middle", size: 12 });
  }
  addText(root, `radius: ${spec.y.label}`, {
    x: drawn.x,
    y: height - 30,
    ink: theme.ink,
    anchor: "middle",
    size: 12.5,
  });
  addText(root, `angle: ${spec.x.label}`, { x: drawn.x, y: height - 10, ink: theme.ink, anchor: "middle", size: 12.5 });
  return drawn;
}
