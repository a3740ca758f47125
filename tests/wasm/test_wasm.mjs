/* test_wasm.mjs: facet.wasm, driven as a web page would, gives the bits of every other build: the hashes that
 * tests/core/test_batch.c records, from the same inputs, which are made here once more.
 *
 *     node test_wasm.mjs FACET.WASM TEST_BATCH.C
 *
 * SPDX-License-Identifier: MIT */
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

const [wasmPath, batchPath] = process.argv.slice(2);
const N = 65536, PADDING = 16, MOST = N + PADDING;

// ---- The module ------------------------------------------------------------------------------------

const module = new WebAssembly.Module(readFileSync(wasmPath));
assert.deepEqual(WebAssembly.Module.imports(module), [], "facet.wasm imports nothing");
const facet = new WebAssembly.Instance(module, {}).exports;
facet._initialize();

function allocate(bytes) {
  const at = facet.malloc(bytes);
  assert.notEqual(at, 0, "out of memory");
  return at;
}
const floats = (at, n) => new Float32Array(facet.memory.buffer, at, n);
const words = (at, n) => new Uint32Array(facet.memory.buffer, at, n);
function text(at) {
  const bytes = new Uint8Array(facet.memory.buffer, at);
  return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
}
function toText(string) {
  const bytes = new TextEncoder().encode(string + "\0");
  const at = allocate(bytes.length);
  new Uint8Array(facet.memory.buffer, at, bytes.length).set(bytes);
  return at;
}
// A struct of pointers (facet_dirs, facet_rgb, facet_samples), which C passes by reference in WebAssembly.
function pointers(list) {
  const at = allocate(4*list.length);
  words(at, list.length).set(list);
  return at;
}

// More than facet_material, facet_bsdf and facet_error need.
const material = allocate(16384), bsdf = allocate(16384), why = allocate(1024);
function prepare(spec) {
  const at = toText(spec);
  const status = facet.facet_material_parse(at, material, why) || facet.facet_bsdf_prepare(material, bsdf, why);
  facet.free(at);
  return status;
}

// ---- Inputs: draws.c and fill_inputs of test_batch.c --------------------------------------------------

const MASK = (1n << 64n) - 1n;
let state = 2024n;
function draw() {
  state = (state + 0x9e3779b97f4a7c15n) & MASK;
  let z = state;
  z = ((z ^ (z >> 30n))*0xbf58476d1ce4e5b9n) & MASK;
  z = ((z ^ (z >> 27n))*0x94d049bb133111ebn) & MASK;
  return Number((z ^ (z >> 31n)) >> 40n)*2**-24;
}
function fillDirection(to, i) {
  let x, y, s;
  do {
    x = 2*draw() - 1;
    y = 2*draw() - 1;
    s = x*x + y*y;
  } while (s >= 1);
  const root = Math.sqrt(1 - s);
  to[0][i] = 2*x*root;
  to[1][i] = 2*y*root;
  to[2][i] = 1 - 2*s;
  if (i%8) to[2][i] = Math.abs(to[2][i]);
}
const arrays = n => Array.from({ length: n }, () => allocate(4*MOST));
const at = { wi: arrays(3), wo: arrays(3), u: arrays(3), out: arrays(7) };
function fillInputs() {
  const [wi, wo, u] = [at.wi, at.wo, at.u].map(list => list.map(a => floats(a, MOST)));
  for (let i = 0; i < MOST; i++) {
    fillDirection(wi, i);
    fillDirection(wo, i);
    for (let k = 0; k < 3; k++) u[k][i] = draw();
  }
}

// ---- Hashes ------------------------------------------------------------------------------------------

// FNV-1a of 64 bits, kept in halves: times 2^40 + 0x1b3.
class Hash {
  low = 0x84222325;
  high = 0xcbf29ce4;
  add(list) {
    let { low, high } = this;
    for (const a of list)
      for (const byte of new Uint8Array(facet.memory.buffer, a, 4*N)) {
        low = (low ^ byte) >>> 0;
        const product = low*0x1b3;
        high = (Math.imul(high, 0x1b3) + Math.floor(product/2**32) + (low << 8)) >>> 0;
        low = product >>> 0;
      }
    Object.assign(this, { low, high });
  }
  toString() {
    return "0x" + [this.high, this.low].map(half => half.toString(16).padStart(8, "0")).join("");
  }
}

// ---- The tests ---------------------------------------------------------------------------------------

function errorsAreReported() {
  assert.notEqual(prepare("ggx alpha=7"), 0);
  assert.equal(text(why + 4), "alpha");
  assert.match(text(why + 100), /out of range/);
  assert.equal(text(facet.facet_isa_name(0)), "base");
}

function resultsHaveTheRecordedBits(rows) {
  const in_ = pointers(at.wi), out = pointers(at.wo), numbers = pointers(at.u);
  const rgb = pointers(at.out.slice(0, 3)), samples = pointers(at.out);
  const wrong = [];
  for (const [spec, recorded] of rows) {
    assert.equal(prepare(spec), 0, `${spec}: ${text(why + 100)}`);
    const hash = new Hash();
    facet.facet_bsdf_eval_batch(bsdf, N, in_, out, rgb);
    hash.add(at.out.slice(0, 3));
    facet.facet_bsdf_pdf_batch(bsdf, N, in_, out, at.out[0]);
    hash.add(at.out.slice(0, 1));
    facet.facet_bsdf_sample_batch(bsdf, N, out, numbers, samples);
    hash.add(at.out);
    if (String(hash) !== recorded) wrong.push(`${spec}: ${hash}, recorded ${recorded}`);
  }
  assert.deepEqual(wrong, []);
}

function singleCallsGiveTheBitsOfBatches(rows) {
  const in_ = pointers(at.wi), out = pointers(at.wo), rgb = pointers(at.out.slice(0, 3));
  const one = allocate(64);
  for (const [spec] of rows) {
    prepare(spec);
    facet.facet_bsdf_eval_batch(bsdf, 256, in_, out, rgb);
    for (let i = 0; i < 256; i++) {
      for (let k = 0; k < 3; k++) {
        floats(one, 3)[k] = floats(at.wi[k], MOST)[i];
        floats(one + 16, 3)[k] = floats(at.wo[k], MOST)[i];
      }
      facet.facet_bsdf_eval(bsdf, one, one + 16, one + 32);
      for (let k = 0; k < 3; k++)
        assert.equal(words(one + 32, 3)[k], words(at.out[k], MOST)[i], `${spec}, element ${i}, channel ${k}`);
    }
  }
}

const rows = [...readFileSync(batchPath, "utf8").matchAll(/\{"([^"]+)",\s*UINT64_C\((0x[0-9a-f]{16})\)\}/g)]
  .map(m => [m[1], m[2]]);
assert.ok(rows.length >= 10, `${batchPath} has rows {"material", UINT64_C(0x...)}`);
fillInputs();
errorsAreReported();
resultsHaveTheRecordedBits(rows);
singleCallsGiveTheBitsOfBatches(rows);
console.log(`${rows.length} materials have the recorded bits`);
