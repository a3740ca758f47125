/* state.ts: all that the page shows, as one value; url.ts writes it into the address.
 *
 * SPDX-License-Identifier: MIT */

/** One material of the list.  `text` is a spec of the library, "fit:NAME", or "file:NAME" of a dropped file. */
export interface Entry {
  readonly id: number;
  readonly text: string;
  readonly isHidden: boolean;
}

export const VIEWS = ["curves", "lobe", "slice", "samples", "checks", "sphere", "object", "traced"] as const;
export type View = (typeof VIEWS)[number];

export const CURVES = ["D", "Lambda", "G1", "F", "f", "fcos", "pdf", "theta-h", "theta-d", "albedo", "error"] as const;
export type Curve = (typeof CURVES)[number];

/** "shifted": log10(1 + y), as Disney's BRDF Explorer has it, which shows 0. */
export const SCALES = ["linear", "log", "shifted"] as const;
export type Scale = (typeof SCALES)[number];

/** "colours": red, green and blue at once, as curves in these colours. */
export const CHANNELS = ["luminance", "red", "green", "blue", "colours"] as const;
export type Channel = (typeof CHANNELS)[number];

/** Which of the two directions stands still in the views; the other one is the abscissa. */
export const FIXED = ["viewer", "light"] as const;

export const ERROR_TERMS = ["G1", "Lambda", "f"] as const;
export const ENVIRONMENTS = ["studio", "sky", "furnace", "spots"] as const;
/** How directions are drawn under light from all around: by the light, by the material, or by both (weighted). */
export const SAMPLINGS = ["both", "light", "material"] as const;
export const OBJECTS = ["ball", "torus", "knot", "vase"] as const;

/** Angles in degrees. */
export interface State {
  readonly entries: readonly Entry[];
  readonly selected: number;
  /** The id of the one material to see, or 0. */
  readonly solo: number;
  readonly view: View;
  readonly curve: Curve;
  readonly scale: Scale;
  readonly isPolar: boolean;
  readonly channel: Channel;
  readonly fixed: (typeof FIXED)[number];
  /** Of the fixed direction, and the azimuth of its plane. */
  readonly theta: number;
  readonly phi: number;
  /** Of the other direction, against that plane. */
  readonly theta2: number;
  readonly phi2: number;
  readonly thetaH: number;
  readonly thetaD: number;
  readonly phiD: number;
  readonly hasSquareThetaH: boolean;
  readonly hasChroma: boolean;
  readonly hasCosine: boolean;
  readonly exposure: number;
  readonly samples: number;
  readonly errorOf: (typeof ERROR_TERMS)[number];
  /** Towards the light of the lit sphere. */
  readonly lightTheta: number;
  readonly lightPhi: number;
  readonly isDoubled: boolean;
  /** One of ENVIRONMENTS and OBJECTS, or "file:NAME" of a dropped file. */
  readonly environment: string;
  readonly object: string;
  readonly sampling: (typeof SAMPLINGS)[number];
  readonly turn: number;
  readonly tilt: number;
}

const FIRST = ["gtr alpha=.1 gamma=.5", "gtr alpha=.1 gamma=1.5", "ggx alpha=.1"];

export const DEFAULTS: State = {
  entries: FIRST.map((text, i) => ({ id: i + 1, text, isHidden: false })),
  selected: 1,
  solo: 0,
  view: "curves",
  curve: "D",
  scale: "log",
  isPolar: false,
  channel: "luminance",
  fixed: "viewer",
  theta: 45,
  phi: 0,
  theta2: 45,
  phi2: 0,
  thetaH: 0,
  thetaD: 0,
  phiD: 90,
  hasSquareThetaH: false,
  hasChroma: false,
  hasCosine: true,
  exposure: 0,
  samples: 1000,
  errorOf: "G1",
  lightTheta: 40,
  lightPhi: 45,
  isDoubled: false,
  environment: "studio",
  object: "ball",
  sampling: "both",
  turn: 30,
  tilt: 20,
};

/** The entries to be seen, each with its place in the list, which gives its colour. */
export function visibleEntries(state: State): { entry: Entry; place: number }[] {
  return state.entries
    .map((entry, place) => ({ entry, place }))
    .filter(({ entry }) => (state.solo ? entry.id === state.solo : !entry.isHidden));
}

export function selectedEntry(state: State): Entry | undefined {
  return state.entries.find(entry => entry.id === state.selected) ?? state.entries[0];
}

export function nextId(state: State): number {
  return Math.max(0, ...state.entries.map(entry => entry.id)) + 1;
}
