/* sampling.ts: how directions are drawn for a material: by the library, or by tables where it has nothing but values.
 *
 * SPDX-License-Identifier: MIT */
import { FacetBrdf } from "../facet/facet_brdf";
import type { Brdf, Sampling } from "./brdf";
import { tableSampler } from "./table_sampler";

export function samplingOf(brdf: Brdf): Sampling {
  return brdf instanceof FacetBrdf ? brdf : tableSampler(brdf);
}
