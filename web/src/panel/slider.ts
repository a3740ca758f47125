/* slider.ts: where a value stands on its slider, by the range in the library's table.
 *
 * SPDX-License-Identifier: MIT */

export interface Range {
  readonly low: number;
  readonly high: number;
}

export const STEPS = 1000;

/** Ranges over two decades and more are logarithmic, from 0 on by log(1 + x). */
function kindOf({ low, high }: Range): "linear" | "log" | "log1p" {
  if (low > 0 && high / low >= 100) return "log";
  return low === 0 && high >= 1000 ? "log1p" : "linear";
}

export function toSlider(range: Range, value: number): number {
  const { low, high } = range,
    x = Math.min(Math.max(value, low), high),
    kind = kindOf(range);
  const t =
    kind === "log"
      ? Math.log(x / low) / Math.log(high / low)
      : kind === "log1p"
        ? Math.log1p(x) / Math.log1p(high)
        : (x - low) / (high - low);
  return Math.round(STEPS * t);
}

/** Three digits are enough for a hand; the ends are exact. */
export function fromSlider(range: Range, step: number): number {
  const { low, high } = range,
    t = step / STEPS,
    kind = kindOf(range);
  if (step <= 0) return low;
  if (step >= STEPS) return high;
  const value =
    kind === "log"
      ? low * (high / low) ** t
      : kind === "log1p"
        ? Math.expm1(t * Math.log1p(high))
        : low + t * (high - low);
  const rounded =
    kind === "linear"
      ? Number(value.toFixed(Math.max(0, 3 - Math.floor(Math.log10(high - low)))))
      : Number(value.toPrecision(3));
  return Math.min(Math.max(rounded, low), high);
}
