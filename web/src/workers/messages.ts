/* messages.ts: what the page asks of its workers, and what they answer.
 *
 * SPDX-License-Identifier: MIT */

/** Every worker first gets the compiled module, and then requests, which it answers one after the other. */
export interface Start {
  readonly kind: "start";
  readonly module: WebAssembly.Module;
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

export type Request = AlbedoRequest;

export interface Numbered {
  readonly number: number;
  readonly request: Request;
}
export interface Answer {
  readonly number: number;
  readonly result?: unknown;
  readonly error?: string;
}
