/* numbers.worker.ts: integrals that take longer than a frame, with a libfacet of its own.
 *
 * SPDX-License-Identifier: MIT */
import { chiSquareOf } from "../brdf/chi_square";
import { TableSampler } from "../brdf/table_sampler";
import { instantiate, type Facet } from "../facet/library";
import { Checks } from "../facet/checks";
import type { Answer, ChiSquareAnswer, Numbered, Request, Start } from "./messages";

let facet: Facet;
let checksAt = "";
let loading: Promise<Checks> | undefined;

/** Loaded when it is first wanted. */
function checks(): Promise<Checks> {
  return (loading ??= Checks.load(checksAt));
}

/** One test in a hundred fails by chance: a failure counts if other samples fail, too. */
function twice(test: (seed: number) => ChiSquareAnswer | undefined): ChiSquareAnswer | undefined {
  const first = test(1),
    isSecond = first !== undefined && first.p < first.level,
    last = isSecond ? test(2) : first;
  return last && { ...last, isSecond };
}

async function answer(request: Request): Promise<unknown> {
  switch (request.kind) {
    case "albedo":
      return facet.prepare(request.text).albedo(request.wo);
    case "furnace":
      return (await checks()).furnace(request.text, request.wo);
    case "chi-square": {
      const loaded = await checks();
      return twice(seed => loaded.chiSquare(request.text, request.wo, request.n, seed));
    }
    case "table-chi-square": {
      const sampler = new TableSampler(request.tables);
      return twice(seed => chiSquareOf(sampler, request.wo, request.n, seed));
    }
  }
}

self.onmessage = async (event: MessageEvent<Start | Numbered>) => {
  const message = event.data;
  if ("kind" in message) {
    facet = instantiate(message.module);
    checksAt = message.checks;
    return;
  }
  let reply: Answer;
  try {
    reply = { number: message.number, result: await answer(message.request) };
  } catch (error) {
    reply = { number: message.number, error: error instanceof Error ? error.message : String(error) };
  }
  self.postMessage(reply);
};
