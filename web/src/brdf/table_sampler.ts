/* table_sampler.ts: a sampler for what has nothing but values: files, measurements and their fits.
 *
 * For some angles of the viewer (and azimuths, where these matter) a table says how much light comes from each cell around
 * the mirror's direction: rings, whose angles are cubes as lobes are narrow there, cut into sectors.  A cell is drawn by
 * what it gives, and a direction evenly over its solid angle.  Between two angles of the viewer both tables are used, by a
 * coin; one direction in eight has the density of the cosine, so that nothing that the tables miss is too rare.  The
 * density is that of this very mixture.  gl/table_glsl.ts is the same for shaders.
 * SPDX-License-Identifier: MIT */
import { DEGREE, direction } from "./angles";
import { newDirections, sameDirections, setDirection, type Brdf, type Directions, type Sampling } from "./brdf";

export const RINGS = 64,
  SECTORS = 64,
  EVEN = 0.125,
  LAST_THETA = 89; // degrees
const LAYER = 2 * SECTORS * (RINGS + 1);

export interface Tables {
  /** Angles of the viewer from 0 to LAST_THETA, and azimuths of the mirror's direction from 0 on. */
  readonly nThetas: number;
  readonly nAzimuths: number;
  /** A layer for each azimuth and theta: for each ring and sector the sum of the probabilities along the ring up to and
   *  with the sector, and the density in it, 1/sr; last a row with the sums over the rings. */
  readonly texels: Float32Array;
}

/** 1 - cos of the angle where a ring begins, which keeps all digits where the angle is small. */
export function versine(ring: number): number {
  return 2 * Math.sin((Math.PI / 2) * (ring / RINGS) ** 3) ** 2;
}

const EDGES = Float64Array.from({ length: RINGS + 1 }, (_, ring) => versine(ring));

/** The mirror's direction, and two across it: away from the normal, and around it. */
interface Frame {
  readonly along: readonly number[];
  readonly side: readonly number[];
  readonly axis: readonly number[];
}

function frameOf(x: number, y: number, z: number): Frame {
  const s = Math.hypot(x, y),
    c = s > 1e-6 ? -x / s : 1,
    d = s > 1e-6 ? -y / s : 0;
  return { along: [c * z, d * z, -s], side: [-d, c, 0], axis: [c * s, d * s, z] };
}

function inFrame({ along, side, axis }: Frame, v: number, turn: number): [number, number, number] {
  const sine = Math.sqrt(Math.max(0, v * (2 - v))),
    a = sine * Math.cos(turn),
    b = sine * Math.sin(turn),
    c = 1 - v;
  return [0, 1, 2].map(k => a * along[k] + b * side[k] + c * axis[k]) as [number, number, number];
}

/** The cell of a direction: 2 (SECTORS ring + sector). */
function cellOf({ along, side, axis }: Frame, x: number, y: number, z: number): number {
  const v = ((x - axis[0]) ** 2 + (y - axis[1]) ** 2 + (z - axis[2]) ** 2) / 2,
    angle = 2 * Math.asin(Math.sqrt(Math.min(1, v / 2))),
    turn = Math.atan2(x * side[0] + y * side[1], x * along[0] + y * along[1] + z * along[2]) / (2 * Math.PI);
  const ring = Math.min(RINGS - 1, Math.floor(RINGS * Math.cbrt(angle / Math.PI))),
    sector = Math.min(SECTORS - 1, Math.floor(SECTORS * (turn - Math.floor(turn))));
  return 2 * (SECTORS * ring + sector);
}

/** The first of n entries, `stride` apart, that is above u, and where u is between the one before and it. */
function search(sums: Float32Array, first: number, n: number, u: number): { at: number; rest: number } {
  let at = 0;
  for (let step = n / 2; step >= 1; step /= 2) if (sums[first + 2 * (at + step - 1)] <= u) at += step;
  const below = at ? sums[first + 2 * (at - 1)] : 0,
    width = sums[first + 2 * at] - below;
  return { at, rest: width > 0 ? Math.min(1, Math.max(0, (u - below) / width)) : 0.5 };
}

export class TableSampler implements Sampling {
  readonly isDelta = false;

  constructor(readonly tables: Tables) {}

