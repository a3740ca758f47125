/* lobe_mesh.ts: f over all directions as the distance from a point.
 *
 * Rings around the mirror's direction, closer to each other near it, and steps around it.
 * SPDX-License-Identifier: MIT */
import { around, direction } from "../brdf/angles";
import { newDirections, sameDirections, setDirection, type Brdf, type Directions } from "../brdf/brdf";
import type { State } from "../state/state";
import { shownValue } from "../chart/axis";
import { channelOf } from "./curve_data";

const RINGS = 88,
  TURNS = 96,
  COUNT = (RINGS + 1) * (TURNS + 1);

export interface LobeMesh {
  /** Points on the surface, in units of the value. */
  readonly positions: Float32Array;
  readonly largest: number;
}

export const MESH_INDICES = new Uint16Array(RINGS * TURNS * 6);
for (let ring = 0, at = 0; ring < RINGS; ring++)
  for (let turn = 0; turn < TURNS; turn++) {
    const a = ring * (TURNS + 1) + turn,
      b = a + TURNS + 1;
    for (const i of [a, b, a + 1, a + 1, b, b + 1]) MESH_INDICES[at++] = i;
  }

let kept: { key: string; directions: Directions } | undefined;

function meshDirections(theta: number, phi: number): Directions {
  const key = `${theta},${phi}`;
  if (kept?.key === key) return kept.directions;
  const directions = newDirections(COUNT);
  for (let ring = 0, i = 0; ring <= RINGS; ring++)
    for (let turn = 0; turn <= TURNS; turn++, i++)
      setDirection(directions, i, around(theta, phi, 180 * (ring / RINGS) ** 3, (360 * (turn % TURNS)) / TURNS));
  kept = { key, directions };
  return directions;
}

export function lobeMesh(brdf: Brdf, state: State): LobeMesh {
  const moving = meshDirections(state.theta, state.phi),
    still = sameDirections(COUNT, direction(-state.theta, state.phi));
  const [wi, wo] = state.fixed === "viewer" ? [moving, still] : [still, moving];
  const values = channelOf(state.channel, brdf.eval(wi, wo)),
    positions = new Float32Array(3 * COUNT);
  let largest = 0;
  for (let i = 0; i < COUNT; i++) {
    const value = state.hasCosine ? values[i] : values[i] / Math.max(Math.abs(wi.z[i]), 1e-6);
    const length = state.scale === "linear" ? value : shownValue("shifted", value);
    largest = Math.max(largest, length);
    positions[3 * i] = length * moving.x[i];
    positions[3 * i + 1] = length * moving.y[i];
    positions[3 * i + 2] = length * moving.z[i];
  }
  return { positions, largest };
}
