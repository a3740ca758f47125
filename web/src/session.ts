/* session.ts: what lives as long as the page: the library, files that were dropped, and where materials come from.
 *
 * SPDX-License-Identifier: MIT */
import { createContext } from "preact";
import { useContext } from "preact/hooks";
import type { Brdf } from "./brdf/brdf";
import { loadFit } from "./brdf/fits";
import { environmentMap, type Environment, type EnvironmentName } from "./brdf/environment";
import type { MaterialFile, Opened } from "./brdf/opened";
import { ShaderBrdf } from "./brdf/shader_brdf";
import { SpecError, type Facet } from "./facet/library";
import { shapeOf, type Shape, type ShapeName } from "./gl/shapes";
import { nextId, type Entry, type State } from "./state/state";
import type { Store } from "./state/store";
import type { Theme } from "./state/theme";

export type Resolved =
  { readonly brdf: Brdf; readonly problem?: undefined } | { readonly problem: string; readonly brdf?: undefined };

export class Session {
  private readonly files = new Map<string, MaterialFile>();
  private readonly lights = new Map<string, Environment>();
  private readonly shapes = new Map<string, Shape>();
  private readonly variants = new Map<string, ShaderBrdf>();
  private readonly fits = new Map<string, Resolved>();

  constructor(
    readonly facet: Facet,
    readonly module: WebAssembly.Module,
    readonly store: Store,
  ) {}

  /** Shows what was opened: a material is one more, light and objects take the place of what is there. */
  show(opened: Opened): void {
    const { store } = this,
      { state } = store;
    if (opened.is !== "material") {
      const isLight = opened.is === "light",
        text = `file:${opened.name}`,
        view = isLight && state.view === "traced" ? "traced" : "object";
      if (isLight) this.lights.set(opened.name, opened.environment);
      else this.shapes.set(opened.name, opened.shape);
      store.step(isLight ? { environment: text, view } : { object: text, view });
      store.tell();
      return;
    }
    const { brdf } = opened,
      { text } = brdf,
      id = nextId(state);
    this.files.set(brdf instanceof ShaderBrdf ? brdf.settings.model.name : brdf.name, brdf);
    this.variants.clear();
    // Dropped again: entries that wait for it find it.
    if (state.entries.some(entry => entry.text === text)) store.tell();
    else store.step({ entries: [...state.entries, { id, text, isHidden: false }], selected: id });
  }

  file(name: string): MaterialFile | undefined {
    return this.files.get(name);
  }

  /** Undefined for a file that is not there any more. */
  environment({ environment: name }: State): Environment | undefined {
    return name.startsWith("file:") ? this.lights.get(name.slice(5)) : environmentMap(name as EnvironmentName);
  }

  shape({ object: name }: State): Shape | undefined {
    return name.startsWith("file:") ? this.shapes.get(name.slice(5)) : shapeOf(name as ShapeName);
  }

  /** The choices of a menu: those made here, those that were opened, and one that is missing. */
  choices(made: readonly string[], of: "environment" | "object", state: State): (readonly [string, string])[] {
    const opened = [...(of === "environment" ? this.lights : this.shapes).keys()].map(name => `file:${name}`),
      all = [...made, ...opened];
    if (!all.includes(state[of])) all.push(state[of]);
    return all.map(name => [name, name.replace(/^file:/, "")] as const);
  }

  private resolveFile(text: string): Resolved {
    const [name, ...words] = text.split(" "),
      file = this.files.get(name);
    if (!file) return { problem: `${name} is not in the address: drop the file here again` };
    if (!(file instanceof ShaderBrdf)) return { brdf: file };
    let variant = this.variants.get(text);
    if (!variant) {
      if (this.variants.size > 64) this.variants.clear();
      this.variants.set(text, (variant = file.withWords(words)));
    }
    return { brdf: variant };
  }

  /** Fetches a fit once; the page is drawn again when it is there. */
  private resolveFit(name: string): Resolved {
    let fit = this.fits.get(name);
    if (!fit) {
      this.fits.set(name, (fit = { problem: "loading …" }));
      loadFit(name)
        .then(
          brdf => this.fits.set(name, { brdf }),
          (error: Error) => this.fits.set(name, { problem: error.message }),
        )
        .finally(() => this.store.tell());
    }
    return fit;
  }

  resolve({ text }: Entry): Resolved {
    if (text.startsWith("file:")) return this.resolveFile(text.slice(5));
    if (text.startsWith("fit:")) return this.resolveFit(text.slice(4));
    try {
      return { brdf: this.facet.prepare(text) };
    } catch (error) {
      if (error instanceof SpecError) return { problem: error.message };
      throw error;
    }
  }
}

export interface Surroundings {
  readonly session: Session;
  readonly theme: Theme;
}

export const Around = createContext<Surroundings>(null as unknown as Surroundings);

export function useAround(): Surroundings & { store: Store; facet: Facet } {
  const { session, theme } = useContext(Around);
  return { session, theme, store: session.store, facet: session.facet };
}
