/* hdr.ts: Radiance pictures (.hdr) of light from all around; io/hdr.c says how they are stored.
 *
 * [radiance] G. Ward, "Real Pixels", Graphics Gems II (1991): a text header, one line with the resolution, and rows of
 * pixels (red, green, blue, exponent) that are flat, run-length coded in the old way (1, 1, 1, n repeats the pixel
 * before), or in the new one (each component by itself).
 * SPDX-License-Identifier: MIT */
import type { Environment } from "../brdf/environment";
import { Panorama } from "./panorama";

interface Cursor {
  readonly name: string;
  readonly bytes: Uint8Array;
  at: number;
}

function fail({ name, at }: Cursor, what: string): never {
  throw new Error(`${name}: byte ${at}: ${what}`);
}

function nextLine(c: Cursor): string {
  const end = c.bytes.subarray(c.at, c.at + 4096).indexOf(10);
  if (end < 0) fail(c, "the header does not end");
  const line = String.fromCharCode(...c.bytes.subarray(c.at, c.at + end));
  c.at += end + 1;
  return line.replace(/\r$/, "");
}

/** What all numbers are to be divided by: the product of its EXPOSURE lines. */
function readHeader(c: Cursor): number {
  const first = nextLine(c);
  if (!first.startsWith("#?")) fail({ ...c, at: 0 }, `begins with "${first.slice(0, 12)}"; a .hdr file begins with #?`);
  let exposure = 1;
  for (let line = nextLine(c); line !== ""; line = nextLine(c)) {
    const [key, value = ""] = line.split("=");
    if (key.trim() === "FORMAT" && value.trim() !== "32-bit_rle_rgbe")
      fail(c, `the format is ${value.trim()}; 32-bit_rle_rgbe is read`);
    if (key.trim() === "EXPOSURE") {
      exposure *= Number(value);
      if (!(exposure > 0 && exposure < Infinity)) fail(c, `the exposure is ${value.trim()}; it is above 0`);
    }
  }
  return exposure;
}

function need(c: Cursor, n: number): void {
  if (c.at + n > c.bytes.length) fail({ ...c, at: c.bytes.length }, "the file ends in a row");
}

/** One row, in the new coding: each component by itself. */
function readComponents(c: Cursor, width: number, row: Uint8Array): void {
  const { bytes } = c;
  for (let component = 0; component < 4; component++)
    for (let x = 0; x < width;) {
      need(c, 2);
      const count = bytes[c.at] & 127,
        isRun = bytes[c.at] > 128,
        n = isRun ? count : bytes[c.at];
      if (!n || x + n > width) fail(c, "a run goes beyond its row");
      c.at++;
      if (!isRun) need(c, n);
      for (let i = 0; i < n; i++) row[4 * (x + i) + component] = bytes[isRun ? c.at : c.at + i];
      c.at += isRun ? 1 : n;
      x += n;
    }
}

/** One row of pixels, flat or in the old coding, and the pixel to repeat. */
function readPixels(c: Cursor, width: number, row: Uint8Array, before: Uint8Array): void {
  const { bytes } = c;
  for (let x = 0, shift = 0; x < width;) {
    need(c, 4);
    const pixel = bytes.subarray(c.at, c.at + 4),
      isRun = pixel[0] === 1 && pixel[1] === 1 && pixel[2] === 1;
    const n = isRun ? pixel[3] * 2 ** shift : 1;
    if (x + n > width) fail(c, "a run goes beyond its row");
    if (!isRun) before.set(pixel);
    for (let i = 0; i < n; i++) row.set(before, 4 * (x + i));
    shift = isRun ? shift + 8 : 0;
    if (shift > 24) fail(c, "too many runs in a row");
    c.at += 4;
    x += n;
  }
}

export function readHdr(name: string, buffer: ArrayBuffer): Environment {
  const c: Cursor = { name, bytes: new Uint8Array(buffer), at: 0 },
    exposure = readHeader(c),
    size = /^([-+])Y (\d+) ([-+])X (\d+)$/.exec(nextLine(c).trim());
  if (!size) fail(c, "there is no line with the resolution, such as -Y 512 +X 1024");
  const [, down, height, right, width] = size,
    [w, h] = [Number(width), Number(height)],
    panorama = new Panorama(name, w, h),
    row = new Uint8Array(4 * w),
    before = new Uint8Array(4),
    rgb = new Float64Array(3 * w);
  for (let y = 0; y < h; y++) {
    const { bytes, at } = c,
      isNew = w >= 8 && w < 32768 && bytes[at] === 2 && bytes[at + 1] === 2 && bytes[at + 2] < 128;
    if (isNew && bytes[at + 2] * 256 + bytes[at + 3] !== w) fail(c, "a row has another length");
    if (isNew) {
      c.at += 4;
      readComponents(c, w, row);
    } else readPixels(c, w, row, before);
    for (let x = 0; x < w; x++) {
      const scale = row[4 * x + 3] ? 2 ** (row[4 * x + 3] - 136) / exposure : 0,
        to = 3 * (right === "+" ? x : w - 1 - x);
      for (let k = 0; k < 3; k++) rgb[to + k] = row[4 * x + k] * scale;
    }
    panorama.addRow(down === "-" ? y : h - 1 - y, rgb, 0, 3);
  }
  return panorama.finish();
}
