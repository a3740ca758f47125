/* session.ts: what lives as long as the page: the library, files that were dropped, and where materials come from.
 *
 * SPDX-License-Identifier: MIT */
import { createContext } from "preact";
import { useContext } from "preact/hooks";
import type { Brdf } from "./brdf/brdf";
import { loadFit } from "./brdf/fits";
import type { Opened } from "./brdf/opened";
import { ShaderBrdf } from "./brdf/shader_brdf";
import { SpecError, type Facet } from "./facet/library";
import type { Entry } from "./state/state";
import type { Store } from "./state/store";
import type { Theme } from "./state/theme";

export type Resolved =
  { readonly brdf: Brdf; readonly problem?: undefined } | { readonly problem: string; readonly brdf?: undefined };

export class Session {
  private readonly files = new Map<string, Opened>();
  private readonly variants = new Map<string, ShaderBrdf>();
  private readonly fits = new Map<string, Resolved>();

  constructor(
    readonly facet: Facet,
    readonly module: WebAssembly.Module,
    readonly store: Store,
  ) {}

  /** The text of an entry for it: "file:NAME ...". */
  addFile(opened: Opened): string {
    const name = opened instanceof ShaderBrdf ? opened.settings.model.name : opened.name;
    this.files.set(name, opened);
    this.variants.clear();
    return opened.text;
  }

  file(name: string): Opened | undefined {
    return this.files.get(name);
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
