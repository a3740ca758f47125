/* axis.ts: scales that fit their data, and axes with names, units and a quiet grid.
 *
 * SPDX-License-Identifier: MIT */
import { axisBottom, axisLeft, type AxisScale } from "d3-axis";
import { scaleLinear, scaleLog, type ScaleContinuousNumeric } from "d3-scale";
import type { Scale } from "../state/state";
import type { Theme } from "../state/theme";
import { addText, FONT, type Group } from "./formula";

export type Numeric = ScaleContinuousNumeric<number, number>;

export interface AxisSpec {
  readonly label: string;
  readonly low?: number;
  readonly high?: number;
  readonly scale?: Scale;
  /** Grid lines at these values instead of round ones. */
  readonly ticks?: readonly number[];
  /** What is written at the ticks, if not their values. */
  readonly names?: readonly string[];
  /** Where the name of a left axis stands. */
  readonly labelAt?: number;
}

export interface Box {
  readonly left: number;
  readonly top: number;
  readonly width: number;
  readonly height: number;
}

/** Decades that a logarithmic axis shows at most, unless it is told. */
const MOST_DECADES = 8;

/** What is drawn for a value. */
export function shownValue(scale: Scale, y: number): number {
  return scale === "shifted" ? Math.log10(1 + Math.max(y, 0)) : scale === "log" && !(y > 0) ? NaN : y;
}

function extent(values: Iterable<number>): [number, number] {
  let low = Infinity,
    high = -Infinity;
  for (const value of values) {
    if (!Number.isFinite(value)) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  return [low, high];
}

/** The range of an axis: what it is given, or what holds the values, with 0 on linear axes. */
export function fitScale(axis: AxisSpec, values: Iterable<number>, range: [number, number]): Numeric {
  let [low, high] = extent(values);
  if (!(low <= high)) [low, high] = axis.scale === "log" ? [0.1, 10] : [0, 1];
  if (axis.scale === "log") {
    const top = axis.high ?? 10 ** Math.ceil(Math.log10(high) - 1e-9);
    const bottom = axis.low ?? Math.max(10 ** Math.floor(Math.log10(low)), top / 10 ** MOST_DECADES);
    return scaleLog()
      .domain([bottom < top ? bottom : top / 10, top])
      .range(range)
      .clamp(false);
  }
  low = axis.low ?? Math.min(low, 0);
  high = axis.high ?? Math.max(high, 0);
  if (!(low < high)) high = low + 1;
  const scale = scaleLinear().domain([low, high]).range(range);
  return axis.high === undefined ? scale.nice(6) : scale;
}

const SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹";
function power(exponent: number): string {
  return (
    "10" + (exponent < 0 ? "⁻" : "") + String(Math.abs(exponent)).replace(/\d/g, digit => SUPERSCRIPTS[Number(digit)])
  );
}

function logTicks(scale: Numeric): number[] {
  const [low, high] = scale.domain().map(Math.log10);
  const step = Math.max(1, Math.ceil((high - low) / 7));
  const ticks: number[] = [];
  for (let e = Math.ceil(low - 1e-9); e <= high + 1e-9; e += step) ticks.push(10 ** e);
  return ticks.length > 1 ? ticks : scale.ticks(4);
}

function logLabel(value: number): string {
  const exponent = Math.log10(value);
  if (Math.abs(exponent - Math.round(exponent)) > 1e-9) return String(Number(value.toPrecision(3)));
  return exponent >= -2 && exponent <= 3 ? String(Number(value.toPrecision(3))) : power(Math.round(exponent));
}

export function plainLabel(value: number): string {
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e5)) {
    const exponent = Math.floor(Math.log10(size) + 1e-12),
      digits = Number((value / 10 ** exponent).toPrecision(3));
    return (digits === 1 ? "" : digits === -1 ? "−" : String(digits).replace("-", "−") + "·") + power(exponent);
  }
  return String(Number(value.toPrecision(6))).replace("-", "−");
}

/** An axis on the left or at the bottom of the box, its grid across the box, and its name. */
export function drawAxis(
  to: Group,
  side: "left" | "bottom",
  box: Box,
  axis: AxisSpec,
  scale: Numeric,
  theme: Theme,
): void {
  const isLog = axis.scale === "log",
    isLeft = side === "left";
  const ticks =
    axis.ticks?.slice() ?? (isLog ? logTicks(scale) : scale.ticks(isLeft ? box.height / 48 : box.width / 80));
  const make = (isLeft ? axisLeft : axisBottom)(scale as AxisScale<number>)
    .tickValues(ticks)
    .tickFormat((value, i) => axis.names?.[i] ?? (isLog ? logLabel(Number(value)) : plainLabel(Number(value))))
    .tickSizeInner(isLeft ? -box.width : -box.height)
    .tickSizeOuter(0)
    .tickPadding(7);
  const group = to
    .append("g")
    .attr("transform", isLeft ? `translate(${box.left},0)` : `translate(0,${box.top + box.height})`)
    .call(make);
  group.attr("font-family", FONT).attr("font-size", 11.5).attr("color", theme.faint);
  group.selectAll(".tick line").attr("stroke", theme.grid).attr("shape-rendering", "crispEdges");
  group
    .selectAll(".domain")
    .attr("stroke", theme.faint)
    .attr("stroke-opacity", isLeft ? 0 : 0.6);
  const place = isLeft
    ? { x: axis.labelAt ?? 14, y: box.top + box.height / 2, turn: -90 }
    : { x: box.left + box.width / 2, y: box.top + box.height + 36 };
  // On a phone, the symbol and the unit.
  const label = box.width < 400 && !isLeft ? axis.label.replace(/, [^[]*(?=\[)/, " ") : axis.label;
  addText(to, label, { ...place, ink: theme.ink, anchor: "middle", size: 12.5 });
}
