/* opened.ts: what a dropped or chosen file becomes: a material, light from all around, or an object to be lit.
 *
 * SPDX-License-Identifier: MIT */
import type { Shape } from "../gl/shapes";
import type { FileAnswer, FileKind, FileRequest } from "../workers/files.worker";
import { readBparam, readBrdf } from "./brdf_file";
import type { Environment } from "./environment";
import { readMerl, type Merl } from "./merl";
import { MitBrdf, type MitData } from "./mit_brdf";
import { compileBrdf, ShaderBrdf } from "./shader_brdf";

export type MaterialFile = Merl | MitBrdf | ShaderBrdf;
export type Opened =
  | { readonly is: "material"; readonly brdf: MaterialFile }
  | { readonly is: "light"; readonly name: string; readonly environment: Environment }
  | { readonly is: "object"; readonly name: string; readonly shape: Shape };

export const EXTENSIONS = [".brdf", ".bparam", ".binary", ".dat", ".hdr", ".exr", ".obj"];

const MEBI = 2 ** 20;
/** Larger files are refused before they are read [byte]. */
const MOST: Record<string, number> = {
  brdf: MEBI,
  bparam: MEBI,
  binary: 64 * MEBI,
  dat: 2048 * MEBI,
  hdr: 512 * MEBI,
  exr: 512 * MEBI,
  obj: 128 * MEBI,
};

/** Blanks would end a word of a spec. */
function nameOf(file: File): string {
  return file.name.replace(/\s+/g, "_");
}

/** In a worker of its own, which goes with all its memory when it is done. */
function readElsewhere<T>(kind: FileKind, name: string, file: File): Promise<T> {
  const worker = new Worker(new URL("../workers/files.worker.ts", import.meta.url), { type: "module" });
  return new Promise<T>((resolve, reject) => {
    worker.onmessage = ({ data: { result, error } }: MessageEvent<FileAnswer>) =>
      error === undefined ? resolve(result as T) : reject(new Error(error));
    worker.onerror = event => reject(new Error(`${name}: cannot be read: ${event.message || "it is too large"}`));
    worker.postMessage({ kind, name, file } satisfies FileRequest);
  }).finally(() => worker.terminate());
}

/** An Error whose message can be shown; `known` finds a .brdf that was opened before. */
export async function openFile(file: File, known: (name: string) => MaterialFile | undefined): Promise<Opened> {
  const name = nameOf(file),
    kind = /\.(\w+)$/.exec(name)?.[1].toLowerCase() ?? "";
  if (!EXTENSIONS.includes(`.${kind}`))
    throw new Error(
      `${name}: is none of .brdf, .bparam (Disney's BRDF Explorer), .binary (MERL), .dat (MIT), .hdr, .exr (light from ` +
        "all around) and .obj (an object)",
    );
  if (file.size > MOST[kind])
    throw new Error(
      `${name}: has ${Math.ceil(file.size / MEBI)} MiB; a .${kind} file has at most ${MOST[kind] / MEBI}`,
    );
  const material = (brdf: MaterialFile): Opened => ({ is: "material", brdf });
  switch (kind) {
    case "hdr":
    case "exr":
      return { is: "light", name, environment: await readElsewhere<Environment>(kind, name, file) };
    case "obj":
      return { is: "object", name, shape: await readElsewhere<Shape>(kind, name, file) };
    case "dat":
      return material(new MitBrdf(name, await readElsewhere<MitData>(kind, name, file)));
    case "binary":
      return material(readMerl(name, await file.arrayBuffer()));
    case "brdf":
      return material(compileBrdf(readBrdf(name, await file.text())));
  }
  const { of, parameters } = readBparam(name, await file.text()),
    base = known(of.replace(/\s+/g, "_"));
  if (!(base instanceof ShaderBrdf)) throw new Error(`${name}: belongs to ${of}: drop that file first`);
  return material(
    base.withWords(parameters.map(one => `${one.name}=${one.initial.slice(0, one.kind === "colour" ? 3 : 1)}`)),
  );
}
