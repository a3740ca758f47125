/* curve_data.ts: what each curve shows: its abscissas, its values for a material, and the names of its axes.
 *
 * SPDX-License-Identifier: MIT */
import { direction, fromHalfAngles } from "../brdf/angles";
import { newDirections, sameDirections, setDirection, type Brdf, type Directions, type Rgb } from "../brdf/brdf";
import { samplingOf } from "../brdf/sampling";
import { FacetBrdf } from "../facet/facet_brdf";
import type { Facet } from "../facet/library";
import type { Channel, Curve, State } from "../state/state";
import { counterpart, fresnelPair } from "./variants";

/** Why a material has no such curve. */
export class NoCurve extends Error {}

export interface Points {
  readonly x: Float64Array;
  readonly y: ArrayLike<number>;
}

/** Even steps, and steps that shrink towards the angles where lobes are narrow: 0.001 to 16 degrees away. */
const EVEN = 180,
  NEAR = 40;

export function curveAngles(low: number, high: number, centres: readonly number[]): Float64Array {
  const angles = Array.from({ length: EVEN + 1 }, (_, i) => low + ((high - low) * i) / EVEN);
  for (const centre of centres)
    for (let i = 0; i < NEAR; i++) {
      const away = 10 ** (-3 + (4.2 * i) / (NEAR - 1));
      for (const x of [centre - away, centre + away]) if (x > low && x < high) angles.push(x);
    }
  return Float64Array.from(angles).sort();
}

export function channelOf(channel: Channel, rgb: Rgb): Float32Array {
  if (channel === "red") return rgb.r;
  if (channel === "green") return rgb.g;
  if (channel === "blue") return rgb.b;
  return rgb.r.map((r, i) => 0.2126 * r + 0.7152 * rgb.g[i] + 0.0722 * rgb.b[i]);
}

/** Whether a curve has a value for each channel. */
export function isColoured(curve: Curve): boolean {
  return ["F", "f", "fcos", "theta-h", "theta-d"].includes(curve);
}

/** The light and the viewer of each angle: one stands at -theta, the other at the angle in a plane turned by phi2. */
export function planeDirections(state: State, angles: Float64Array): { wi: Directions; wo: Directions } {
  const moving = newDirections(angles.length);
  angles.forEach((angle, i) => setDirection(moving, i, direction(angle, state.phi + state.phi2)));
  const still = sameDirections(angles.length, direction(-state.theta, state.phi));
  return state.fixed === "viewer" ? { wi: moving, wo: still } : { wi: still, wo: moving };
}

/** f cos over cos of the light; not a number where the light grazes. */
export function withoutCosine(values: Float32Array, wi: Directions): Float64Array {
  return Float64Array.from(values, (value, i) => (Math.abs(wi.z[i]) > 1e-6 ? value / Math.abs(wi.z[i]) : NaN));
}

function inPlane(brdf: Brdf, state: State, low: number, hasCosine: boolean): Points {
  const x = curveAngles(low, -low, [0, state.theta, -state.theta]);
  const { wi, wo } = planeDirections(state, x);
  const values = channelOf(state.channel, brdf.eval(wi, wo));
  return { x, y: hasCosine ? values : withoutCosine(values, wi) };
}

function density(brdf: Brdf, state: State, low: number): Points {
  const sampling = samplingOf(brdf);
  if (sampling.isDelta) throw new NoCurve("is smooth: its samples have no density");
  const x = curveAngles(low, -low, [0, state.theta, -state.theta]);
  const { wi, wo } = planeDirections({ ...state, fixed: "viewer" }, x);
  return { x, y: sampling.pdf(wi, wo) };
}

function byHalfAngles(brdf: Brdf, state: State, isOverHalf: boolean): Points {
  const x = curveAngles(0, 90, [0]),
    wi = newDirections(x.length),
    wo = newDirections(x.length);
  x.forEach((angle, i) => {
    const pair = isOverHalf
      ? fromHalfAngles(angle, state.phi, state.thetaD, state.phiD)
      : fromHalfAngles(state.thetaH, state.phi, angle, state.phiD);
    setDirection(wi, i, pair.wi);
    setDirection(wo, i, pair.wo);
  });
  const values = withoutCosine(channelOf(state.channel, brdf.eval(wi, wo)), wi);
  return { x, y: values.map((value, i) => (wi.z[i] > 0 && wo.z[i] > 0 ? value : NaN)) };
}

function term(brdf: Brdf, state: State, name: "D" | "Lambda" | "G1"): Points {
  if (!(brdf instanceof FacetBrdf) || !brdf.hasTerms) throw new NoCurve("has no distribution of normals");
  const low = state.isPolar ? -90 : 0,
    x = curveAngles(low, 90, [0]);
  const y = Float64Array.from(x, angle => {
    const m = direction(angle, state.phi);
    if (name === "D") return brdf.D(m);
    return m[2] > 1e-9 ? brdf.terms(m)[name] : NaN;
  });
  return { x, y };
}

