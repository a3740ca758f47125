/* messages.ts: what the page asks of its workers, and what they answer.
 *
 * SPDX-License-Identifier: MIT */
import type { Tables } from "../brdf/table_sampler";

/** A worker first gets the compiled library, and where the checks are; then requests, which it answers in order. */
export interface Start {
  readonly kind: "start";
  readonly module: WebAssembly.Module;
  readonly checks: string;
}

export interface AlbedoRequest {
  readonly kind: "albedo";
  readonly text: string;
  readonly wo: readonly number[];
}
export interface AlbedoAnswer {
  readonly reflected: readonly number[];
  readonly transmitted: readonly number[];
}

export interface FurnaceRequest {
  readonly kind: "furnace";
  readonly text: string;
  readonly wo: readonly number[];
}
/** Numbers that are not defined for the material are NaN. */
export interface FurnaceAnswer extends AlbedoAnswer {
  readonly weak: number;
  readonly allowedWeak: number;
  readonly deviation: number;
  readonly allowed: number;
}

export interface ChiSquareRequest {
  readonly kind: "chi-square";
  readonly text: string;
  readonly wo: readonly number[];
  readonly n: number;
}
/** The same of a sampler by tables. */
export interface TableChiSquareRequest {
  readonly kind: "table-chi-square";
  readonly tables: Tables;
  readonly wo: readonly number[];
  readonly n: number;
}
/** Bands of cos theta_i, each cut into sectors of azimuth about `mean`; verify/sampler_density.h. */
export interface ChiSquareAnswer {
  /** Whether it is of other samples, since the first ones failed. */
  readonly isSecond?: boolean;
  readonly p: number;
  readonly statistic: number;
  readonly degrees: number;
  readonly mass: number;
  readonly lost: number;
  readonly level: number;
  readonly n: number;
  readonly mean: readonly [number, number];
  readonly nBands: number;
  readonly cosines: Float64Array;
  readonly azimuths: Float64Array;
  readonly expected: Float64Array;
  readonly observed: Float64Array;
}

export type Request = AlbedoRequest | FurnaceRequest | ChiSquareRequest | TableChiSquareRequest;

export interface Numbered {
  readonly number: number;
  readonly request: Request;
}
export interface Answer {
  readonly number: number;
  readonly result?: unknown;
  readonly error?: string;
}
