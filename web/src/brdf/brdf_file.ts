/* brdf_file.ts: the .brdf and .bparam files of Disney's BRDF Explorer, read line by line as it does.
 *
 * The first word is `analytic`, or `bparam` and the path of a .brdf.  Lines that begin with # are skipped, in the shader
 * too; sections are ::begin NAME to ::end NAME.  Parameters are `float NAME MIN MAX DEFAULT`, `bool NAME 0|1` and
 * `color NAME R G B`; text behind them is ignored.
 * SPDX-License-Identifier: MIT */
import type { Model, Parameter } from "../facet/table";

export interface BrdfFile {
  readonly model: Model;
  /** GLSL 4.10 with vec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y), f in 1/sr. */
  readonly shader: string;
}

export interface BparamFile {
  /** The last part of the path of its .brdf. */
  readonly of: string;
  readonly parameters: readonly Parameter[];
}

/** A line of the file that is wrong. */
function fail(name: string, line: number, what: string): never {
  throw new Error(`${name}:${line}: ${what}`);
}

interface Section {
  readonly name: string;
  readonly lines: { readonly number: number; readonly text: string }[];
}

function sections(name: string, lines: readonly string[]): Section[] {
  const found: Section[] = [];
  let open: Section | undefined;
  lines.forEach((text, i) => {
    const number = i + 1;
    if (i === 0 || !text.trim() || text.trim().startsWith("#")) return;
    const mark = /^\s*::(begin|end)\s+(\w+)/.exec(text);
    if (!mark) open?.lines.push({ number, text });
    else if (mark[1] === "begin") {
      if (open) fail(name, number, `::begin ${mark[2]} inside ${open.name}; sections are not nested`);
      open = { name: mark[2], lines: [] };
    } else {
      if (open?.name !== mark[2]) fail(name, number, `::end ${mark[2]} where ${open?.name ?? "no section"} is open`);
      found.push(open);
      open = undefined;
    }
  });
  if (open) fail(name, lines.length, `${(open as Section).name} has no ::end`);
  return found;
}

function readParameter(name: string, number: number, text: string): Parameter {
  const [kind, id, ...rest] = text.trim().split(/\s+/),
    numbers = rest.map(Number);
  const isGood = (n: number): boolean => numbers.length >= n && numbers.slice(0, n).every(Number.isFinite);
  const base = { name: id, unit: "1", choices: [], description: `${kind} of ${name}` };
  if (!/^[A-Za-z_]\w*$/.test(id ?? "")) fail(name, number, `"${id ?? ""}" is no name for a parameter`);
  if (kind === "float") {
    if (!isGood(3)) fail(name, number, "write float NAME MIN MAX DEFAULT");
    const [low, high, value] = numbers;
    return { ...base, kind: "number", low, high, initial: [value, value, value] };
  }
  if (kind === "bool") {
    if (!isGood(1) || (numbers[0] !== 0 && numbers[0] !== 1)) fail(name, number, "write bool NAME 0 or bool NAME 1");
    return { ...base, kind: "choice", choices: ["no", "yes"], low: 0, high: 1, initial: [numbers[0], 0, 0] };
  }
  if (kind === "color") {
    if (!isGood(3)) fail(name, number, "write color NAME R G B");
    return { ...base, kind: "colour", low: 0, high: 1, initial: [numbers[0], numbers[1], numbers[2]] };
  }
  return fail(name, number, `"${kind}" is no kind of parameter; there are float, bool and color`);
}

function readParameters(name: string, all: readonly Section[]): Parameter[] {
  const parameters = all
    .filter(section => section.name === "parameters")
    .flatMap(section => section.lines.map(({ number, text }) => readParameter(name, number, text)));
  const twice = parameters.find((one, i) => parameters.findIndex(other => other.name === one.name) !== i);
  if (twice) fail(name, 1, `the parameter ${twice.name} is there twice`);
  return parameters;
}

export function readBrdf(name: string, text: string): BrdfFile {
  const lines = text.split(/\r?\n/),
    first = lines[0].trim().split(/\s+/)[0];
  if (first !== "analytic") fail(name, 1, `begins with "${first.slice(0, 20)}"; a .brdf file begins with "analytic"`);
  const all = sections(name, lines),
    parameters = readParameters(name, all),
    shader = all.filter(section => section.name === "shader").flatMap(section => section.lines.map(one => one.text));
  if (!/\bvec3\s+BRDF\s*\(/.test(shader.join("\n")))
    fail(name, lines.length, "its shader has no vec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y)");
  const model = {
    name,
    summary: "a file of Disney's BRDF Explorer",
    source: "dropped",
    parameters,
  };
  return { model, shader: shader.join("\n") };
}

export function readBparam(name: string, text: string): BparamFile {
  const lines = text.split(/\r?\n/),
    [first, ...path] = lines[0].trim().split(/\s+/);
  if (first !== "bparam" || !path.length)
    fail(name, 1, `begins with "${first.slice(0, 20)}"; a .bparam file begins with "bparam PATH"`);
  return { of: path.join(" ").split(/[/\\]/).pop()!, parameters: readParameters(name, sections(name, lines)) };
}
