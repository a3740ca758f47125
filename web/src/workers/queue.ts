/* queue.ts: requests to a worker, one at a time, so that what is no longer wanted is never begun.
 *
 * SPDX-License-Identifier: MIT */
import type { Answer, Request, Start } from "./messages";

interface Job {
  readonly request: Request;
  readonly signal: AbortSignal;
  resolve(result: unknown): void;
  reject(error: Error): void;
}

export class Queue {
  private readonly waiting: Job[] = [];
  private running: Job | undefined;
  private n_sent = 0;

  constructor(
    private readonly worker: Worker,
    module: WebAssembly.Module,
  ) {
    const checks = new URL(`./facet_checks.wasm?${FACET_STAMP}`, document.baseURI).href;
    worker.postMessage({ kind: "start", module, checks } satisfies Start);
    worker.onmessage = (event: MessageEvent<Answer>) => this.finish(event.data);
    worker.onerror = event => this.finish({ number: this.n_sent, error: event.message || "the worker failed" });
  }

  /** The answer; never settles if the signal aborts first. */
  ask<T>(request: Request, signal: AbortSignal): Promise<T> {
    return new Promise<T>((resolve, reject) => {
      this.waiting.push({ request, signal, resolve: result => resolve(result as T), reject });
      this.next();
    });
  }

  private next(): void {
    while (!this.running && this.waiting.length) {
      const job = this.waiting.shift()!;
      if (job.signal.aborted) continue;
      this.running = job;
      this.worker.postMessage({ number: ++this.n_sent, request: job.request });
    }
  }

  private finish(answer: Answer): void {
    const job = this.running;
    this.running = undefined;
    if (job && answer.error !== undefined) job.reject(new Error(answer.error));
    else if (job) job.resolve(answer.result);
    this.next();
  }
}

let numbers: Queue | undefined;
export function numbersQueue(module: WebAssembly.Module): Queue {
  numbers ??= new Queue(
    new Worker(new URL("./numbers.worker.ts", import.meta.url), { type: "module", name: "facet numbers" }),
    module,
  );
  return numbers;
}
