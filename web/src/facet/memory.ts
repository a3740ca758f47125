/* memory.ts: facet.wasm's memory, as numbers and text.
 *
 * Pointers are offsets.  Memory may grow at any malloc, which detaches every view: views are made anew each time.
 * SPDX-License-Identifier: MIT */

/** What every module of ours has. */
export interface Heap extends WebAssembly.Exports {
  memory: WebAssembly.Memory;
  malloc(bytes: number): number;
  free(at: number): void;
}

/** What facet.wasm exports, as far as the page uses it; include/facet/facet.h is the reference.  A struct that C
 *  returns is written to an offset given first. */
export interface FacetExports extends Heap {
  _initialize(): void;
  facet_version(): number;
  facet_model_count(): number;
  facet_model_get(i: number): number;
  facet_material_defaults(name: number, material: number, why: number): number;
  facet_material_parse(text: number, material: number, why: number): number;
  facet_bsdf_prepare(material: number, bsdf: number, why: number): number;
  facet_bsdf64_prepare(material: number, bsdf: number, why: number): number;
  facet_bsdf_words(bsdf: number, n: number, words: number): number;
  facet_bsdf_kernel(bsdf: number): number;
  facet_bsdf_lobes(bsdf: number): number;
  facet_bsdf_eval(bsdf: number, wi: number, wo: number, f: number): void;
  facet_bsdf_pdf(bsdf: number, wi: number, wo: number): number;
  facet_bsdf_sample(result: number, bsdf: number, wo: number, u: number): void;
  facet_bsdf_terms(result: number, bsdf: number, m: number): void;
  facet_bsdf_D(bsdf: number, m: number): number;
  facet_bsdf64_albedo(bsdf: number, wo: number, reflected: number, transmitted: number, error: number): number;
  facet_bsdf_eval_batch(bsdf: number, n: number, wi: number, wo: number, f: number): void;
  facet_bsdf_pdf_batch(bsdf: number, n: number, wi: number, wo: number, pdf: number): void;
  facet_bsdf_sample_batch(bsdf: number, n: number, wo: number, u: number, samples: number): void;
}

export class Memory {
  constructor(private readonly facet: Heap) {}

  allocate(bytes: number): number {
    const at = this.facet.malloc(bytes);
    if (at === 0) throw new Error("facet.wasm is out of memory");
    return at;
  }

  free(at: number): void {
    this.facet.free(at);
  }

  f32(at: number, n: number): Float32Array {
    return new Float32Array(this.facet.memory.buffer, at, n);
  }

  f64(at: number, n: number): Float64Array {
    return new Float64Array(this.facet.memory.buffer, at, n);
  }

  u32(at: number, n: number): Uint32Array {
    return new Uint32Array(this.facet.memory.buffer, at, n);
  }

  /** A C string; "" for NULL. */
  text(at: number): string {
    if (at === 0) return "";
    const bytes = new Uint8Array(this.facet.memory.buffer, at);
    return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
  }

  /** Calls `use` with the offset of a copy of `text`. */
  withText<T>(text: string, use: (at: number) => T): T {
    const bytes = new TextEncoder().encode(text + "\0");
    const at = this.allocate(bytes.length);
    try {
      new Uint8Array(this.facet.memory.buffer, at, bytes.length).set(bytes);
      return use(at);
    } finally {
      this.free(at);
    }
  }
}
