/* lobe.tsx: the lobes of all visible materials in three dimensions; drag turns them, or the direction that is fixed.
 *
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";
import { DEGREE, direction, type Vector } from "../brdf/angles";
import { plainLabel } from "../chart/axis";
import { clear } from "../chart/chart";
import { addText, type Group } from "../chart/formula";
import { cameraAt, project, type Camera } from "../gl/camera";
import { closeGl, fitCanvas, NO_GL, openGl } from "../gl/context";
import { LobeRenderer, type Surface } from "../gl/lobes";
import { useAround } from "../session";
import { visibleEntries, type State } from "../state/state";
import { lineColour, type Theme } from "../state/theme";
import { Figure, useSize, type Size } from "./figure";
import { Legend } from "./legend";
import { lobeMesh, MESH_INDICES } from "./lobe_mesh";

export function rgbOf(hex: string): number[] {
  return [1, 3, 5].map(i => parseInt(hex.slice(i, i + 2), 16) / 255);
}

interface Frame {
  readonly camera: Camera;
  readonly centre: readonly [number, number];
  readonly scale: number;
}

/** Where the origin is and how long 1 is: the half space above fills the room. */
function frameOf(state: State, size: Size, hasBelow: boolean): Frame {
  const scale = hasBelow
    ? Math.min(size.width / 2.3, size.height / 2.3)
    : Math.min(size.width / 2.3, size.height / 1.5);
  const centre = [size.width / 2, hasBelow ? size.height / 2 : size.height * 0.76] as const;
  return { camera: cameraAt(state.turn, state.tilt), centre, scale };
}

function line(root: Group, from: number[], to: number[], colour: string, dash = ""): void {
  root
    .append("line")
    .attr("x1", from[0])
    .attr("y1", from[1])
    .attr("x2", to[0])
    .attr("y2", to[1])
    .attr("stroke", colour)
    .attr("stroke-width", 1.4)
    .attr("stroke-dasharray", dash || null);
}

function drawLabels(svg: SVGSVGElement, size: Size, frame: Frame, state: State, theme: Theme): void {
  const root = clear(svg, size.width, size.height),
    at = (v: Vector): [number, number] => project(frame.camera, v, frame.centre, frame.scale);
  const still = direction(-state.theta, state.phi),
    mirror = direction(state.theta, state.phi);
  line(root, at([0, 0, 0]), at([0, 0, 1.02]), theme.faint);
  line(root, at([0, 0, 0]), at(mirror), theme.faint, "2 4");
  line(root, at([0, 0, 0]), at(still), theme.ink);
  const name = (v: Vector, text: string, ink: string): void => {
    const [x, y] = at(v.map(c => 1.08 * c) as Vector);
    addText(root, text, { x, y: y + 4, ink, anchor: "middle", size: 13 });
  };
  name([0, 0, 1], "n", theme.faint);
  name([1, 0, 0], "x", theme.faint);
  name([0, 1, 0], "y", theme.faint);
  const [x, y] = at(still);
  root
    .append("circle")
    .attr("cx", x)
    .attr("cy", y)
    .attr("r", 6)
    .attr("fill", theme.page)
    .attr("stroke", theme.ink)
    .attr("stroke-width", 2);
  name(still.map(c => 1.03 * c) as Vector, state.fixed === "viewer" ? "ω_o" : "ω_i", theme.ink);
}

/** theta and phi of the direction whose handle is at this place, on the half sphere towards the eye. */
function directionAt(frame: Frame, x: number, y: number): { theta: number; phi: number } | undefined {
  const a = (x - frame.centre[0]) / frame.scale,
    b = (frame.centre[1] - y) / frame.scale,
    rest = 1 - a * a - b * b;
  const depth = Math.sqrt(Math.max(rest, 0)),
    { right, up, out } = frame.camera;
  const make = (c: number): Vector => [0, 1, 2].map(k => a * right[k] + b * up[k] + c * out[k]) as Vector;
  const v = [make(depth), make(-depth)].find(one => one[2] > 0.002);
  if (!v) return undefined;
  const theta = Math.min(89.9, Math.acos(Math.min(1, v[2] / Math.hypot(...v))) / DEGREE);
  const phi = (Math.atan2(-v[1], -v[0]) / DEGREE + 360) % 360;
  return { theta: Math.round(theta * 10) / 10, phi: Math.round(phi) % 360 };
}

