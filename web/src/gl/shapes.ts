/* shapes.ts: objects to light, as grids over two parameters; z is up, and the largest extent about 1.
 *
 * SPDX-License-Identifier: MIT */
import { cross, normalised, type Vector } from "../brdf/angles";
import type { OBJECTS } from "../state/state";

export type ShapeName = (typeof OBJECTS)[number];

export interface Shape {
  readonly position: Float32Array;
  readonly normal: Float32Array;
  /** Along the first parameter: the direction x of the material. */
  readonly tangent: Float32Array;
  readonly indices: Uint32Array;
}

/** A point for u and v in [0,1]; the derivative by u crossed with that by v points outwards. */
type Surface = (u: number, v: number) => Vector;

const TURN = 2 * Math.PI;

/** A closed curve as thick as `radius`. */
function tube(curve: (t: number) => Vector, radius: number): Surface {
  return (u, v) => {
    const h = 1e-4,
      c = curve(u),
      ahead = curve(u + h),
      behind = curve(u - h);
    const along = normalised([0, 1, 2].map(k => ahead[k] - behind[k])),
      side = normalised(cross(along, [c[0], c[1], 0.3])),
      other = cross(along, side);
    const x = Math.cos(TURN * v) * radius,
      y = Math.sin(TURN * v) * radius;
    return [0, 1, 2].map(k => c[k] + x * side[k] + y * other[k]) as Vector;
  };
}

/** The outline of the vase: radius and height along it. */
function outline(v: number): [number, number] {
  const z = -0.95 + 1.9 * v,
    body = 0.46 * Math.exp(-(((z + 0.28) / 0.52) ** 2)),
    lip = 0.2 * Math.exp(-(((z - 1.02) / 0.2) ** 2));
  return [(0.17 + body + lip) * Math.min(1, Math.sqrt(v / 0.03 + 1e-6)), z];
}

const SURFACES: Record<ShapeName, { surface: Surface; nu: number; nv: number }> = {
  ball: {
    surface: (u, v) => {
      const phi = TURN * u,
        theta = Math.PI * (1 - v),
        s = Math.sin(theta);
      return [s * Math.cos(phi), s * Math.sin(phi), Math.cos(theta)];
    },
    nu: 128,
    nv: 64,
  },
  torus: { surface: tube(t => [0.68 * Math.cos(TURN * t), 0.68 * Math.sin(TURN * t), 0], 0.31), nu: 128, nv: 64 },
  knot: {
    surface: tube(t => {
      const r = 0.56 + 0.22 * Math.cos(3 * TURN * t);
      return [r * Math.cos(2 * TURN * t), r * Math.sin(2 * TURN * t), 0.3 * Math.sin(3 * TURN * t)];
    }, 0.15),
    nu: 320,
    nv: 40,
  },
  vase: {
    surface: (u, v) => {
      const [r, z] = outline(v);
      return [r * Math.cos(TURN * u), r * Math.sin(TURN * u), z];
    },
    nu: 128,
    nv: 128,
  },
};

function difference(a: Vector, b: Vector): Vector {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

const made = new Map<ShapeName, Shape>();

function make({ surface, nu, nv }: (typeof SURFACES)[ShapeName]): Shape {
  const count = (nu + 1) * (nv + 1),
    shape = {
      position: new Float32Array(3 * count),
      normal: new Float32Array(3 * count),
      tangent: new Float32Array(3 * count),
      indices: new Uint32Array(6 * nu * nv),
    };
  const h = 1e-3;
  for (let j = 0, i = 0; j <= nv; j++)
    for (let k = 0; k <= nu; k++, i++) {
      // At the poles a step inside, where both derivatives exist.
      const u = k / nu,
        v = Math.min(Math.max(j / nv, 2 * h), 1 - 2 * h);
      const du = difference(surface(u + h, v), surface(u - h, v)),
        dv = difference(surface(u, v + h), surface(u, v - h));
      shape.position.set(surface(u, j / nv), 3 * i);
      shape.normal.set(normalised(cross(du, dv)), 3 * i);
      shape.tangent.set(normalised(du), 3 * i);
    }
  for (let j = 0, at = 0; j < nv; j++)
    for (let k = 0; k < nu; k++) {
      const a = j * (nu + 1) + k,
        b = a + nu + 1;
      for (const i of [a, a + 1, b, b, a + 1, b + 1]) shape.indices[at++] = i;
    }
  return shape;
}

export function shapeOf(name: ShapeName): Shape {
  let shape = made.get(name);
  if (!shape) made.set(name, (shape = make(SURFACES[name])));
  return shape;
}
