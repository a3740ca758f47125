/* readers.test.mjs: light, objects and measurements from files: as they were made, or refused with the reason.
 *
 * SPDX-License-Identifier: MIT */
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { exr, hdr, mit, PYRAMID } from "./made_files.mjs";
import { draws } from "./materials.mjs";
import { modules } from "./modules.mjs";

let page, readHdr, readExr, readObj, readMit, MitBrdf, brdfs, angles;
before(async () => {
  page = await modules();
  const names = ["files/hdr", "files/exr", "files/obj", "files/mit", "brdf/mit_brdf", "brdf/brdf", "brdf/angles"];
  [{ readHdr }, { readExr }, { readObj }, { readMit }, { MitBrdf }, brdfs, angles] = await Promise.all(
    names.map(page.load),
  );
});
after(() => page.close());

const buffer = bytes => bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);

/** Bright at the upper left, red to the right; exact in eight bits. */
const pixel = (x, y) => (x < 3 && y === 0 ? [64, 64, 64] : x > 12 ? [1, 0, 0] : [0.25, 0.5, (y + 1) / 8]);
const W = 16,
  H = 8;

function same({ width, height, pixels }, of = pixel) {
  assert.deepEqual([width, height], [W, H]);
  for (let y = 0; y < H; y++)
    for (let x = 0; x < W; x++)
      assert.deepEqual([...pixels.slice(4 * (y * W + x), 4 * (y * W + x) + 3)], of(x, y), `${x}, ${y}`);
}

test("Radiance pictures of all codings and directions are the same light", () => {
  for (const coding of ["flat", "new", "old"]) same(readHdr("a.hdr", buffer(hdr(W, H, pixel, { coding }))));
  same(readHdr("a.hdr", buffer(hdr(W, H, pixel, { header: "EXPOSURE=2\nEXPOSURE=.5\n" }))));
  same(readHdr("a.hdr", buffer(hdr(W, H, pixel, { header: "EXPOSURE=2\n" }))), (x, y) => pixel(x, y).map(c => c / 2));
  const turned = hdr(W, H, (x, y) => pixel(W - 1 - x, H - 1 - y), { size: `+Y ${H} -X ${W}` });
  same(readHdr("a.hdr", buffer(turned)));
});

test("OpenEXR pictures are the same light, by all three channels or one", async () => {
  for (const compression of [0, 2]) same(await readExr("a.exr", buffer(exr(W, H, pixel, { compression }))));
  same(await readExr("a.exr", buffer(exr(W, H, pixel, { channels: "Y" }))), (x, y) =>
    pixel(x, y).map(() => pixel(x, y)[0]),
  );
  const odd = (x, y) => (x === 5 ? [NaN, Infinity, -1] : pixel(x, y));
  same(await readExr("a.exr", buffer(exr(W, H, odd))), (x, y) => (x === 5 ? [0, 0, 0] : pixel(x, y)));
});

test("a larger picture is made smaller with all its light", () => {
  const [w, h] = [2100, 1050],
    sun = (x, y) => (x === 1234 && y === 321 ? [4096, 2048, 1024] : [0.5, 0.25, (x & 1) / 2]);
  const map = readHdr("sun.hdr", buffer(hdr(w, h, sun, { coding: "new" })));
  assert.ok(map.width <= 1024 && map.width / map.height > 1.9 && map.width / map.height < 2.1, `${map.width}`);
  const light = (width, height, at) => {
    const sums = [0, 0, 0];
    for (let y = 0; y < height; y++) {
      const area =
        ((2 * Math.PI) / width) * (Math.cos((y * Math.PI) / height) - Math.cos(((y + 1) * Math.PI) / height));
      for (let x = 0; x < width; x++) at(x, y).forEach((c, k) => (sums[k] += c * area));
    }
    return sums;
  };
  const before = light(w, h, sun),
    found = light(map.width, map.height, (x, y) => {
      const at = 4 * (y * map.width + x);
      return [...map.pixels.slice(at, at + 3)];
    });
  // The means are kept as 32-bit floats.
  found.forEach((sum, k) => assert.ok(Math.abs(sum / before[k] - 1) < 1e-5, `${sum}, ${before[k]}`));
});