  /** The first of the two layers for a viewer, and the share of the second one. */
  private layerOf(x: number, y: number, z: number): { layer: number; part: number } {
    const { nThetas, nAzimuths } = this.tables,
      s = Math.hypot(x, y),
      at = Math.min(nThetas - 1, (Math.atan2(s, z) / (LAST_THETA * DEGREE)) * (nThetas - 1)),
      k = Math.min(Math.floor(at), nThetas - 2);
    const turn = s > 1e-6 ? Math.atan2(-y, -x) / (2 * Math.PI) : 0,
      j = Math.floor((turn - Math.floor(turn)) * nAzimuths + 0.5) % nAzimuths;
    return { layer: (j * nThetas + k) * LAYER, part: at - k };
  }

  private density(frame: Frame, layer: number, part: number, x: number, y: number, z: number): number {
    if (z <= 0) return 0;
    const { texels } = this.tables,
      at = layer + cellOf(frame, x, y, z) + 1;
    return (EVEN * z) / Math.PI + (1 - EVEN) * ((1 - part) * texels[at] + part * texels[at + LAYER]);
  }

  pdf(wi: Directions, wo: Directions): Float32Array {
    return Float32Array.from(wi.x, (x, i) => {
      if (!(wo.z[i] > 0)) return 0;
      const { layer, part } = this.layerOf(wo.x[i], wo.y[i], wo.z[i]);
      return this.density(frameOf(wo.x[i], wo.y[i], wo.z[i]), layer, part, x, wi.y[i], wi.z[i]);
    });
  }

  /** Directions and their densities, 0 where there is none: those that end below the horizon. */
  sample(wo: Directions, u: Directions): { wi: Directions; pdf: Float32Array } {
    const n = wo.x.length,
      wi = newDirections(n),
      { texels } = this.tables;
    for (let i = 0; i < n; i++) {
      const [ux, uy, uz] = [u.x[i], u.y[i], u.z[i]];
      if (uz < EVEN) {
        const s = Math.sqrt(ux),
          phi = 2 * Math.PI * uy;
        setDirection(wi, i, [s * Math.cos(phi), s * Math.sin(phi), Math.sqrt(1 - ux)]);
        continue;
      }
      const { layer, part } = this.layerOf(wo.x[i], wo.y[i], wo.z[i]),
        chosen = layer + ((uz - EVEN) / (1 - EVEN) < part ? LAYER : 0);
      const ring = search(texels, chosen + 2 * SECTORS * RINGS, RINGS, ux),
        sector = search(texels, chosen + 2 * SECTORS * ring.at, SECTORS, uy);
      const v = EDGES[ring.at] + ring.rest * (EDGES[ring.at + 1] - EDGES[ring.at]),
        turn = (2 * Math.PI * (sector.at + sector.rest)) / SECTORS;
      setDirection(wi, i, inFrame(frameOf(wo.x[i], wo.y[i], wo.z[i]), v, turn));
    }
    return { wi, pdf: this.pdf(wi, wo) };
  }
}

const finite = (x: number): number => (x > 0 && x < Infinity ? x : 0);
const total = ({ r, g, b }: ReturnType<Brdf["eval"]>, i: number): number => finite(r[i]) + finite(g[i]) + finite(b[i]);

/** Whether the values stay when both directions are turned about the normal, for some pairs. */
function isIsotropic(brdf: Brdf): boolean {
  const n = 96,
    [wi, wo, turnedWi, turnedWo] = [0, 1, 2, 3].map(() => newDirections(n));
  for (let i = 0; i < n; i++) {
    const [a, b, phi, turn] = [0.8191725134, 0.6710436068, 0.5497004779, 0.4503].map(step => ((i + 0.5) * step) % 1);
    setDirection(wo, i, direction(85 * a, 0));
    setDirection(turnedWo, i, direction(85 * a, 360 * turn));
    // Half of them near the mirror's direction.
    const theta = i % 2 ? 85 * b : Math.min(88, Math.abs(85 * a + 10 * (b - 0.5)));
    const azimuth = i % 2 ? 360 * phi : 180 + 20 * (phi - 0.5);
    setDirection(wi, i, direction(theta, azimuth));
    setDirection(turnedWi, i, direction(theta, azimuth + 360 * turn));
  }
  const [straight, turned] = [brdf.eval(wi, wo), brdf.eval(turnedWi, turnedWo)];
  for (let i = 0; i < n; i++) {
    const [f, g] = [total(straight, i), total(turned, i)];
    if (Math.abs(f - g) > 0.02 * Math.max(f, g) + 1e-4) return false;
  }
  return true;
}