export function Lobe({ state }: { state: State }): JSX.Element {
  const { session, store, theme } = useAround();
  const [room, size] = useSize<HTMLDivElement>();
  const canvas = useRef<HTMLCanvasElement>(null),
    svg = useRef<SVGSVGElement>(null),
    frame = useRef<Frame | null>(null);
  const painter = useRef<{ gl: WebGL2RenderingContext; lobes: LobeRenderer } | null | undefined>(undefined);
  const grabbed = useRef<"handle" | "view" | undefined>(undefined);
  useEffect(() => () => closeGl(painter.current?.gl), []);
  const shown = visibleEntries(state).flatMap(({ entry, place }) => {
    const { brdf } = session.resolve(entry);
    return brdf ? [{ place, brdf, mesh: lobeMesh(brdf, state) }] : [];
  });
  const largest = Math.max(...shown.map(one => one.mesh.largest), 1e-30);
  const hasBelow = shown.some(({ brdf }) => "transmits" in brdf && brdf.transmits === true);

  useLayoutEffect(() => {
    if (!size || size.width < 40) return;
    if (painter.current === undefined) {
      const gl = openGl(canvas.current!);
      painter.current = gl ? { gl, lobes: new LobeRenderer(gl, MESH_INDICES) } : null;
    }
    if (!painter.current) return;
    fitCanvas(canvas.current!, size.width, size.height);
    const view = (frame.current = frameOf(state, size, hasBelow));
    const scale = [(2 * view.scale) / size.width, (2 * view.scale) / size.height];
    const shift = [(2 * view.centre[0]) / size.width - 1, 1 - (2 * view.centre[1]) / size.height];
    const surfaces: Surface[] = shown
      .slice()
      .sort((a, b) => b.mesh.largest - a.mesh.largest)
      .map(({ mesh, place }) => ({
        positions: mesh.positions,
        size: 1 / largest,
        colour: rgbOf(lineColour(theme, place)),
      }));
    painter.current.lobes.draw(view.camera, scale, shift, surfaces, rgbOf(theme.faint));
    drawLabels(svg.current!, size, view, state, theme);
  });

  const down = (event: PointerEvent & { currentTarget: SVGSVGElement }): void => {
    const rect = event.currentTarget.getBoundingClientRect(),
      view = frame.current;
    if (!view) return;
    const [x, y] = project(view.camera, direction(-state.theta, state.phi), view.centre, view.scale);
    const isNear = Math.hypot(event.clientX - rect.left - x, event.clientY - rect.top - y) < 22;
    grabbed.current = isNear ? "handle" : "view";
    event.currentTarget.setPointerCapture(event.pointerId);
  };
  const move = (event: PointerEvent & { currentTarget: SVGSVGElement }): void => {
    if (!grabbed.current || !frame.current || !(event.buttons & 1)) return;
    if (grabbed.current === "handle") {
      const rect = event.currentTarget.getBoundingClientRect();
      const at = directionAt(frame.current, event.clientX - rect.left, event.clientY - rect.top);
      if (at) store.slide(at);
    } else turnBy(event.movementX * 0.5, event.movementY * 0.5);
  };
  const turnBy = (across: number, down: number): void => {
    const { turn, tilt } = store.state;
    store.slide({ turn: (((turn - across) % 360) + 360) % 360, tilt: Math.min(90, Math.max(-90, tilt + down)) });
  };
  const keys = (event: KeyboardEvent): void => {
    const step = { ArrowLeft: [-5, 0], ArrowRight: [5, 0], ArrowUp: [0, -5], ArrowDown: [0, 5] }[event.key];
    if (!step) return;
    event.preventDefault();
    turnBy(step[0], step[1]);
  };
  const what = state.hasCosine ? "f cos θᵢ" : "f";
  const length = state.scale === "linear" ? what : `log₁₀(1 + ${what})`;
  return (
    <Figure name="lobe">
      <div class="room" ref={room}>
        <canvas ref={canvas} />
        <svg
          ref={svg}
          class="can-turn"
          role="application"
          tabindex={0}
          aria-label="lobes; arrow keys turn the view"
          onKeyDown={keys}
          onPointerDown={down}
          onPointerMove={move}
          onPointerUp={() => (grabbed.current = undefined)}
        />
        {painter.current === null && <p class="problem">{NO_GL}</p>}
        <p class="panel-note corner" data-export-text>
          length: {length}, at most {plainLabel(Number(largest.toPrecision(3)))}
          {state.scale === "linear" ? "/sr" : ""}
        </p>
      </div>
      <Legend lines={shown.map(({ place, brdf }) => ({ place, label: brdf.label }))} />
    </Figure>
  );
}
