/* exr.ts: OpenEXR pictures (.exr) of light from all around, decoded by parse-exr, which is fetched when it is first needed.
 *
 * Its decoder trusts the header, so that this is walked first: what would not fit into memory, or has parts that it does
 * not know, is refused before.
 * SPDX-License-Identifier: MIT */
import type { Environment } from "../brdf/environment";
import { Panorama } from "./panorama";

const MAGIC = 20000630,
  FLAGS_KNOWN = 0x06, // tiles, long names
  MOST_PIXELS = 8192 * 4096,
  FLOAT = 1015,
  RGBA = 1023;

function checkHeader(name: string, buffer: ArrayBuffer): void {
  const view = new DataView(buffer),
    bytes = new Uint8Array(buffer);
  const bad = (what: string): never => {
    throw new Error(`${name}: ${what}`);
  };
  if (buffer.byteLength < 16 || view.getUint32(0, true) !== MAGIC) bad("is no OpenEXR file");
  if (view.getUint8(5) & ~FLAGS_KNOWN || view.getUint8(6) || view.getUint8(7))
    bad("has several parts or deep pixels; one part of flat pixels is read");
  let at = 8,
    hasWindow = false,
    hasChannels = false;
  const word = (): string => {
    const end = bytes.subarray(at, at + 256).indexOf(0);
    if (end < 0) bad("the header is damaged");
    const text = String.fromCharCode(...bytes.subarray(at, at + end));
    at += end + 1;
    return text;
  };
  for (let key = word(); key !== ""; key = word()) {
    const type = word();
    if (at + 4 > bytes.length) bad("the header does not end");
    const size = view.getUint32(at, true);
    at += 4;
    if (size > bytes.length - at) bad(`the header does not end: ${key} has ${size} bytes`);
    if (key === "dataWindow" && type === "box2i" && size === 16) {
      const [left, top, right, bottom] = [0, 4, 8, 12].map(k => view.getInt32(at + k, true)),
        [w, h] = [right - left + 1, bottom - top + 1];
      if (!(w > 0 && h > 0)) bad("has no pixels");
      if (w * h > MOST_PIXELS) bad(`has ${w} x ${h} pixels; 8192 x 4096 are read at most`);
      hasWindow = true;
    }
    if (key === "channels" && type === "chlist") hasChannels = true;
    at += size;
  }
  if (!hasWindow || !hasChannels) bad("the header lacks the data window or the channels");
}

export async function readExr(name: string, buffer: ArrayBuffer): Promise<Environment> {
  checkHeader(name, buffer);
  const { default: parseExr } = await import("parse-exr");
  let picture: ReturnType<typeof parseExr>;
  try {
    picture = parseExr(buffer, FLOAT);
  } catch (error) {
    throw new Error(
      `${name}: cannot be decoded: ${String((error as Error).message).replace(/^EXRLoader[.:\w ]*: ?/, "")}`,
    );
  }
  const { width, height, data } = picture,
    channels = picture.format === RGBA ? 4 : 1,
    panorama = new Panorama(name, width, height);
  // Rows are from the bottom.
  for (let y = 0; y < height; y++)
    panorama.addRow(y, data, (height - 1 - y) * width * channels, channels, channels === 4 ? 3 : 1);
  return panorama.finish();
}