/** Probabilities of the cells into a layer, from what each gives. */
function fillLayer(to: Float32Array, gives: Float64Array): void {
  let all = gives.reduce((a, b) => a + b, 0);
  const areas = EDGES.map((edge, ring) => ((2 * Math.PI) / SECTORS) * ((EDGES[ring + 1] ?? edge) - edge));
  if (!(all > 0)) {
    // Black: all directions alike.
    gives.forEach((_, i) => (gives[i] = areas[Math.floor(i / SECTORS)]));
    all = 4 * Math.PI;
  }
  let sum = 0;
  for (let ring = 0; ring < RINGS; ring++) {
    const cells = gives.subarray(SECTORS * ring, SECTORS * (ring + 1)),
      here = cells.reduce((a, b) => a + b, 0);
    let along = 0;
    for (let sector = 0; sector < SECTORS; sector++) {
      along += cells[sector];
      to[2 * (SECTORS * ring + sector)] = here > 0 ? along / here : (sector + 1) / SECTORS;
      to[2 * (SECTORS * ring + sector) + 1] = cells[sector] / (all * areas[ring]);
    }
    sum += here;
    to[2 * (SECTORS * RINGS + ring)] = sum / all;
  }
}

const MOST_AT_ONCE = 2 ** 18;

export function makeTables(brdf: Brdf): Tables {
  const isSame = isIsotropic(brdf),
    nThetas = isSame ? 20 : 12,
    nAzimuths = isSame ? 1 : 16,
    // Where a cell's value is looked up: once, or twice where there are few.
    within = isSame ? [0.25, 0.75] : [0.5],
    // An isotropic one is the same on both sides of the plane of incidence.
    nSectors = isSame ? SECTORS / 2 : SECTORS;
  const nLayers = nThetas * nAzimuths,
    each = RINGS * within.length * nSectors,
    texels = new Float32Array(LAYER * nLayers);
  const atOnce = Math.max(1, Math.floor(MOST_AT_ONCE / each));
  for (let first = 0; first < nLayers; first += atOnce) {
    const count = Math.min(atOnce, nLayers - first),
      wi = newDirections(count * each),
      wo = newDirections(count * each);
    for (let l = 0, i = 0; l < count; l++) {
      // Not at the normal itself, where there is no azimuth.
      const theta = Math.max(0.01, ((first + l) % nThetas) * (LAST_THETA / (nThetas - 1))),
        phi = Math.floor((first + l) / nThetas) * (360 / nAzimuths),
        viewer = direction(-theta, phi),
        frame = frameOf(viewer[0], viewer[1], viewer[2]);
      const same = sameDirections(each, viewer);
      for (const axis of ["x", "y", "z"] as const) wo[axis].set(same[axis], l * each);
      for (let ring = 0; ring < RINGS; ring++)
        for (const inside of within)
          for (let sector = 0; sector < nSectors; sector++, i++)
            setDirection(wi, i, inFrame(frame, versine(ring + inside), (2 * Math.PI * (sector + 0.5)) / SECTORS));
    }
    const values = brdf.eval(wi, wo);
    for (let l = 0; l < count; l++) {
      const gives = new Float64Array(RINGS * SECTORS);
      for (let k = 0, i = l * each; k < each; k++, i++) {
        if (!(wi.z[i] > 0)) continue;
        const ring = Math.floor(k / (within.length * nSectors)),
          sector = k % nSectors,
          give = total(values, i) * (EDGES[ring + 1] - EDGES[ring]);
        gives[SECTORS * ring + sector] += give;
        if (isSame) gives[SECTORS * ring + SECTORS - 1 - sector] += give;
      }
      fillLayer(texels.subarray((first + l) * LAYER, (first + l + 1) * LAYER), gives);
    }
  }
  return { nThetas, nAzimuths, texels };
}

const made = new Map<Brdf, TableSampler>();
const MOST_KEPT = 8;

/** The tables of a material, made when they are first wanted; those of the last ones are kept. */
export function tableSampler(brdf: Brdf): TableSampler {
  let sampler = made.get(brdf);
  if (!sampler) {
    made.set(brdf, (sampler = new TableSampler(makeTables(brdf))));
    if (made.size > MOST_KEPT) made.delete(made.keys().next().value!);
  }
  return sampler;
}
