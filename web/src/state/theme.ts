/* theme.ts: light and dark, and colours that are told apart by those who confuse some of them.
 *
 * The lines have the colours of `facet plot` (Okabe and Ito, Color Universal Design, 2008), the maps are its arcs in
 * Oklab (Ottosson, 2020); plot/palette.c.
 * SPDX-License-Identifier: MIT */

export interface Theme {
  readonly name: "light" | "dark";
  readonly page: string;
  readonly ink: string;
  readonly faint: string;
  readonly grid: string;
  readonly lines: readonly string[];
}

const LINES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#1a1a1a", "#56b4e9"];

export const LIGHT: Theme = {
  name: "light",
  page: "#ffffff",
  ink: "#22262b",
  faint: "#5c6670",
  grid: "#e6e9ed",
  lines: LINES,
};

/* On a dark page the blue is lighter, and what is black there is white here. */
export const DARK: Theme = {
  name: "dark",
  page: "#15181c",
  ink: "#e8eaed",
  faint: "#9aa4af",
  grid: "#2a2f36",
  lines: ["#4aa8e0", "#f07f2e", "#1fbf91", "#e08fbd", "#f0b429", "#f2f2f2", "#8fd0f5"],
};

export const DASHES = ["", "7 3", "2 3", "9 3 2 3", "12 4", "5 2 1 2 1 2", "3 5"];

export function lineColour(theme: Theme, place: number): string {
  return theme.lines[place % theme.lines.length];
}

function encode(linear: number): number {
  const x = Math.min(Math.max(linear, 0), 1);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
}

/** sRGB, 0 to 255, of a lightness, a chroma and a hue in degrees. */
function fromOklab(lightness: number, chroma: number, hue: number): [number, number, number] {
  const angle = (hue * Math.PI) / 180,
    a = chroma * Math.cos(angle),
    b = chroma * Math.sin(angle);
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ].map(x => Math.round(255 * encode(x))) as [number, number, number];
}

/** From dark violet to light green, t in [0,1]. */
export function sequentialColour(t: number): [number, number, number] {
  const x = Math.min(Math.max(t, 0), 1);
  return fromOklab(0.28 + 0.66 * x, 0.1 + 0.07 * x, 305 - 200 * x);
}

/** Blue below 0, vermilion above, t in [-1,1]. */
export function divergingColour(t: number): [number, number, number] {
  const strength = Math.min(Math.abs(t), 1);
  return fromOklab(0.98 - 0.53 * strength, 0.14 * strength, t < 0 ? 255 : 45);
}

export function cssColour(rgb: readonly number[]): string {
  return `rgb(${rgb.join(",")})`;
}
