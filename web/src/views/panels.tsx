/* panels.tsx: one panel for each visible material, with axes as SVG over a raster of cells.
 *
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import { useLayoutEffect, useRef } from "preact/hooks";
import type { Brdf } from "../brdf/brdf";
import { useAround } from "../session";
import { visibleEntries, type State } from "../state/state";
import { lineColour, type Theme } from "../state/theme";
import { Figure, useSize, type Size } from "./figure";

/** What a panel draws on: both layers fill it, and the raster is as fine as the screen. */
export interface Layers {
  readonly canvas: HTMLCanvasElement;
  readonly svg: SVGSVGElement;
  readonly size: Size;
  readonly theme: Theme;
}

/** Draws a material; what it gives back is written below, in words. */
export type DrawPanel = (layers: Layers, brdf: Brdf, place: number) => string;

function Panel({ brdf, place, draw }: { brdf: Brdf; place: number; draw: DrawPanel }): JSX.Element {
  const { theme } = useAround();
  const [room, size] = useSize<HTMLDivElement>();
  const canvas = useRef<HTMLCanvasElement>(null),
    svg = useRef<SVGSVGElement>(null),
    note = useRef<HTMLParagraphElement>(null);
  useLayoutEffect(() => {
    if (!size || size.width < 40 || size.height < 40) return;
    svg.current!.replaceChildren();
    const text = draw({ canvas: canvas.current!, svg: svg.current!, size, theme }, brdf, place);
    if (note.current!.textContent !== text) note.current!.textContent = text;
  });
  return (
    <div class="panel">
      <p class="panel-title">
        <i class="dot" style={{ background: lineColour(theme, place) }} />
        <span data-export-text>{brdf.label}</span>
      </p>
      <div class="room" ref={room}>
        <canvas ref={canvas} />
        <svg ref={svg} />
      </div>
      <p class="panel-note" ref={note} data-export-text />
    </div>
  );
}

export function Panels({ state, name, draw }: { state: State; name: string; draw: DrawPanel }): JSX.Element {
  const { session } = useAround();
  const shown = visibleEntries(state).flatMap(({ entry, place }) => {
    const { brdf } = session.resolve(entry);
    return brdf ? [{ entry, place, brdf }] : [];
  });
  return (
    <Figure name={name}>
      <div class="panels" data-count={Math.min(shown.length, 4)}>
        {shown.map(({ entry, place, brdf }) => (
          <Panel key={entry.id} brdf={brdf} place={place} draw={draw} />
        ))}
      </div>
    </Figure>
  );
}

/** Puts n x n cells, filled by `colour` as [r, g, b] of 0 to 255 from the top left, into a box of the canvas. */
export function paintCells(
  layers: Layers,
  box: { left: number; top: number; width: number; height: number },
  n: number,
  colour: (column: number, row: number) => readonly number[],
): void {
  const { canvas, size } = layers,
    ratio = devicePixelRatio || 1;
  canvas.width = Math.round(size.width * ratio);
  canvas.height = Math.round(size.height * ratio);
  canvas.style.width = `${size.width}px`;
  canvas.style.height = `${size.height}px`;
  const cells = new OffscreenCanvas(n, n),
    context = cells.getContext("2d")!,
    image = context.createImageData(n, n);
  for (let row = 0, at = 0; row < n; row++)
    for (let column = 0; column < n; column++, at += 4) {
      const [r, g, b] = colour(column, row);
      image.data[at] = r;
      image.data[at + 1] = g;
      image.data[at + 2] = b;
      image.data[at + 3] = 255;
    }
  context.putImageData(image, 0, 0);
  const to = canvas.getContext("2d")!;
  to.imageSmoothingEnabled = false;
  to.scale(ratio, ratio);
  to.drawImage(cells, box.left, box.top, box.width, box.height);
}
