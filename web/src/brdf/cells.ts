/* cells.ts: the cells of a chi-square test: bands of cos theta_i, each cut into sectors of azimuth; sampler_cells of
 * verify/sampler_density.h.
 *
 * SPDX-License-Identifier: MIT */

export const BANDS = 20,
  SECTORS = 20,
  /** Of both sides, and one for what gives no sample. */
  CELLS = 2 * BANDS * SECTORS + 1;

export interface CellBorders {
  readonly nBands: number;
  readonly cosines: Float64Array;
  readonly azimuths: Float64Array;
}

/** The cell of a direction with this cosine, and this azimuth from the mean direction [rad]. */
export function cellOf({ nBands, cosines, azimuths }: CellBorders, cosine: number, azimuth: number): number {
  let band = 0,
    sector = 0;
  while (band < nBands - 1 && cosine >= cosines[band + 1]) band++;
  const first = band * (SECTORS + 1);
  while (sector < SECTORS - 1 && azimuth >= azimuths[first + sector + 1]) sector++;
  return SECTORS * band + sector;
}
