/* session.ts: what lives as long as the page: the library, files that were dropped, and where materials come from.
 *
 * SPDX-License-Identifier: MIT */
import { createContext } from "preact";
import { useContext } from "preact/hooks";
import type { Brdf } from "./brdf/brdf";
import { SpecError, type Facet } from "./facet/library";
import type { Entry } from "./state/state";
import type { Store } from "./state/store";
import type { Theme } from "./state/theme";

export type Resolved =
  { readonly brdf: Brdf; readonly problem?: undefined } | { readonly problem: string; readonly brdf?: undefined };

export class Session {
  /** By the text of their entries: "file:NAME", "fit:NAME". */
  private readonly others = new Map<string, Brdf>();
  private readonly loading = new Set<string>();
  private readonly problems = new Map<string, string>();

  constructor(
    readonly facet: Facet,
    readonly fits: readonly string[],
    readonly module: WebAssembly.Module,
    readonly store: Store,
  ) {}

  add(text: string, brdf: Brdf): void {
    this.others.set(text, brdf);
  }

  /** Fetches a material once; the page is drawn again when it is there. */
  private load(text: string, fetchIt: () => Promise<Brdf>): void {
    if (this.loading.has(text)) return;
    this.loading.add(text);
    fetchIt()
      .then(
        brdf => this.others.set(text, brdf),
        (error: Error) => this.problems.set(text, error.message),
      )
      .finally(() => this.store.slide({}));
  }

  resolve(entry: Entry): Resolved {
    const { text } = entry,
      known = this.others.get(text),
      problem = this.problems.get(text);
    if (known) return { brdf: known };
    if (problem) return { problem };
    if (text.startsWith("file:"))
      return { problem: `${text.slice(5)} is not in the address: drop the file here again` };
    if (text.startsWith("fit:")) {
      this.load(text, () => import("./brdf/fits").then(fits => fits.loadFit(text.slice(4))));
      return { problem: "loading …" };
    }
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
