/* sphere.tsx: the lit sphere; drag moves the light.
 *
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import { DEGREE, type Vector } from "../brdf/angles";
import { SphereRenderer, type Lighting } from "../gl/spheres";
import { useAround } from "../session";
import type { State } from "../state/state";
import { Tiles, type TileFrame, type TilePainter } from "./tiles";

/** To the light, with the viewer at z: at `theta` from it, `phi` counted from the right. */
export function sphereLight(state: State): Vector {
  const t = state.lightTheta * (state.isDoubled ? 2 : 1) * DEGREE,
    p = state.lightPhi * DEGREE;
  return [Math.sin(t) * Math.cos(p), Math.sin(t) * Math.sin(p), Math.cos(t)];
}

/** The light has the irradiance pi, so that a white Lambertian surface is white. */
export function sphereLighting(state: State): Lighting {
  return { light: sphereLight(state), exposure: Math.PI * 2 ** state.exposure, hasCosine: state.hasCosine };
}

class Painter implements TilePainter {
  lighting: Lighting = { light: [0, 0, 1], exposure: 1, hasCosine: true };
  private readonly renderer: SphereRenderer;

  constructor(gl: WebGL2RenderingContext) {
    this.renderer = new SphereRenderer(gl);
  }

  paint({ jobs, size, ratio }: TileFrame): boolean {
    this.renderer.clear();
    let isDone = true;
    for (const { box, brdf, shading } of jobs) {
      const tile = {
        x: (box.left + box.side / 2) * ratio,
        y: (size.height - box.top - box.side / 2) * ratio,
        radius: 0.47 * box.side * ratio,
      };
      isDone = this.renderer.draw(tile, shading, brdf, this.lighting) && isDone;
    }
    return isDone;
  }
}

export function Sphere({ state }: { state: State }): JSX.Element {
  const { store } = useAround();
  const turn = (dx: number, dy: number): void => {
    const { lightTheta, lightPhi } = store.state;
    store.slide({ lightTheta: Math.min(180, Math.max(0, lightTheta + dy)), lightPhi: (lightPhi + dx + 360) % 360 });
  };
  return (
    <Tiles
      state={state}
      name="sphere"
      label="lit spheres; drag or arrow keys move the light"
      make={gl => new Painter(gl)}
      paintAgain={(painter, frame) => {
        (painter as Painter).lighting = sphereLighting(state);
        return painter.paint(frame);
      }}
      drag={(_dx, _dy, box, x, y) => {
        const px = (x - box.left - box.side / 2) / (0.47 * box.side),
          py = (box.top + box.side / 2 - y) / (0.47 * box.side);
        const theta = Math.asin(Math.min(1, Math.hypot(px, py))) / DEGREE;
        store.slide({
          lightTheta: Math.round(theta * 10) / 10,
          lightPhi: Math.round((Math.atan2(py, px) / DEGREE + 360) % 360),
        });
      }}
      keys={event => {
        const step = { ArrowLeft: [5, 0], ArrowRight: [-5, 0], ArrowUp: [0, -5], ArrowDown: [0, 5] }[event.key];
        if (!step) return;
        event.preventDefault();
        turn(step[0], step[1]);
      }}
    />
  );
}
