/* variants.ts: materials that differ from a given one in what a comparison needs.
 *
 * The names of parameters appear here because the comparisons are about them; what they may be, the library decides.
 * SPDX-License-Identifier: MIT */
import type { FacetBrdf } from "../facet/facet_brdf";
import { specText, type Facet, type Settings } from "../facet/library";

const FRESNEL = ["ks", "f82", "ior", "metal", "eta", "k"];

function without(settings: Settings, names: readonly string[]): Settings {
  return {
    ...settings,
    given: settings.given.map((is, k) => is && !names.includes(settings.model.parameters[k].name)),
  };
}

export function hasParameter(settings: Settings, name: string): boolean {
  return settings.model.parameters.some(parameter => parameter.name === name);
}

/** The same facets with their Fresnel term alone, and with none. */
export function fresnelPair(facet: Facet, brdf: FacetBrdf): [FacetBrdf, FacetBrdf] | undefined {
  const { settings } = brdf;
  if (!hasParameter(settings, "ks") || !hasParameter(settings, "kd")) return undefined;
  const own = specText(without(settings, ["kd", "energy"])) + " kd=0";
  const white = specText(without(settings, ["kd", "energy", ...FRESNEL])) + " kd=0 ks=1";
  return facet.accepts(own) && facet.accepts(white) ? [facet.prepare(own), facet.prepare(white)] : undefined;
}

/** The material with exact masking, and with that of its paper. */
export function counterpart(facet: Facet, brdf: FacetBrdf): [FacetBrdf, FacetBrdf] | undefined {
  if (!hasParameter(brdf.settings, "masking")) return undefined;
  const base = specText(without(brdf.settings, ["masking"]));
  const pair = [`${base} masking=exact`, `${base} masking=published`];
  return pair.every(text => facet.accepts(text)) ? [facet.prepare(pair[0]), facet.prepare(pair[1])] : undefined;
}
