/* mit.ts: anisotropic BRDFs measured at MIT (.dat), as they describe them.
 *
 * [ngan05] Ngan, Durand and Matusik, Experimental Analysis of BRDF Models, EGSR 2005.
 * 16 integers: the bins of theta_in, theta_out, phi_diff and phi_in, two others, 1 for these angles, 0 for bins of equal
 * size, another, whether phi_diff goes to pi instead of 2 pi, 3 channels, five others.  Then all bins of red, of green and
 * of blue as floats, phi_in fastest.  Negative ones were not measured.
 *
 * Files of 65 million bins are usual: they are read in pieces, kept as half floats, and neighbours in phi_in are averaged
 * until they fit.
 * SPDX-License-Identifier: MIT */
import type { MitData } from "../brdf/mit_brdf";
import { halfOf, UNMEASURED } from "../brdf/half_floats";

const HEADER = 64,
  MOST_BINS = 2 ** 24,
  PIECE = 2 ** 22; // floats

interface Header {
  readonly bins: readonly [number, number, number, number];
  readonly isHalfTurn: boolean;
}

function readHeader(name: string, size: number, bytes: ArrayBuffer): Header {
  const bad = (what: string): never => {
    throw new Error(`${name}: ${what}`);
  };
  if (bytes.byteLength < HEADER) bad(`has ${size} bytes; a .dat file of MIT has a header of ${HEADER}`);
  const view = new DataView(bytes),
    at = (k: number): number => view.getInt32(4 * k, true);
  const bins: Header["bins"] = [at(0), at(1), at(2), at(3)];
  if (!bins.every(n => n >= 1 && n <= 4096)) bad(`its sizes are ${bins.join(", ")}; they are from 1 to 4096`);
  if (at(6) !== 1) bad(`its angles are of kind ${at(6)}; theta_in, theta_out, phi_diff, phi_in, kind 1, are read`);
  if (at(7) !== 0) bad(`its bins are of kind ${at(7)}; bins of equal size, kind 0, are read`);
  if (at(9) !== 0 && at(9) !== 1) bad(`phi_diff has the range ${at(9)}; it is 0 or 1`);
  if (at(10) !== 3) bad(`has ${at(10)} channels; three are read`);
  const wanted = HEADER + 12 * bins.reduce((a, b) => a * b);
  if (size !== wanted) bad(`has ${size} bytes; with sizes ${bins.join(" x ")} it has ${wanted}`);
  return { bins, isHalfTurn: at(9) === 1 };
}

export async function readMit(name: string, file: Blob): Promise<MitData> {
  const { bins, isHalfTurn } = readHeader(name, file.size, await file.slice(0, HEADER).arrayBuffer()),
    n = bins.reduce((a, b) => a * b);
  let together = 1; // bins of phi_in that become one
  while (n / together > MOST_BINS && bins[3] % (2 * together) === 0) together *= 2;
  if (n / together > MOST_BINS) throw new Error(`${name}: has ${n} bins, which are too many; 2^24 fit`);
  const kept = n / together,
    values = new Uint16Array(3 * kept);
  let largest = -1;
  for (let channel = 0; channel < 3; channel++)
    for (let first = 0; first < n; first += PIECE) {
      // A piece is a whole number of groups, since both are powers of two.
      const count = Math.min(PIECE, n - first),
        from = HEADER + 4 * (channel * n + first),
        floats = new DataView(await file.slice(from, from + 4 * count).arrayBuffer());
      for (let i = 0; i < count; i += together) {
        let sum = 0,
          measured = 0;
        for (let k = i; k < i + together; k++) {
          const x = floats.getFloat32(4 * k, true);
          if (!(Math.abs(x) < Infinity)) throw new Error(`${name}: byte ${from + 4 * k}: the number is not finite`);
          if (x < 0) continue;
          sum += x;
          measured++;
        }
        if (measured) largest = Math.max(largest, sum / measured);
        values[3 * ((first + i) / together) + channel] = measured
          ? halfOf(Math.min(sum / measured, 65504))
          : UNMEASURED;
      }
    }
  if (largest < 0) throw new Error(`${name}: nothing in it was measured`);
  return { bins: [bins[0], bins[1], bins[2], bins[3] / together], isHalfTurn, values };
}
