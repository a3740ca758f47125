/* formula.ts: names with subscripts, "θ_i" or "G_1", as SVG text.
 *
 * SPDX-License-Identifier: MIT */
import { select, type Selection } from "d3-selection";

export type Group = Selection<SVGGElement, unknown, null, undefined>;

export const FONT = "Inter, 'Segoe UI', system-ui, -apple-system, 'Helvetica Neue', 'DejaVu Sans', sans-serif";

/** Parts of the text, and which of them stand low: "_" before a letter or digit, or a group in braces. */
export function formulaParts(text: string): { text: string; isLow: boolean }[] {
  return text
    .split(/(_\{[^}]*\}|_[A-Za-z0-9])/)
    .filter(Boolean)
    .map(part =>
      part.startsWith("_") ? { text: part.replace(/[_{}]/g, ""), isLow: true } : { text: part, isLow: false },
    );
}

export function writeFormula(node: SVGTextElement, text: string): void {
  const to = select(node);
  to.text(null);
  let isLow = false;
  for (const part of formulaParts(text)) {
    const span = to.append("tspan").text(part.text);
    if (part.isLow) span.attr("font-size", "72%").attr("dy", "0.28em");
    else if (isLow) span.attr("dy", "-0.2em");
    isLow = part.isLow;
  }
}

export interface TextStyle {
  readonly x: number;
  readonly y: number;
  readonly ink: string;
  readonly size?: number;
  readonly anchor?: "start" | "middle" | "end";
  readonly turn?: number;
  readonly weight?: number;
}

export function addText(to: Group, text: string, style: TextStyle): void {
  const node = to
    .append("text")
    .attr("transform", `translate(${style.x},${style.y})` + (style.turn ? ` rotate(${style.turn})` : ""))
    .attr("fill", style.ink)
    .attr("font-size", style.size ?? 12)
    .attr("font-family", FONT)
    .attr("text-anchor", style.anchor ?? "start");
  if (style.weight) node.attr("font-weight", style.weight);
  writeFormula(node.node()!, text);
}
