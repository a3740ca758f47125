/* facet_brdf.ts: one prepared material of the library.
 *
 * SPDX-License-Identifier: MIT */
import type { Brdf, Directions, Rgb } from "../brdf/brdf";
import type { Facet, Settings } from "./library";

/** The bits of facet_bsdf_lobes. */
export const LOBE = { reflection: 1, transmission: 2, diffuse: 4, glossy: 8, delta: 16 } as const;

export interface Terms {
  readonly D: number;
  readonly Lambda: number;
  readonly G1: number;
}

export interface Samples {
  readonly wi: Directions;
  readonly pdf: Float32Array;
  readonly weight: Rgb;
}

const BSDF_BYTES = 640,
  BSDF64_BYTES = 2560;

/** Room for a batch: `n_arrays` of `n` floats, and the structs of pointers that C wants. */
class Scratch {
  private arrays = 0;
  private room = 0;
  private readonly structs: number;
  private readonly one: number;

  constructor(private readonly facet: Facet) {
    this.structs = facet.memory.allocate(4 * 16);
    this.one = facet.memory.allocate(256);
  }

  /** 16 arrays of n floats; one struct of 16 pointers, of which any part is a facet_dirs, _rgb or _samples. */
  batch(n: number): { array: (k: number) => number; struct: (k: number) => number } {
    if (n > this.room) {
      if (this.arrays) this.facet.memory.free(this.arrays);
      this.room = Math.max(1024, 2 ** Math.ceil(Math.log2(n)));
      this.arrays = this.facet.memory.allocate(16 * 4 * this.room);
      this.facet.memory.u32(this.structs, 16).forEach((_, k, all) => (all[k] = this.arrays + 4 * this.room * k));
    }
    return { array: k => this.arrays + 4 * this.room * k, struct: k => this.structs + 4 * k };
  }

  get small(): number {
    return this.one;
  }
}

const scratches = new WeakMap<Facet, Scratch>();
function scratchOf(facet: Facet): Scratch {
  let scratch = scratches.get(facet);
  if (!scratch) scratches.set(facet, (scratch = new Scratch(facet)));
  return scratch;
}

export class FacetBrdf implements Brdf {
  readonly kind = "facet";
  readonly lobes: number;
  /** Whether it has a distribution of normals. */
  readonly hasTerms: boolean;
  private readonly bsdf: number;
  private bsdf64 = 0;
  private readonly scratch: Scratch;

  /** `material` is the library's copy of the spec, which is read now. */
  constructor(
    private readonly facet: Facet,
    readonly text: string,
    readonly settings: Settings,
    material: number,
    why: number,
    fail: () => never,
  ) {
    const { memory, exports } = facet;
    this.bsdf = memory.allocate(BSDF_BYTES);
    if (exports.facet_bsdf_prepare(material, this.bsdf, why)) {
      memory.free(this.bsdf);
      fail();
    }
    this.scratch = scratchOf(facet);
    this.lobes = exports.facet_bsdf_lobes(this.bsdf);
    this.hasTerms = this.D([0, 0, 1]) > 0;
  }

  release(): void {
    this.facet.memory.free(this.bsdf);
    if (this.bsdf64) this.facet.memory.free(this.bsdf64);
  }

  get label(): string {
    return this.text;
  }

  get transmits(): boolean {
    return (this.lobes & LOBE.transmission) !== 0;
  }

  get isDelta(): boolean {
    return (this.lobes & LOBE.delta) !== 0;
  }

  get kernel(): string {
    return this.facet.memory.text(this.facet.exports.facet_bsdf_kernel(this.bsdf));
  }

  /** What the shader's MODEL_load takes: `n` words, 0 past the last. */
  words(n: number): Uint32Array {
    const at = this.facet.memory.allocate(4 * n);
    this.facet.exports.facet_bsdf_words(this.bsdf, n, at);
    const words = this.facet.memory.u32(at, n).slice();
    this.facet.memory.free(at);
    return words;
  }

  eval(wi: Directions, wo: Directions): Rgb {
    const n = wi.x.length,
      { array, struct } = this.load(n, wi, wo);
    this.facet.exports.facet_bsdf_eval_batch(this.bsdf, n, struct(0), struct(3), struct(6));
    const copy = (k: number): Float32Array => this.facet.memory.f32(array(k), n).slice();
    return { r: copy(6), g: copy(7), b: copy(8) };
  }

  pdf(wi: Directions, wo: Directions): Float32Array {
    const n = wi.x.length,
      { array, struct } = this.load(n, wi, wo);
    this.facet.exports.facet_bsdf_pdf_batch(this.bsdf, n, struct(0), struct(3), array(6));
    return this.facet.memory.f32(array(6), n).slice();
  }

  sample(wo: Directions, u: Directions): Samples {
    const n = wo.x.length,
      { array, struct } = this.load(n, wo, u);
    this.facet.exports.facet_bsdf_sample_batch(this.bsdf, n, struct(0), struct(3), struct(6));
    const copy = (k: number): Float32Array => this.facet.memory.f32(array(k), n).slice();
    return {
      wi: { x: copy(6), y: copy(7), z: copy(8) },
      pdf: copy(9),
      weight: { r: copy(10), g: copy(11), b: copy(12) },
    };
  }

  terms(m: readonly number[]): Terms {
    const at = this.scratch.small,
      { memory, exports } = this.facet;
    memory.f32(at + 16, 3).set(m);
    exports.facet_bsdf_terms(at, this.bsdf, at + 16);
    const [D, Lambda, G1] = memory.f32(at, 3);
    return { D, Lambda, G1 };
  }

  /** D alone, where Lambda takes long. */
  D(m: readonly number[]): number {
    const at = this.scratch.small,
      { memory, exports } = this.facet;
    memory.f32(at, 3).set(m);
    return exports.facet_bsdf_D(this.bsdf, at);
  }

  /** The directional albedo, of reflection and of what goes through. */
  albedo(wo: readonly number[]): { reflected: number[]; transmitted: number[] } {
    const at = this.scratch.small,
      { memory, exports } = this.facet;
    memory.f64(at, 3).set(wo);
    exports.facet_bsdf64_albedo(this.double(), at, at + 32, at + 64, 0);
    return { reflected: Array.from(memory.f64(at + 32, 3)), transmitted: Array.from(memory.f64(at + 64, 3)) };
  }

  /** Both arguments of a batch, in arrays 0 to 2 and 3 to 5. */
  private load(n: number, a: Directions, b: Directions): ReturnType<Scratch["batch"]> {
    const batch = this.scratch.batch(n);
    [a.x, a.y, a.z, b.x, b.y, b.z].forEach((values, k) => this.facet.memory.f32(batch.array(k), n).set(values));
    return batch;
  }

  private double(): number {
    if (!this.bsdf64) {
      const { memory, exports } = this.facet;
      this.bsdf64 = memory.allocate(BSDF64_BYTES);
      this.facet.prepareDouble(this.text, material => exports.facet_bsdf64_prepare(material, this.bsdf64, 0));
    }
    return this.bsdf64;
  }
}
