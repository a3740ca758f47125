/* made_files.mjs: files of light, objects and measurements, made for the tests.
 *
 * SPDX-License-Identifier: MIT */
import { deflateSync } from "node:zlib";

/** The mantissas and the exponent of a pixel; exact for what the tests put in. */
export function rgbe([r, g, b]) {
  const most = Math.max(r, g, b);
  if (!(most > 0)) return [0, 0, 0, 0];
  const e = Math.floor(Math.log2(most)) + 1;
  return [r, g, b].map(x => Math.floor(x * 2 ** (8 - e))).concat(e + 128);
}

/** A component by itself: runs of up to 127, and what lies between them. */
function runs(bytes) {
  const out = [];
  for (let x = 0; x < bytes.length;) {
    let n = 1;
    while (x + n < bytes.length && n < 127 && bytes[x + n] === bytes[x]) n++;
    if (n > 2) out.push(128 + n, bytes[x]);
    else out.push(...[n, ...bytes.slice(x, x + n)]);
    x += n;
  }
  return out;
}

/** A Radiance picture of pixel(column, row); `coding` is flat, new or old. */
export function hdr(width, height, pixel, { coding = "flat", header = "", size } = {}) {
  const bytes = [];
  for (let y = 0; y < height; y++) {
    const row = Array.from({ length: width }, (_, x) => rgbe(pixel(x, y)));
    if (coding === "new") {
      bytes.push(2, 2, width >> 8, width & 255);
      for (let k = 0; k < 4; k++) for (const byte of runs(row.map(one => one[k]))) bytes.push(byte);
    } else
      for (let x = 0; x < width;) {
        let n = 1;
        while (coding === "old" && x + n < width && row[x + n].join() === row[x].join()) n++;
        bytes.push(...row[x]);
        if (n > 1) {
          bytes.push(1, 1, 1, (n - 1) & 255);
          if (n - 1 > 255) bytes.push(1, 1, 1, (n - 1) >> 8);
        }
        x += n;
      }
  }
  const text = `#?RADIANCE\n# made for a test\nFORMAT=32-bit_rle_rgbe\n${header}\n${size ?? `-Y ${height} +X ${width}`}\n`;
  return Buffer.concat([Buffer.from(text), Buffer.from(bytes)]);
}

const text0 = text => Buffer.from(text + "\0", "latin1");
const int32 = (...all) => {
  const bytes = Buffer.alloc(4 * all.length);
  all.forEach((x, i) => bytes.writeInt32LE(x, 4 * i));
  return bytes;
};

/** An OpenEXR picture of 32-bit floats; `compression` 0 is none, 2 is zlib by the row. */
export function exr(width, height, pixel, { compression = 0, channels = "BGR", window, flags = 0 } = {}) {
  const attribute = (name, type, value) => Buffer.concat([text0(name), text0(type), int32(value.length), value]);
  const list = Buffer.concat([
    ...[...channels].map(c => Buffer.concat([text0(c), int32(2, 0, 1, 1)])),
    Buffer.from([0]),
  ]);
  const box = window ?? [0, 0, width - 1, height - 1],
    float = Buffer.alloc(4);
  float.writeFloatLE(1);
  const head = Buffer.concat([
    int32(20000630, 2 | (flags << 8)),
    attribute("channels", "chlist", list),
    attribute("compression", "compression", Buffer.from([compression])),
    attribute("dataWindow", "box2i", int32(...box)),
    attribute("displayWindow", "box2i", int32(...box)),
    attribute("lineOrder", "lineOrder", Buffer.from([0])),
    attribute("pixelAspectRatio", "float", float),
    attribute("screenWindowCenter", "v2f", int32(0, 0)),
    attribute("screenWindowWidth", "float", float),
    Buffer.from([0]),
  ]);
  const rows = Array.from({ length: height }, (_, y) => {
    const row = Buffer.alloc(4 * width * channels.length);
    [...channels].forEach((c, k) => {
      for (let x = 0; x < width; x++) {
        const rgb = pixel(x, y);
        row.writeFloatLE(rgb["RGB".indexOf(c)] ?? rgb[0], 4 * (k * width + x));
      }
    });
    if (compression === 0) return Buffer.concat([int32(y, row.length), row]);
    // Even bytes, odd bytes, and then the differences of neighbours.
    const parted = Buffer.from([...row.filter((_, i) => i % 2 === 0), ...row.filter((_, i) => i % 2)]),
      packed = deflateSync(Buffer.from(parted.map((byte, i) => (i ? byte - parted[i - 1] + 384 : byte))));
    return Buffer.concat(packed.length < row.length ? [int32(y, packed.length), packed] : [int32(y, row.length), row]);
  });
  const offsets = Buffer.alloc(8 * height);
  let at = head.length + offsets.length;
  rows.forEach((row, y) => {
    offsets.writeBigUInt64LE(BigInt(at), 8 * y);
    at += row.length;
  });
  return Buffer.concat([head, offsets, ...rows]);
}

/** An anisotropic measurement of value(theta_in, theta_out, phi_diff, phi_in) at the middles of the bins [rad]. */
export function mit(bins, value, { half = 0, header = {} } = {}) {
  const n = bins.reduce((a, b) => a * b),
    bytes = Buffer.alloc(64 + 12 * n),
    spans = [Math.PI / 2, Math.PI / 2, half ? Math.PI : 2 * Math.PI, 2 * Math.PI];
  const head = { ...bins, 6: 1, 7: 0, 9: half, 10: 3, ...header };
  for (const [k, x] of Object.entries(head)) bytes.writeInt32LE(x, 4 * k);
  const at = [0, 0, 0, 0];
  for (let i = 0; i < n; i++) {
    const rgb = value(...at.map((bin, k) => ((bin + 0.5) / bins[k]) * spans[k]));
    rgb.forEach((x, c) => bytes.writeFloatLE(x, 64 + 4 * (c * n + i)));
    for (let k = 3; k >= 0 && ++at[k] === bins[k]; k--) at[k] = 0;
  }
  return bytes;
}

/** A pyramid on a square, y up, with a corner that is reached from the end. */
export const PYRAMID = `# made for a test
o pyramid
v -1 0 -1
v 1 0 -1
v 1 0 1
v -1 0 1
v 0 2 0
f 1 2 3 4
f 4 3 5
f -3 -4 -1
f 2 1 5
f 1 4 5
`;
