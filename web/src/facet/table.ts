/* table.ts: the library's own table of models and parameters, read from its memory.
 *
 * The layout is that of facet.h's facet_model_info and facet_parameter for 32-bit pointers; whatever the page knows of
 * a model's parameters it knows from here.
 * SPDX-License-Identifier: MIT */
import type { FacetExports, Memory } from "./memory";

export type ParameterKind = "number" | "colour" | "choice";

export interface Parameter {
  readonly name: string;
  readonly kind: ParameterKind;
  readonly low: number;
  readonly high: number;
  readonly initial: readonly [number, number, number];
  readonly unit: string;
  readonly choices: readonly string[];
  readonly description: string;
}

export interface Model {
  readonly name: string;
  readonly summary: string;
  readonly source: string;
  readonly parameters: readonly Parameter[];
}

const KINDS: readonly ParameterKind[] = ["number", "colour", "choice"];
const PARAMETER_BYTES = 64;

function readParameter(memory: Memory, at: number): Parameter {
  const head = memory.u32(at, 2),
    tail = memory.u32(at + 48, 3),
    numbers = memory.f64(at + 8, 5);
  return {
    name: memory.text(head[0]),
    kind: KINDS[head[1]],
    low: numbers[0],
    high: numbers[1],
    initial: [numbers[2], numbers[3], numbers[4]],
    unit: memory.text(tail[0]),
    choices: tail[1] ? memory.text(tail[1]).split("|") : [],
    description: memory.text(tail[2]),
  };
}

export function readModels(facet: FacetExports, memory: Memory): Model[] {
  return Array.from({ length: facet.facet_model_count() }, (_, i) => {
    const info = memory.u32(facet.facet_model_get(i), 5);
    return {
      name: memory.text(info[0]),
      summary: memory.text(info[1]),
      source: memory.text(info[2]),
      parameters: Array.from({ length: info[3] }, (_, k) => readParameter(memory, info[4] + k * PARAMETER_BYTES)),
    };
  });
}
