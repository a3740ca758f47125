/* numbers.worker.ts: integrals that take longer than a frame, with a libfacet of its own.
 *
 * SPDX-License-Identifier: MIT */
import { instantiate, type Facet } from "../facet/library";
import { Checks } from "../facet/checks";
import type { Answer, Numbered, Request, Start } from "./messages";

let facet: Facet;
let checksAt = "";
let loading: Promise<Checks> | undefined;

/** Loaded when it is first wanted. */
function checks(): Promise<Checks> {
  return (loading ??= Checks.load(checksAt));
}

async function answer(request: Request): Promise<unknown> {
  switch (request.kind) {
    case "albedo":
      return facet.prepare(request.text).albedo(request.wo);
    case "furnace":
      return (await checks()).furnace(request.text, request.wo);
    case "chi-square":
      return (await checks()).chiSquare(request.text, request.wo, request.n);
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
