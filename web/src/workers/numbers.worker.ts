/* numbers.worker.ts: integrals that take longer than a frame, with a libfacet of its own.
 *
 * SPDX-License-Identifier: MIT */
import { instantiate, type Facet } from "../facet/library";
import type { Answer, Numbered, Request, Start } from "./messages";

let facet: Facet;

function answer(request: Request): unknown {
  switch (request.kind) {
    case "albedo":
      return facet.prepare(request.text).albedo(request.wo);
  }
}

self.onmessage = (event: MessageEvent<Start | Numbered>) => {
  const message = event.data;
  if ("kind" in message) {
    facet = instantiate(message.module);
    return;
  }
  let reply: Answer;
  try {
    reply = { number: message.number, result: answer(message.request) };
  } catch (error) {
    reply = { number: message.number, error: error instanceof Error ? error.message : String(error) };
  }
  self.postMessage(reply);
};
