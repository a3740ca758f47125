/* slice.tsx: the image slice of Disney's BRDF Explorer: f over theta_h and theta_d, as colours.
 *
 * Burley, Physically Based Shading at Disney, 2012, section 3.
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import { scaleLinear } from "d3-scale";
import { fromHalfAngles } from "../brdf/angles";
import { newDirections, setDirection, type Brdf, type Directions } from "../brdf/brdf";
import { drawAxis } from "../chart/axis";
import { clear } from "../chart/chart";
import type { State } from "../state/state";
import { paintCells, Panels, type Layers } from "./panels";

const SIDE = 128;

let kept: { key: string; wi: Directions; wo: Directions } | undefined;

/** The directions of all cells, which differ little from one picture to the next. */
function cellDirections(state: State): { wi: Directions; wo: Directions } {
  const key = [state.phi, state.phiD, state.hasSquareThetaH].join();
  if (kept?.key === key) return kept;
  const wi = newDirections(SIDE * SIDE),
    wo = newDirections(SIDE * SIDE);
  for (let row = 0; row < SIDE; row++)
    for (let column = 0; column < SIDE; column++) {
      const x = (column + 0.5) / SIDE,
        thetaH = 90 * (state.hasSquareThetaH ? x * x : x),
        thetaD = 90 * (1 - (row + 0.5) / SIDE);
      const pair = fromHalfAngles(thetaH, state.phi, thetaD, state.phiD);
      setDirection(wi, row * SIDE + column, pair.wi);
      setDirection(wo, row * SIDE + column, pair.wo);
    }
  kept = { key, wi, wo };
  return kept;
}

function byteOf(value: number): number {
  return Math.round(255 * Math.min(Math.max(value, 0), 1) ** (1 / 2.2));
}

function drawSlice(layers: Layers, brdf: Brdf, state: State): string {
  const { size, theme } = layers,
    side = Math.max(60, Math.min(size.width - 62, size.height - 58));
  const box = { left: 52 + Math.max(0, (size.width - 62 - side) / 2), top: 8, width: side, height: side };
  const { wi, wo } = cellDirections(state),
    { r, g, b } = brdf.eval(wi, wo),
    scale = 2 ** state.exposure;
  const isAbove = (i: number): boolean => wi.z[i] > 0 && wo.z[i] > 0;
  const grey = theme.name === "dark" ? [52, 58, 66] : [214, 218, 223];
  paintCells(layers, box, SIDE, (column, row) => {
    const i = row * SIDE + column;
    if (!isAbove(i)) return grey;
    const most = Math.max(r[i], g[i], b[i]),
      factor = state.hasChroma ? (most > 0 ? 1 / most : 0) : scale / wi.z[i];
    return [byteOf(r[i] * factor), byteOf(g[i] * factor), byteOf(b[i] * factor)];
  });
  const root = clear(layers.svg, size.width, size.height),
    quiet = { ...theme, grid: "transparent" },
    ticks = [0, 30, 60, 90];
  const warp = (angle: number): number => (state.hasSquareThetaH ? Math.sqrt(angle / 90) : angle / 90);
  const x = scaleLinear([0, 1], [box.left, box.left + side]),
    y = scaleLinear([0, 90], [box.top + side, box.top]);
  drawAxis(root, "left", box, { label: "θ_d [degrees]", ticks, labelAt: box.left - 38 }, y, quiet);
  drawAxis(root, "bottom", box, { label: "θ_h [degrees]", ticks: ticks.map(warp), names: ticks.map(String) }, x, quiet);
  return "";
}

export function Slice({ state }: { state: State }): JSX.Element {
  return <Panels state={state} name="slice" draw={(layers, brdf) => drawSlice(layers, brdf, state)} />;
}
