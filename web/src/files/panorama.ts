/* panorama.ts: a picture of light from all around, row by row from a file, as a map that the views can hold.
 *
 * A map has at most 1024 x 512 pixels: of larger pictures each pixel is a mean, weighted by solid angle, so that all their
 * light stays.
 * SPDX-License-Identifier: MIT */
import type { Environment } from "../brdf/environment";

const MOST_WIDE = 1024,
  MOST_PIXELS = 16384 * 8192;

export class Panorama {
  private readonly step: number;
  private readonly columns: number;
  private readonly rows: number;
  private readonly sums: Float64Array;
  private readonly areas: Float64Array;

  constructor(
    private readonly name: string,
    private readonly width: number,
    private readonly height: number,
  ) {
    const size = `${width} x ${height} pixels`;
    if (!(width >= 2 && height >= 1)) throw new Error(`${name}: has ${size}; light from all around has at least 2 x 1`);
    if (width * height > MOST_PIXELS) throw new Error(`${name}: has ${size}; 16384 x 8192 are read at most`);
    if (Math.abs(width / height - 2) > 0.1)
      throw new Error(`${name}: has ${size}; light from all around (latitude and longitude) is twice as wide as high`);
    this.step = Math.ceil(width / MOST_WIDE);
    this.columns = Math.ceil(width / this.step);
    this.rows = Math.ceil(height / this.step);
    this.sums = new Float64Array(3 * this.columns * this.rows);
    this.areas = new Float64Array(this.columns * this.rows);
  }

  /** Red, green and blue of pixel x, `stride` numbers apart, of row y from the top. */
  addRow(y: number, rgb: ArrayLike<number>, first: number, stride: number, channels = 3): void {
    const { step, columns, sums, areas, width, height } = this,
      area = Math.cos((y * Math.PI) / height) - Math.cos(((y + 1) * Math.PI) / height),
      row = columns * Math.floor(y / step);
    for (let x = 0; x < width; x++) {
      const to = row + Math.floor(x / step);
      areas[to] += area;
      for (let c = 0; c < 3; c++) {
        const value = rgb[first + x * stride + (channels === 3 ? c : 0)];
        // What is negative, infinite or no number at all gives no light.
        if (value > 0 && value < Infinity) sums[3 * to + c] += area * value;
      }
    }
  }

  /** An Error if there is no light in it. */
  finish(): Environment {
    const { columns, rows, sums, areas } = this,
      pixels = new Float32Array(4 * columns * rows);
    let most = 0;
    for (let i = 0; i < columns * rows; i++) {
      for (let c = 0; c < 3; c++) most = Math.max(most, (pixels[4 * i + c] = sums[3 * i + c] / areas[i]));
      pixels[4 * i + 3] = 1;
    }
    if (!(most > 0)) throw new Error(`${this.name}: is black: nothing would be lit`);
    return { width: columns, height: rows, pixels };
  }
}
