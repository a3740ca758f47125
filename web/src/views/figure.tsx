/* figure.tsx: the frame of every view, which measures its room.
 *
 * SPDX-License-Identifier: MIT */
import type { ComponentChildren, JSX } from "preact";
import { useLayoutEffect, useRef, useState } from "preact/hooks";

export interface Size {
  readonly width: number;
  readonly height: number;
}

/** The room that the element has; nothing is drawn before it is known. */
export function useSize<T extends HTMLElement>(): [{ current: T | null }, Size | undefined] {
  const ref = useRef<T>(null);
  const [size, setSize] = useState<Size>();
  useLayoutEffect(() => {
    const element = ref.current!;
    const measure = (): void => {
      const { clientWidth: width, clientHeight: height } = element;
      setSize(old => (old && old.width === width && old.height === height ? old : { width, height }));
    };
    const observer = new ResizeObserver(measure);
    observer.observe(element);
    measure();
    return () => observer.disconnect();
  }, []);
  return [ref, size];
}

/** `name` becomes that of the file that the view is saved in. */
export function Figure({ name, children }: { name: string; children: ComponentChildren }): JSX.Element {
  return (
    <figure class="figure" data-figure={name}>
      {children}
    </figure>
  );
}
