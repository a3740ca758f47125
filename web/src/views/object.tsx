/* object.tsx: an object under light from all around; drag turns it.
 *
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import { cameraAt } from "../gl/camera";
import { ObjectRenderer } from "../gl/objects";
import { useAround, type Session } from "../session";
import type { State } from "../state/state";
import { Tiles, type TileFrame, type TilePainter } from "./tiles";

/** Told apart by a number: files of the same name may differ. */
const numbers = new WeakMap<object, number>();
let nNumbers = 0;
function numberOf(one: object): number {
  let number = numbers.get(one);
  if (number === undefined) numbers.set(one, (number = ++nNumbers));
  return number;
}

export function missingFile(name: string): string {
  return `${name.replace(/^file:/, "")} is not in the address: drop the file here again`;
}

class Painter implements TilePainter {
  private readonly renderer: ObjectRenderer;
  state!: State;

  constructor(
    private readonly gl: WebGL2RenderingContext,
    private readonly session: Session,
  ) {
    this.renderer = new ObjectRenderer(gl);
  }

  paint({ jobs, size, ratio }: TileFrame): boolean {
    const { sampling, turn, tilt, exposure } = this.state,
      environment = this.session.environment(this.state),
      shape = this.session.shape(this.state);
    if (!environment || !shape) throw new Error(missingFile(environment ? this.state.object : this.state.environment));
    const tiles = jobs.map(({ box, brdf, shading }) => ({
      x: (box.left + box.side / 2) * ratio,
      y: (size.height - box.top - box.side / 2) * ratio,
      side: box.side * ratio,
      ...{ brdf, shading },
    }));
    const places = tiles.map(({ x, y, side, brdf }) => [x, y, side, brdf.text]);
    const isDone = this.renderer.draw({
      key: JSON.stringify([places, numberOf(environment), numberOf(shape), sampling, turn, tilt]),
      tiles,
      ...{ shape, environment },
      sampling,
      camera: cameraAt(turn, tilt),
      exposure: 2 ** exposure,
    });
    (this.gl.canvas as HTMLCanvasElement).dataset.samples = String(this.renderer.samples);
    return isDone;
  }
}

export function LitObject({ state }: { state: State }): JSX.Element {
  const { session, store } = useAround();
  const turnBy = (across: number, down: number): void => {
    const { turn, tilt } = store.state;
    store.slide({ turn: (((turn - across) % 360) + 360) % 360, tilt: Math.min(90, Math.max(-90, tilt + down)) });
  };
  return (
    <Tiles
      state={state}
      name="object"
      label="lit objects; drag or arrow keys turn them"
      make={gl => new Painter(gl, session)}
      paintAgain={(painter, frame) => {
        (painter as Painter).state = state;
        return painter.paint(frame);
      }}
      drag={(dx, dy) => turnBy(0.5 * dx, 0.5 * dy)}
      keys={event => {
        const step = { ArrowLeft: [-5, 0], ArrowRight: [5, 0], ArrowUp: [0, -5], ArrowDown: [0, 5] }[event.key];
        if (!step) return;
        event.preventDefault();
        turnBy(step[0], step[1]);
      }}
    />
  );
}