const good = { hdr: () => hdr(W, H, pixel, { coding: "new" }), exr: () => exr(W, H, pixel, { compression: 2 }) };
const cut = (bytes, n) => bytes.subarray(0, bytes.length - n);
const BAD_HDR = [
  [Buffer.from(""), /byte 0: the header does not end/],
  [Buffer.from("P6\n2 1\n255\n"), /begins with "P6"/],
  [Buffer.from("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 2\n"), /the format is 32-bit_rle_xyze/],
  [Buffer.from("#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 2\n"), /the exposure is 0/],
  [Buffer.from("#?RADIANCE\n\n+X 2 -Y 1\n"), /no line with the resolution/],
  [Buffer.from("#?RADIANCE\n\n-Y 100000 +X 200000\n"), /200000 x 100000 pixels; 16384 x 8192 are read at most/],
  [Buffer.from("#?RADIANCE\n\n-Y 0 +X 0\n"), /has 0 x 0 pixels/],
  [hdr(8, 8, pixel), /8 x 8 pixels; light from all around .* twice as wide/],
  [cut(hdr(W, H, pixel), 3), /the file ends in a row/],
  [cut(good.hdr(), 1), /the file ends in a row/],
  [Buffer.concat([Buffer.from("#?RADIANCE\n\n-Y 1 +X 2\n"), Buffer.from([1, 1, 1, 9])]), /goes beyond its row/],
  [hdr(W, H, () => [0, 0, 0]), /is black/],
];
const BAD_EXR = [
  [Buffer.from("v/1"), /is no OpenEXR file/],
  [exr(W, H, pixel, { flags: 0x10 }), /several parts/],
  [good.exr().subarray(0, 60), /the header does not end/],
  [exr(1, 1, pixel, { window: [0, 0, 65535, 32767] }), /65536 x 32768 pixels; 8192 x 4096/],
  [exr(1, 1, pixel, { window: [5, 5, 2, 2] }), /has no pixels/],
  [exr(8, 8, pixel), /twice as wide as high/],
  [exr(W, H, pixel, { channels: "ZX" }), /cannot be decoded/],
  [cut(exr(W, H, pixel), 100), /cannot be decoded/],
  [exr(W, H, () => [0, 0, 0]), /is black/],
];
const BAD_OBJ = [
  ["", /has no faces/],
  ["v 0 0\n", /bad.obj:1: "v 0 0" has no 3 numbers/],
  ["v 0 0 nan\n", /has no 3 numbers/],
  ["v 0 0 1e39\n", /has no 3 numbers/],
  ["v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", /bad.obj:4: "4" is none of the 3 before it/],
  ["v 0 0 0\nf 0 1 1\n", /"0" is none/],
  ["v 0 0 0\nf 1 1\n", /at least three corners/],
  ["v 0 0 0\nf 1/1 1/1 1/1\n", /"1" is none of the 0/],
  ["v 0 0 0\nf /1 1 1\n", /is no corner/],
  ["v 5 5 5\nf 1 1 1\n", /all its points are one/],
  [`v 0 0 0\nv 1 0 0\nv 0 1 0\n${`f ${"1 2 3 ".repeat(60000)}\n`.repeat(6)}`, /more triangles than are read/],
];
const plain = (...more) => mit([2, 2, 2, 2], () => [1, 1, 1], ...more);
const BAD_MIT = [
  [Buffer.alloc(10), /has 10 bytes; .* header of 64/],
  [plain({ header: { 0: -1 } }), /its sizes are -1, 2, 2, 2/],
  [plain({ header: { 0: 4000, 1: 4000, 2: 4000, 3: 4000 } }), /with sizes 4000 x 4000 x 4000 x 4000 it has/],
  [plain({ header: { 6: 0 } }), /its angles are of kind 0/],
  [plain({ header: { 7: 1 } }), /its bins are of kind 1/],
  [plain({ header: { 10: 1 } }), /has 1 channels/],
  [cut(plain(), 4), /has 252 bytes; .* it has 256/],
  [mit([2, 2, 2, 2], () => [NaN, 1, 1]), /byte 64: the number is not finite/],
  [mit([2, 2, 2, 2], () => [-1, -1, -1]), /nothing in it was measured/],
];
const reads = {
  hdr: async bytes => readHdr("bad.hdr", buffer(bytes)),
  exr: async bytes => readExr("bad.exr", buffer(bytes)),
  obj: async text => readObj("bad.obj", String(text)),
  dat: async bytes => readMit("bad.dat", new Blob([bytes])),
};
for (const [kind, all] of Object.entries({ hdr: BAD_HDR, exr: BAD_EXR, obj: BAD_OBJ, dat: BAD_MIT }))
  test(`a bad .${kind} file is refused with the reason`, async () => {
    for (const [bytes, wanted] of all)
      await assert.rejects(reads[kind](bytes), error => {
        assert.match(error.message, /^bad\./);
        assert.match(error.message, wanted);
        return true;
      });
  });

