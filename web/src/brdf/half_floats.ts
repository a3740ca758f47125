/* half_floats.ts: floats of 16 bits (IEEE 754), which halve large measurements; both ways.
 *
 * SPDX-License-Identifier: MIT */

/** -1, for what was not measured. */
export const UNMEASURED = 0xbc00;

const FLOAT = new Float32Array(1),
  BITS = new Uint32Array(FLOAT.buffer);

/** The nearest half of a float from 0 to 65504, ties to even. */
export function halfOf(x: number): number {
  FLOAT[0] = x;
  const bits = BITS[0],
    exponent = (bits >>> 23) - 112;
  if (exponent <= 0) {
    // Below 2^-14: a multiple of 2^-24.
    const multiple = x * 2 ** 24,
      low = Math.floor(multiple),
      part = multiple - low;
    return part > 0.5 || (part === 0.5 && low % 2) ? low + 1 : low;
  }
  // A carry out of the digits goes into the exponent, as it should.
  const rounded = bits + 0xfff + ((bits >>> 13) & 1);
  return (rounded >>> 13) - (112 << 10);
}

/** What all 65536 patterns stand for. */
export function halves(): Float32Array {
  return Float32Array.from({ length: 65536 }, (_, bits) => {
    const exponent = (bits >> 10) & 31,
      digits = bits & 1023,
      size = exponent ? (1024 + digits) * 2 ** (exponent - 25) : digits * 2 ** -24;
    return bits & 0x8000 ? -size : size;
  });
}