/** F is f over f where F is 1, of the same facets, with light and viewer on both sides of the normal. */
function fresnel(facet: Facet, brdf: Brdf, state: State): Points {
  const pair = brdf instanceof FacetBrdf && brdf.hasTerms ? fresnelPair(facet, brdf) : undefined;
  if (!pair) throw new NoCurve("has no Fresnel term that can be shown alone");
  const low = state.isPolar ? -90 : 0,
    x = curveAngles(low, 90, []).filter(angle => Math.abs(angle) < 90);
  const wi = newDirections(x.length),
    wo = newDirections(x.length);
  x.forEach((angle, i) => {
    setDirection(wi, i, direction(angle, state.phi));
    setDirection(wo, i, direction(-angle, state.phi));
  });
  const [own, white] = pair.map(one => channelOf(state.channel, one.eval(wi, wo)));
  return { x, y: Float64Array.from(own, (value, i) => value / white[i]) };
}

/** What the published masking is off the exact one. */
function maskingError(facet: Facet, brdf: Brdf, state: State): Points {
  const pair = brdf instanceof FacetBrdf ? counterpart(facet, brdf) : undefined;
  if (!pair) throw new NoCurve("has no published masking to compare with");
  const of = state.errorOf;
  const curves = pair.map(one =>
    of === "f" ? inPlane(one, state, -90, false) : term(one, { ...state, isPolar: false }, of),
  );
  return { x: curves[0].x, y: Float64Array.from(curves[0].x, (_, i) => curves[1].y[i] - curves[0].y[i]) };
}

const known = new Map<string, Points>();
const MOST_KEPT = 32;

/** Values that take no longer than a frame, made once for each material and setting. */
export function curvePoints(facet: Facet, brdf: Brdf, state: State): Points {
  const { curve, isPolar, channel, fixed, theta, phi, phi2, thetaH, thetaD, phiD, errorOf } = state;
  const key = [brdf.text, curve, isPolar, channel, fixed, theta, phi, phi2, thetaH, thetaD, phiD, errorOf].join("|");
  let points = known.get(key);
  if (!points) {
    if (known.size >= MOST_KEPT) known.delete(known.keys().next().value!);
    known.set(key, (points = computePoints(facet, brdf, state)));
  }
  return points;
}

function computePoints(facet: Facet, brdf: Brdf, state: State): Points {
  const low = brdf instanceof FacetBrdf && brdf.transmits ? -180 : -90;
  switch (state.curve) {
    case "D":
    case "Lambda":
    case "G1":
      return term(brdf, state, state.curve);
    case "F":
      return fresnel(facet, brdf, state);
    case "f":
      return inPlane(brdf, state, low, false);
    case "fcos":
      return inPlane(brdf, state, low, true);
    case "pdf":
      return density(brdf, state, low);
    case "theta-h":
      return byHalfAngles(brdf, state, true);
    case "theta-d":
      return byHalfAngles(brdf, state, false);
    case "error":
      return maskingError(facet, brdf, state);
    case "albedo":
      throw new Error("albedos are computed by a worker");
  }
}

export interface CurveNames {
  readonly title: string;
  readonly x: string;
  readonly y: string;
  readonly isPlane?: boolean;
}

const moving = (state: State): string =>
  state.fixed === "viewer"
    ? "θ_i, angle between light and normal [degrees]"
    : "θ_v, angle between viewer and normal [degrees]";

export function curveNames(state: State): CurveNames {
  const names: Record<Curve, () => CurveNames> = {
    D: () => ({
      title: "Distribution of normals",
      x: "θ_m, angle between microfacet and normal [degrees]",
      y: "D(θ_m) [1/sr]",
    }),
    Lambda: () => ({ title: "Smith's Λ", x: "θ, angle between direction and normal [degrees]", y: "Λ(θ) [1]" }),
    G1: () => ({ title: "Masking", x: "θ, angle between direction and normal [degrees]", y: "G_1(θ) [1]" }),
    F: () => ({ title: "Fresnel", x: "θ_d, angle between light and half vector [degrees]", y: "F(θ_d) [1]" }),
    f: () => ({ title: "BRDF in the plane of incidence", x: moving(state), y: "f [1/sr]", isPlane: true }),
    fcos: () => ({ title: "BRDF times cosine", x: moving(state), y: "f cos θ_i [1/sr]", isPlane: true }),
    pdf: () => ({
      title: "Density of the sampler",
      x: "θ_i, angle between light and normal [degrees]",
      y: "pdf(ω_i) [1/sr]",
      isPlane: true,
    }),
    "theta-h": () => ({
      title: "Over the half angle",
      x: "θ_h, angle between half vector and normal [degrees]",
      y: "f [1/sr]",
    }),
    "theta-d": () => ({
      title: "Over the difference angle",
      x: "θ_d, angle between light and half vector [degrees]",
      y: "f [1/sr]",
    }),
    albedo: () => ({
      title: "Directional albedo",
      x: "θ_o, angle between viewer and normal [degrees]",
      y: "albedo [1]",
    }),
    error: () => ({
      title: "Published masking less the exact one",
      isPlane: state.errorOf === "f",
      x: state.errorOf === "f" ? moving(state) : "θ, angle between direction and normal [degrees]",
      y: { G1: "error of G_1 [1]", Lambda: "error of Λ [1]", f: "error of f [1/sr]" }[state.errorOf],
    }),
  };
  return names[state.curve]();
}
