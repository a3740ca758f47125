/* glsl_es.ts: GLSL 4.10 as people wrote it for Disney's BRDF Explorer, for WebGL 2.
 *
 * GLSL ES 3.00 does not turn integers into floats by itself, and `const` wants a constant: whole numbers become floats
 * but where integers are meant (an index, a statement with an int, an int's place in a call), and `const` goes from
 * inside functions.
 * SPDX-License-Identifier: MIT */

interface Token {
  readonly text: string;
  readonly kind: "word" | "number" | "space" | "mark";
}

const TOKEN =
  /\/\/[^\n]*|\/\*[\s\S]*?\*\/|\s+|(?:\d+\.\d*|\.\d+|\d+)(?:[eE][+-]?\d+)?[fFuU]?|0[xX][\da-fA-F]+|[A-Za-z_]\w*|./g;
const INTEGER_TYPES = new Set(["int", "uint", "ivec2", "ivec3", "ivec4", "uvec2", "uvec3", "uvec4"]);

function tokensOf(text: string): Token[] {
  return (text.match(TOKEN) ?? []).map(part => ({
    text: part,
    kind: /^(\/\/|\/\*|\s)/.test(part) ? "space" : /^\.?\d/.test(part) ? "number" : /^\w/.test(part) ? "word" : "mark",
  }));
}

/** Names that are declared as integers anywhere. */
function integerNames(tokens: readonly Token[]): Set<string> {
  const words = tokens.filter(token => token.kind !== "space"),
    names = new Set<string>();
  words.forEach((token, i) => {
    if (INTEGER_TYPES.has(token.text) && words[i + 1]?.kind === "word") names.add(words[i + 1].text);
  });
  return names;
}

/** For each function that takes integers, which of its parameters are. */
function integerParameters(text: string): Map<string, boolean[]> {
  const found = new Map<string, boolean[]>();
  for (const [, name, list] of text.matchAll(/\b[A-Za-z]\w*\s+([A-Za-z_]\w*)\s*\(([^()]*)\)\s*\{/g)) {
    const are = list.split(",").map(one =>
      one
        .trim()
        .split(/\s+/)
        .some(word => INTEGER_TYPES.has(word)),
    );
    if (are.some(is => is)) found.set(name, are);
  }
  return found;
}

/** Statements end at ; { and }, and at the ; of a for, too. */
function integerStatements(tokens: readonly Token[], names: ReadonlySet<string>): boolean[] {
  const isInteger = new Array<boolean>(tokens.length).fill(false);
  for (let first = 0; first < tokens.length;) {
    let last = first;
    while (last < tokens.length - 1 && !/^[;{}]$/.test(tokens[last].text)) last++;
    const has = tokens.slice(first, last + 1).some(({ text }) => INTEGER_TYPES.has(text) || names.has(text));
    isInteger.fill(has, first, last + 1);
    first = last + 1;
  }
  return isInteger;
}

/** The text with `rename` applied to words that are not fields. */
export function toGlslEs(text: string, rename: (word: string) => string): string {
  const tokens = tokensOf(text),
    isInteger = integerStatements(tokens, integerNames(tokens)),
    parameters = integerParameters(text),
    calls: { readonly name: string; place: number }[] = [];
  let braces = 0,
    brackets = 0,
    before = "";
  return tokens
    .map((token, i) => {
      const { text: part, kind } = token,
        last = before;
      if (kind !== "space") before = part;
      if (part === "(") calls.push({ name: last, place: 0 });
      if (part === ")") calls.pop();
      if (part === "," && calls.length) calls[calls.length - 1].place++;
      if (part === "{") braces++;
      if (part === "}") braces--;
      if (part === "[") brackets++;
      if (part === "]") brackets--;
      if (kind === "word") return part === "const" && braces > 0 ? "" : last === "." ? part : rename(part);
      if (kind !== "number" || !/^\d+$/.test(part)) return part;
      const call = calls[calls.length - 1],
        isArgument = call !== undefined && parameters.get(call.name)?.[call.place] === true;
      return brackets > 0 || isInteger[i] || isArgument ? part : `${part}.0`;
    })
    .join("");
}
