/* url.ts: the state as the part of the address behind '#', so that a link, a reload and going back keep it.
 *
 * What has its default is left out: #m=ggx+alpha%3D.1&m=-lambert&view=lobe; '-' before a hidden material.
 * SPDX-License-Identifier: MIT */
import { numberText } from "../facet/library";
import {
  CHANNELS,
  CURVES,
  DEFAULTS,
  ENVIRONMENTS,
  ERROR_TERMS,
  FIXED,
  OBJECTS,
  SAMPLINGS,
  SCALES,
  VIEWS,
  type Entry,
  type State,
} from "./state";

/** The name in the address, the name in State, and its values: a list, a list and files, a range, or a truth value. */
type Values = readonly string[] | { names: readonly string[] } | { low: number; high: number } | "flag";
type Rule = readonly [string, keyof State, Values];

const angle = (low: number, high: number): { low: number; high: number } => ({ low, high });
const RULES: readonly Rule[] = [
  ["view", "view", VIEWS],
  ["of", "curve", CURVES],
  ["scale", "scale", SCALES],
  ["polar", "isPolar", "flag"],
  ["channel", "channel", CHANNELS],
  ["fixed", "fixed", FIXED],
  ["theta", "theta", angle(0, 89.9)],
  ["phi", "phi", angle(0, 360)],
  ["theta2", "theta2", angle(-180, 180)],
  ["phi2", "phi2", angle(-180, 180)],
  ["theta_h", "thetaH", angle(0, 90)],
  ["theta_d", "thetaD", angle(0, 90)],
  ["phi_d", "phiD", angle(0, 180)],
  ["square", "hasSquareThetaH", "flag"],
  ["chroma", "hasChroma", "flag"],
  ["cosine", "hasCosine", "flag"],
  ["exposure", "exposure", angle(-6, 6)],
  ["n", "samples", angle(100, 100000)],
  ["error", "errorOf", ERROR_TERMS],
  ["light_theta", "lightTheta", angle(0, 180)],
  ["light_phi", "lightPhi", angle(-360, 360)],
  ["double", "isDoubled", "flag"],
  ["environment", "environment", { names: ENVIRONMENTS }],
  ["object", "object", { names: OBJECTS }],
  ["sampling", "sampling", SAMPLINGS],
  ["turn", "turn", angle(-360, 360)],
  ["tilt", "tilt", angle(-90, 90)],
];

export function stateToHash(state: State): string {
  const query = new URLSearchParams();
  for (const entry of state.entries) query.append("m", (entry.isHidden ? "-" : "") + entry.text);
  const place = (id: number): number => state.entries.findIndex(entry => entry.id === id) + 1;
  if (place(state.selected) > 1) query.set("selected", String(place(state.selected)));
  if (state.solo) query.set("solo", String(place(state.solo)));
  for (const [name, key, values] of RULES) {
    const value = state[key];
    if (value === DEFAULTS[key]) continue;
    query.set(
      name,
      values === "flag" ? (value ? "1" : "0") : typeof value === "number" ? numberText(value) : String(value),
    );
  }
  return "#" + query.toString();
}

function readValue(values: Values, text: string): unknown {
  if (values === "flag") return text === "1";
  if ("names" in values) return values.names.includes(text) || /^file:./.test(text) ? text : undefined;
  if ("low" in values) {
    const number = Number(text);
    return text.trim() && Number.isFinite(number) ? Math.min(Math.max(number, values.low), values.high) : undefined;
  }
  return values.includes(text) ? text : undefined;
}

/** The state of an address; whatever it does not say, or says wrongly, has its default. */
export function stateFromHash(hash: string): State {
  const query = new URLSearchParams(hash.replace(/^#/, ""));
  const state: Record<string, unknown> = { ...DEFAULTS };
  for (const [name, key, values] of RULES) {
    const text = query.get(name);
    const value = text === null ? undefined : readValue(values, text);
    if (value !== undefined) state[key] = value;
  }
  const texts = query.getAll("m");
  const entries: Entry[] = texts.map((text, i) => ({
    id: i + 1,
    text: text.replace(/^-/, ""),
    isHidden: text.startsWith("-"),
  }));
  if (entries.length) state.entries = entries;
  const n = (state.entries as Entry[]).length;
  for (const key of ["selected", "solo"]) {
    const place = Number(query.get(key));
    if (Number.isInteger(place) && place >= 1 && place <= n) state[key] = place;
  }
  return state as unknown as State;
}
