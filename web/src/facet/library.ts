/* library.ts: libfacet for the page: specs become materials, and materials are evaluated.
 *
 * SPDX-License-Identifier: MIT */
import { FacetBrdf } from "./facet_brdf";
import { Memory, type FacetExports } from "./memory";
import { readModels, type Model, type Parameter } from "./table";

/** Why the library refuses a spec: the place inside it, and what is wrong. */
export class SpecError extends Error {
  constructor(
    readonly place: string,
    readonly why: string,
  ) {
    super(place ? `${place}: ${why}` : why);
  }
}

/** A parsed spec: a model and a value for each of its parameters, and which of them the spec gives. */
export interface Settings {
  readonly model: Model;
  readonly values: readonly (readonly number[])[];
  readonly given: readonly boolean[];
}

// Sizes and offsets of the structs of facet.h, for 32-bit pointers.
const MATERIAL_BYTES = 592,
  MATERIAL_VALUES = 16,
  ERROR_BYTES = 324,
  ERROR_PLACE = 4,
  ERROR_TEXT = 100;
const MOST_KEPT = 48;

export class Facet {
  readonly memory: Memory;
  readonly models: readonly Model[];
  private readonly material: number;
  private readonly why: number;
  private readonly kept = new Map<string, FacetBrdf>();

  constructor(readonly exports: FacetExports) {
    exports._initialize();
    this.memory = new Memory(exports);
    this.models = readModels(exports, this.memory);
    this.material = this.memory.allocate(MATERIAL_BYTES);
    this.why = this.memory.allocate(ERROR_BYTES);
  }

  get version(): string {
    return this.memory.text(this.exports.facet_version());
  }

  model(name: string): Model | undefined {
    return this.models.find(model => model.name === name);
  }

  private fail(): never {
    throw new SpecError(this.memory.text(this.why + ERROR_PLACE), this.memory.text(this.why + ERROR_TEXT));
  }

  private read(text: string): void {
    const status = this.memory.withText(text, at => this.exports.facet_material_parse(at, this.material, this.why));
    if (status) this.fail();
  }

  /** The spec's settings; SpecError if the library refuses it. */
  parse(text: string): Settings {
    this.read(text);
    const [, index, bits] = this.memory.u32(this.material, 3);
    const model = this.models[index];
    const values = this.memory.f64(this.material + MATERIAL_VALUES, 3 * model.parameters.length);
    return {
      model,
      values: model.parameters.map((_, k) => Array.from(values.subarray(3 * k, 3 * k + 3))),
      given: model.parameters.map((_, k) => ((bits >>> k) & 1) === 1),
    };
  }

  /** Whether the library takes the spec, whole. */
  accepts(text: string): boolean {
    try {
      this.prepare(text);
      return true;
    } catch (error) {
      if (error instanceof SpecError) return false;
      throw error;
    }
  }

  /** Parses again a spec that is known to be right, for `use`. */
  prepareDouble(text: string, use: (material: number) => number): void {
    this.read(text);
    if (use(this.material)) this.fail();
  }

  /** The prepared material; the last ones asked for are kept.  SpecError if the library refuses it. */
  prepare(text: string): FacetBrdf {
    let brdf = this.kept.get(text);
    if (brdf) this.kept.delete(text);
    else {
      this.read(text);
      brdf = new FacetBrdf(this, text, this.parse(text), this.material, this.why, () => this.fail());
    }
    this.kept.set(text, brdf);
    for (const [oldest, unused] of this.kept) {
      if (this.kept.size <= MOST_KEPT) break;
      unused.release();
      this.kept.delete(oldest);
    }
    return brdf;
  }
}

/** Numbers as people write them: as few digits as give the same double, without a leading "0." for short ones. */
export function numberText(value: number): string {
  return String(Number(value.toPrecision(12)));
}

export function valueText(parameter: Parameter, values: readonly number[]): string {
  if (parameter.kind === "choice") return parameter.choices[values[0]];
  const isGrey = values[0] === values[1] && values[1] === values[2];
  if (parameter.kind === "number" || isGrey) return numberText(values[0]);
  return values.map(numberText).join(",");
}

/** The spec of settings: the parameters that are given, in the table's order. */
export function specText(settings: Settings): string {
  const parts = settings.model.parameters.flatMap((parameter, k) =>
    settings.given[k] ? [`${parameter.name}=${valueText(parameter, settings.values[k])}`] : [],
  );
  return [settings.model.name, ...parts].join(" ");
}

/** Compiled once, and shared with the workers. */
export function instantiate(module: WebAssembly.Module): Facet {
  return new Facet(new WebAssembly.Instance(module, {}).exports as FacetExports);
}