test("damaged files are read or refused, never taken for what they are not", async () => {
  const draw = draws(3);
  const whole = { ...good, obj: () => Buffer.from(PYRAMID), dat: () => plain() };
  for (const [kind, make] of Object.entries(whole))
    for (let k = 0; k < 200; k++) {
      const bytes = Buffer.from(make());
      for (let n = 1 + Math.floor(4 * draw()); n > 0; n--)
        bytes[Math.floor(bytes.length * draw())] = Math.floor(256 * draw());
      const end = draw() < 0.3 ? Math.floor(bytes.length * draw()) : bytes.length;
      try {
        const read = await reads[kind](bytes.subarray(0, end)),
          numbers = read.pixels ?? read.position ?? [0];
        assert.ok(numbers.every(Number.isFinite), `${kind} ${k}`);
      } catch (error) {
        assert.match(error.message, /^bad\./, `${kind} ${k}: ${error.stack}`);
      }
    }
});

test("an object stands upright in the unit ball, with normals outwards and tangents around it", () => {
  const { position, normal, tangent, indices } = readObj("pyramid.obj", PYRAMID);
  assert.equal(indices.length, 3 * 6);
  const at = (of, i) => [...of.slice(3 * i, 3 * i + 3)],
    dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  let top = 0,
    far = 0;
  for (let i = 0; i < position.length / 3; i++) {
    const [p, n, t] = [position, normal, tangent].map(of => at(of, i));
    far = Math.max(far, Math.hypot(...p));
    if (p[2] > position[3 * top + 2]) top = i;
    assert.ok(dot(p, n) > 0, "outwards");
    assert.ok(Math.abs(dot(n, n) - 1) < 1e-6 && Math.abs(dot(t, t) - 1) < 1e-6 && Math.abs(dot(n, t)) < 1e-6);
  }
  assert.ok(Math.abs(far - 1) < 1e-6, `${far}`);
  assert.ok(Math.abs(position[3 * top]) < 1e-6 && Math.abs(position[3 * top + 1]) < 1e-6, "the tip is in the middle");
});

test("an object's own normals and coordinates are kept", () => {
  const text = `v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 0 2\nvt -1 0\nvn 0 .6 .8\nf 1/1/1 2/2/1 3/3/1\n`,
    { normal, tangent, position } = readObj("a.obj", text);
  // y becomes z, and z the way to the viewer, -y.
  [0, -0.8, 0.6].forEach((x, k) => assert.ok(Math.abs(normal[k] - x) < 1e-6));
  // The first coordinate falls along the second edge, (0, 1, 0), which is up; across the normal that is (0, .6, .8).
  [0, -0.6, -0.8].forEach((x, k) => assert.ok(Math.abs(tangent[k] - x) < 1e-6, `${tangent.slice(0, 3)}`));
  assert.ok(position[3] - position[0] > 0.5 && Math.abs(position[5] - position[2]) < 1e-6, "x stays x");
});

