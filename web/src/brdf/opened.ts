/* opened.ts: what a dropped or chosen file becomes.
 *
 * SPDX-License-Identifier: MIT */
import { readBparam, readBrdf } from "./brdf_file";
import { readMerl, type Merl } from "./merl";
import { compileBrdf, ShaderBrdf } from "./shader_brdf";

export type Opened = Merl | ShaderBrdf;

/** Blanks would end a word of a spec. */
function nameOf(file: File): string {
  return file.name.replace(/\s+/g, "_");
}

/** An Error whose message can be shown; `known` finds a .brdf that was opened before. */
export async function openFile(file: File, known: (name: string) => Opened | undefined): Promise<Opened> {
  const name = nameOf(file);
  if (/\.binary$/i.test(name)) return readMerl(name, await file.arrayBuffer());
  if (/\.brdf$/i.test(name)) return compileBrdf(readBrdf(name, await file.text()));
  if (/\.bparam$/i.test(name)) {
    const { of, parameters } = readBparam(name, await file.text()),
      base = known(of.replace(/\s+/g, "_"));
    if (!(base instanceof ShaderBrdf)) throw new Error(`${name}: belongs to ${of}: drop that file first`);
    return base.withWords(parameters.map(one => `${one.name}=${one.initial.slice(0, one.kind === "colour" ? 3 : 1)}`));
  }
  throw new Error(`${name}: is none of .brdf, .bparam (Disney's BRDF Explorer) and .binary (MERL)`);
}
