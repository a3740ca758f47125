/* checks.ts: facet_checks.wasm: the checks of `facet verify` for one direction of view; verify/wasm/wasm_checks.c.
 *
 * SPDX-License-Identifier: MIT */
import type { ChiSquareAnswer, FurnaceAnswer } from "../workers/messages";
import { BANDS, CELLS, SECTORS } from "../brdf/cells";
import { Memory, type Heap } from "./memory";

interface ChecksExports extends Heap {
  _initialize(): void;
  checks_furnace(text: number, wo: number, numbers: number): number;
  checks_chi_square(text: number, wo: number, n: number, seed: number, result: number): number;
}

const RESULT = 9 + (2 * BANDS + 1) + 2 * BANDS * (SECTORS + 1) + 2 * CELLS;

export class Checks {
  private readonly memory: Memory;
  private readonly room: number;

  constructor(private readonly exports: ChecksExports) {
    exports._initialize();
    this.memory = new Memory(exports);
    this.room = this.memory.allocate(8 * (RESULT + 16));
  }

  static async load(url: string): Promise<Checks> {
    const bytes = await (await fetch(url)).arrayBuffer();
    const { instance } = await WebAssembly.instantiate(bytes, {});
    return new Checks(instance.exports as unknown as ChecksExports);
  }

  private call(text: string, wo: readonly number[], n: number, use: (text: number, wo: number, to: number) => number) {
    const at = this.room + 8 * 16;
    this.memory.f64(this.room, 3).set(wo);
    const status = this.memory.withText(text, name => use(name, this.room, at));
    return status ? undefined : this.memory.f64(at, n).slice();
  }

  furnace(text: string, wo: readonly number[]): FurnaceAnswer | undefined {
    const all = this.call(text, wo, 10, (name, v, to) => this.exports.checks_furnace(name, v, to));
    if (!all) return undefined;
    const [weak, allowedWeak, deviation, allowed] = all.subarray(6);
    return {
      reflected: [...all.subarray(0, 3)],
      transmitted: [...all.subarray(3, 6)],
      weak,
      allowedWeak,
      deviation,
      allowed,
    };
  }

  /** Undefined for what has no density. */
  chiSquare(text: string, wo: readonly number[], n: number, seed: number): ChiSquareAnswer | undefined {
    const all = this.call(text, wo, RESULT, (name, v, to) => this.exports.checks_chi_square(name, v, n, seed, to));
    if (!all) return undefined;
    const [p, statistic, degrees, mass, lost, level, meanX, meanY, nBands] = all;
    let at = 9;
    const next = (count: number): Float64Array => all.slice(at, (at += count));
    return {
      ...{ p, statistic, degrees, mass, lost, level, n, mean: [meanX, meanY], nBands },
      cosines: next(2 * BANDS + 1),
      azimuths: next(2 * BANDS * (SECTORS + 1)),
      expected: next(CELLS),
      observed: next(CELLS),
    };
  }
}
