/* store.ts: the state, who is told of changes, and the address that follows it.
 *
 * SPDX-License-Identifier: MIT */
import type { State } from "./state";
import { stateFromHash, stateToHash } from "./url";

export type Change = Partial<State>;

/* The address follows a slide at this pace, for browsers refuse many changes in a row; a slide by keys ends after a rest. */
const PACE = 150,
  REST = 1000; // ms

export class Store {
  state: State = stateFromHash(location.hash);
  private readonly listeners = new Set<() => void>();
  private pending = 0;
  private timer = 0;
  private rest = 0;
  private isSliding = false;
  private isPressed = false;

  constructor() {
    addEventListener("popstate", () => {
      // What a slide has yet to write belongs to the entry that was left.
      clearTimeout(this.timer);
      this.timer = 0;
      this.endSlide();
      this.state = stateFromHash(location.hash);
      this.tell();
    });
    const press = (isPressed: boolean) => (): void => {
      this.isPressed = isPressed;
      this.endSlide();
    };
    addEventListener("pointerdown", press(true), true);
    for (const name of ["pointerup", "pointercancel", "blur"]) addEventListener(name, press(false));
    addEventListener("focusout", () => this.endSlide());
  }

  /** A slide is one step, however many changes it has: it ends where the pointer is let go, the focus goes elsewhere, or
   *  keys rest. */
  slide(change: Change): void {
    const before = stateToHash(this.state);
    this.state = { ...this.state, ...change };
    if (this.isSliding) this.timer ||= window.setTimeout(() => this.write(), PACE);
    else if (stateToHash(this.state) !== before) {
      this.isSliding = true;
      this.push(before);
    }
    clearTimeout(this.rest);
    if (!this.isPressed) this.rest = window.setTimeout(() => this.endSlide(), REST);
    this.tell();
  }

  /** The reader can go back to what was. */
  step(change: Change): void {
    this.endSlide();
    const before = stateToHash(this.state);
    this.state = { ...this.state, ...change };
    if (stateToHash(this.state) !== before) this.push(before);
    this.tell();
  }

  private push(before: string): void {
    if (location.hash !== before) history.replaceState(null, "", before);
    history.pushState(null, "", stateToHash(this.state));
  }

  private write(): void {
    clearTimeout(this.timer);
    this.timer = 0;
    history.replaceState(null, "", stateToHash(this.state));
  }

  private endSlide(): void {
    clearTimeout(this.rest);
    if (this.timer) this.write();
    this.isSliding = false;
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
