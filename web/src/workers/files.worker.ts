/* files.worker.ts: reads one large file, so that the page goes on meanwhile; it is used once.
 *
 * SPDX-License-Identifier: MIT */
import { readExr } from "../files/exr";
import { readHdr } from "../files/hdr";
import { readMit } from "../files/mit";
import { readObj } from "../files/obj";

export type FileKind = "hdr" | "exr" | "obj" | "dat";

export interface FileRequest {
  readonly kind: FileKind;
  readonly name: string;
  readonly file: Blob;
}
export interface FileAnswer {
  readonly result?: unknown;
  readonly error?: string;
}

const READERS: Record<FileKind, (name: string, file: Blob) => Promise<unknown>> = {
  hdr: async (name, file) => readHdr(name, await file.arrayBuffer()),
  exr: async (name, file) => readExr(name, await file.arrayBuffer()),
  obj: async (name, file) => readObj(name, await file.text()),
  dat: readMit,
};

self.onmessage = async ({ data: { kind, name, file } }: MessageEvent<FileRequest>) => {
  let answer: FileAnswer;
  try {
    answer = { result: await READERS[kind](name, file) };
  } catch (error) {
    const isOurs = error instanceof Error && error.message.startsWith(name);
    answer = {
      error: isOurs ? error.message : `${name}: cannot be read: ${String((error as Error).message ?? error)}`,
    };
  }
  self.postMessage(answer);
};