/** Smooth and not the same under a turn of both directions. */
const measured = (ti, to, pd, pi) => {
  const f = 0.3 + 0.2 * Math.cos(pi) * Math.sin(ti) + 0.1 * Math.cos(pd) * Math.sin(to);
  return [f, f / 2, 0.25];
};

function directionsOf(ti, to, pd, pi) {
  // Azimuths are of the directions to the surface.
  const at = (theta, phi) => [-Math.sin(theta) * Math.cos(phi), -Math.sin(theta) * Math.sin(phi), Math.cos(theta)];
  return { wi: brdfs.sameDirections(1, at(ti, pi)), wo: brdfs.sameDirections(1, at(to, pi + pd)) };
}

for (const half of [0, 1])
  test(`a measurement of MIT has the values of its bins, ${half ? "half" : "whole"} turns`, async () => {
    const bins = [6, 5, 16, 8],
      data = await readMit("made.dat", new Blob([mit(bins, measured, { half })])),
      brdf = new MitBrdf("made.dat", data),
      draw = draws(5);
    assert.deepEqual(data.bins, bins);
    for (let i = 0; i < 200; i++) {
      const spans = [Math.PI / 2, Math.PI / 2, half ? Math.PI : 2 * Math.PI, 2 * Math.PI],
        middle = bins.map((n, k) => ((Math.floor(n * draw()) + 0.5) / n) * spans[k]),
        { wi, wo } = directionsOf(...middle),
        { r, g, b } = brdf.eval(wi, wo);
      // Half floats are good to 2^-11, and directions to 2^-24 of the width of a bin.
      measured(...middle).forEach((x, k) =>
        assert.ok(Math.abs([r, g, b][k][0] / wi.z[0] / x - 1) < 6e-4, `${middle}: ${[r, g, b][k][0] / wi.z[0]}, ${x}`),
      );
    }
  });

test("azimuths go on from the last bin to the first", async () => {
  const ramp = k => async at => {
    const data = await readMit("made.dat", new Blob([mit([2, 2, 8, 8], (...angles) => Array(3).fill(angles[k]))]));
    const { wi, wo } = directionsOf(...at);
    return new MitBrdf("made.dat", data).eval(wi, wo).r[0] / wi.z[0];
  };
  // Halfway between pi/8 and 15 pi/8, to the precision of half floats.
  const values = [await ramp(2)([0.5, 0.6, 0, 1]), await ramp(3)([0.5, 0.6, 1, 0])];
  for (const value of values) assert.ok(Math.abs(value / Math.PI - 1) < 1e-3, `${value}`);
});

test("bins that were not measured take no part, and neighbours of large files become one", async () => {
  const holes = (ti, to, pd, pi) => (Math.abs(pi - 1.77) < 0.1 ? [-1, -1, -1] : measured(ti, to, pd, pi)),
    data = await readMit("made.dat", new Blob([mit([4, 4, 8, 16], holes)])),
    blueAt = pi => {
      const { wi, wo } = directionsOf(0.6, 0.7, 1, pi);
      return new MitBrdf("made.dat", data).eval(wi, wo).b[0] / wi.z[0];
    };
  assert.ok(data.values.some(bits => bits === 0xbc00));
  for (const pi of [1.5, 1.77, 2]) assert.ok(Math.abs(blueAt(pi) / 0.25 - 1) < 1e-3, `${blueAt(pi)}`);
  // 2^25 bins of which phi_in has two: half as many are kept, as means.  Only a piece of the file is ever there.
  const bins = [64, 64, 4096, 2],
    header = mit([1, 1, 1, 1], () => [1, 1, 1], { header: bins }).subarray(0, 64),
    floats = new Float32Array(2 ** 22).map((_, i) => (i % 2 ? 0.75 : 0.25));
  const large = {
    size: 64 + 12 * 2 ** 25,
    slice: (from, to) => ({ arrayBuffer: async () => (from ? floats.buffer.slice(0, to - from) : buffer(header)) }),
  };
  const { bins: kept, values } = await readMit("large.dat", large);
  assert.deepEqual(kept, [64, 64, 4096, 1]);
  assert.ok(
    values.every(bits => bits === 0x3800),
    "0.5 as a half float",
  );
});
