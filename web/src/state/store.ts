/* store.ts: the state, who is told of changes, and the address that follows it.
 *
 * SPDX-License-Identifier: MIT */
import type { State } from "./state";
import { stateFromHash, stateToHash } from "./url";

export type Change = Partial<State>;

export class Store {
  state: State = stateFromHash(location.hash);
  private readonly listeners = new Set<() => void>();
  private pending = 0;
  private timer = 0;

  constructor() {
    addEventListener("popstate", () => {
      this.state = stateFromHash(location.hash);
      this.tell();
    });
  }

  /** Slides: the last place in the history is written over, a moment after the last change. */
  slide(change: Change): void {
    this.state = { ...this.state, ...change };
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => history.replaceState(null, "", stateToHash(this.state)), 150);
    this.tell();
  }

  /** Steps: the reader can go back to what was. */
  step(change: Change): void {
    clearTimeout(this.timer);
    const before = stateToHash(this.state);
    if (location.hash !== before) history.replaceState(null, "", before);
    this.state = { ...this.state, ...change };
    const hash = stateToHash(this.state);
    if (hash !== before) history.pushState(null, "", hash);
    this.tell();
  }

  listen(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  /** Many changes between two frames make one picture. */
  tell(): void {
    if (this.pending) return;
    this.pending = requestAnimationFrame(() => {
      this.pending = 0;
      for (const listener of this.listeners) listener();
    });
  }
}
