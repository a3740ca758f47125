/* tiles.tsx: one WebGL canvas for all visible materials, a tile each, with their names below.
 *
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";
import type { Brdf } from "../brdf/brdf";
import { closeGl, fitCanvas, NO_GL, openGl } from "../gl/context";
import { shadingOf, type Shading } from "../gl/shading";
import { useAround } from "../session";
import { visibleEntries, type State } from "../state/state";
import { lineColour } from "../state/theme";
import { Figure, useSize, type Size } from "./figure";

/** In CSS pixels from the upper left. */
export interface TileBox {
  readonly left: number;
  readonly top: number;
  readonly side: number;
}

export interface TileJob {
  readonly box: TileBox;
  readonly brdf: Brdf;
  readonly shading: Shading;
}

export interface TileFrame {
  readonly jobs: readonly TileJob[];
  readonly size: Size;
  /** Canvas pixels for a CSS pixel. */
  readonly ratio: number;
}

export interface TilePainter {
  /** False if it wants to be asked again in the next frame. */
  paint(frame: TileFrame): boolean;
}

const NAME_HEIGHT = 34;

/** As many columns as make the squares largest. */
export function tileBoxes(n: number, { width, height }: Size): TileBox[] {
  let best = { columns: 1, side: 0 };
  for (let columns = 1; columns <= n; columns++) {
    const side = Math.min(width / columns, height / Math.ceil(n / columns) - NAME_HEIGHT);
    if (side > best.side) best = { columns, side };
  }
  const { columns } = best,
    side = Math.floor(best.side),
    rows = Math.ceil(n / columns);
  const across = width / columns,
    down = height / rows;
  return Array.from({ length: n }, (_, i) => ({
    left: Math.floor((i % columns) * across + (across - side) / 2),
    top: Math.floor(Math.floor(i / columns) * down + Math.max(0, (down - NAME_HEIGHT - side) / 2)),
    side,
  }));
}

/** The shadings that are there; the component is drawn again as more of them are. */
function useShadings(brdfs: readonly Brdf[]): Map<Brdf, Shading> {
  const [, again] = useState(0);
  const ready = useRef(new WeakMap<Brdf, Shading>());
  for (const brdf of brdfs)
    if (!ready.current.has(brdf))
      void shadingOf(brdf).then(shading => {
        ready.current.set(brdf, shading);
        again(n => n + 1);
      });
  return new Map(brdfs.flatMap(brdf => (ready.current.has(brdf) ? [[brdf, ready.current.get(brdf)!] as const] : [])));
}

interface TilesProps {
  readonly state: State;
  readonly name: string;
  readonly label: string;
  make(gl: WebGL2RenderingContext): TilePainter;
  paintAgain(painter: TilePainter, frame: TileFrame): boolean;
  drag?(across: number, down: number, box: TileBox, x: number, y: number): void;
  keys?(event: KeyboardEvent): void;
}

export function Tiles(props: TilesProps): JSX.Element {
  const { session, theme } = useAround();
  const [room, size] = useSize<HTMLDivElement>();
  const canvas = useRef<HTMLCanvasElement>(null);
  const made = useRef<{ gl: WebGL2RenderingContext; painter: TilePainter } | null | undefined>(undefined);
  const [problem, setProblem] = useState("");
  const shown = visibleEntries(props.state).flatMap(({ entry, place }) => {
    const { brdf } = session.resolve(entry);
    return brdf ? [{ entry, place, brdf }] : [];
  });
  const shadings = useShadings(shown.map(one => one.brdf));
  const boxes = size ? tileBoxes(shown.length, size) : [];
  useEffect(() => () => closeGl(made.current?.gl), []);

  useLayoutEffect(() => {
    if (!size || size.width < 40 || size.height < 60) return undefined;
    if (made.current === undefined) {
      const gl = openGl(canvas.current!);
      made.current = gl ? { gl, painter: props.make(gl) } : null;
    }
    if (!made.current) {
      setProblem(NO_GL);
      return undefined;
    }
    const { painter } = made.current,
      ratio = fitCanvas(canvas.current!, size.width, size.height);
    const jobs = shown.flatMap(({ brdf }, i) => {
      const shading = shadings.get(brdf);
      return shading ? [{ box: boxes[i], brdf, shading }] : [];
    });
    let timer = 0;
    const step = (): void => {
      try {
        if (!props.paintAgain(painter, { jobs, size, ratio })) timer = requestAnimationFrame(step);
        else canvas.current!.dataset.isDone = String(jobs.length === shown.length);
        setProblem("");
      } catch (error) {
        setProblem(error instanceof Error ? error.message : String(error));
      }
    };
    canvas.current!.dataset.isDone = "false";
    step();
    return () => cancelAnimationFrame(timer);
  });

  const point = (event: PointerEvent & { currentTarget: HTMLElement }): void => {
    if (!(event.buttons & 1)) return;
    const rect = event.currentTarget.getBoundingClientRect(),
      x = event.clientX - rect.left,
      y = event.clientY - rect.top;
    const box = boxes.find(one => x >= one.left && x <= one.left + one.side && y >= one.top && y <= one.top + one.side);
    if (box) props.drag?.(event.movementX, event.movementY, box, x, y);
  };
  return (
    <Figure name={props.name}>
      <div
        class="room tiles"
        ref={room}
        tabIndex={0}
        role="application"
        aria-label={props.label}
        onKeyDown={event => props.keys?.(event)}
        onPointerDown={event => {
          event.currentTarget.setPointerCapture(event.pointerId);
          point(event);
        }}
        onPointerMove={point}
      >
        <canvas ref={canvas} />
        {shown.map(({ entry, place, brdf }, i) => (
          <p
            key={entry.id}
            class="tile-name"
            data-box={JSON.stringify(boxes[i] ?? null)}
            style={
              boxes[i] && {
                left: `${boxes[i].left}px`,
                top: `${boxes[i].top + boxes[i].side + 6}px`,
                width: `${boxes[i].side}px`,
              }
            }
          >
            <i class="dot" style={{ background: lineColour(theme, place) }} />
            <span data-export-text>{brdf.label}</span>
          </p>
        ))}
        {problem && (
          <p class="problem" role="alert">
            {problem}
          </p>
        )}
      </div>
    </Figure>
  );
}
