/* curves.tsx: the view of curves, Cartesian or polar, with the value under the pointer.
 *
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import { useLayoutEffect, useRef, useState } from "preact/hooks";
import { plainLabel, type AxisSpec } from "../chart/axis";
import { drawChart, type ChartSpec, type Drawn, type Mark, type Series } from "../chart/chart";
import { drawPolar, type PolarDrawn } from "../chart/polar";
import { useAround } from "../session";
import { visibleEntries, type State } from "../state/state";
import { DASHES, lineColour } from "../state/theme";
import { useAlbedos, type AlbedoPoints } from "./albedo";
import { curveNames, curvePoints, isColoured, NoCurve, type Points } from "./curve_data";
import { Figure, useSize } from "./figure";
import { Legend, type LegendLine } from "./legend";

interface Computed {
  readonly series: Series[];
  readonly lines: LegendLine[];
}

function useCurves(state: State, albedos: AlbedoPoints): Computed {
  const { session, facet, theme } = useAround();
  const series: Series[] = [],
    lines: LegendLine[] = [];
  for (const { entry, place } of visibleEntries(state)) {
    const { brdf } = session.resolve(entry);
    if (!brdf) continue;
    let curves: (readonly [Points | undefined, string])[] = [],
      note: string | undefined;
    try {
      const own = lineColour(theme, place);
      if (state.channel === "colours" && isColoured(state.curve))
        curves = CHANNEL_COLOURS.map(([channel, colour]) => [curvePoints(facet, brdf, { ...state, channel }), colour]);
      else curves = [[state.curve === "albedo" ? albedos(brdf) : curvePoints(facet, brdf, state), own]];
      if (!curves[0][0]) note = "computing …";
    } catch (error) {
      if (!(error instanceof NoCurve)) throw error;
      note = error.message;
    }
    lines.push({ place, label: brdf.label, ...(note ? { note } : {}) });
    for (const [points, colour] of curves)
      if (points) series.push({ label: brdf.label, colour, dash: DASHES[place % DASHES.length], ...points });
  }
  return { series, lines };
}

function chartOf(state: State, series: readonly Series[], faint: string, ink: string): ChartSpec {
  const names = curveNames(state),
    { curve, isPolar, scale } = state;
  const isWide = series.some(one => one.x[0] < -90);
  const low = names.isPlane ? (isWide ? -180 : -90) : isPolar && isSymmetric(curve) ? -90 : 0;
  const marks: Mark[] = !names.isPlane
    ? []
    : [
        { x: -state.theta, label: state.fixed === "viewer" ? "ω_o" : "ω_i", colour: ink },
        ...(state.phi2 ? [] : [{ x: state.theta, label: "mirror", colour: faint }]),
      ];
  const isError = curve === "error";
  const y: AxisSpec = {
    label: scale === "shifted" ? `log_{10}(1 + ${names.y})` : names.y,
    scale: isError ? "linear" : scale,
    ...(scale === "linear" && (curve === "G1" || curve === "F") ? { low: 0, high: 1 } : {}),
  };
  return {
    x: { label: names.x, low, high: isWide && names.isPlane ? 180 : 90, ticks: ticksOf(low, isWide ? 180 : 90) },
    y,
    series,
    marks,
  };
}

/** Told apart by those who confuse red and green, since one of them is light. */
const CHANNEL_COLOURS = [
  ["red", "#d03a2b"],
  ["green", "#35b36a"],
  ["blue", "#3f7fe0"],
] as const;

function isSymmetric(curve: State["curve"]): boolean {
  return curve === "D" || curve === "Lambda" || curve === "G1" || curve === "F";
}

function ticksOf(low: number, high: number): number[] {
  const step = high - low > 180 ? 45 : high - low > 90 ? 30 : 15;
  return Array.from({ length: (high - low) / step + 1 }, (_, i) => low + i * step);
}

/** The value of a curve between its points. */
function valueAt(one: Series, x: number): number {
  let i = 1;
  while (i < one.x.length - 1 && one.x[i] < x) i++;
  const t = (x - one.x[i - 1]) / (one.x[i] - one.x[i - 1]);
  return t < -0.01 || t > 1.01 ? NaN : one.y[i - 1] + t * (one.y[i] - one.y[i - 1]);
}

interface Pointed {
  readonly angle: number;
  readonly left: number;
  readonly top: number;
}

function Tip({ at, series, width }: { at: Pointed; series: readonly Series[]; width: number }): JSX.Element {
  const isRight = at.left > width * 0.6;
  return (
    <div
      class="tip"
      style={{
        top: `${at.top}px`,
        ...(isRight ? { right: `${width - at.left + 14}px` } : { left: `${at.left + 14}px` }),
      }}
    >
      <b>{at.angle.toFixed(1)}°</b>
      {series.map((one, i) => (
        <span key={i}>
          <i style={{ background: one.colour }} />
          {Number.isFinite(valueAt(one, at.angle)) ? plainLabel(Number(valueAt(one, at.angle).toPrecision(4))) : "–"}
        </span>
      ))}
    </div>
  );
}

export function Curves({ state }: { state: State }): JSX.Element {
  const { theme, store } = useAround();
  const albedos = useAlbedos(state);
  const { series, lines } = useCurves(state, albedos);
  const [room, size] = useSize<HTMLDivElement>();
  const svg = useRef<SVGSVGElement>(null),
    drawn = useRef<Drawn | PolarDrawn | null>(null);
  const [pointed, setPointed] = useState<Pointed>();
  const canBePolar =
    state.curve !== "theta-h" && state.curve !== "theta-d" && state.curve !== "albedo" && state.curve !== "error";
  const isPolar = state.isPolar && canBePolar;
  const shown = isPolar ? state : { ...state, isPolar: false };
  const names = curveNames(state);

  useLayoutEffect(() => {
    if (!size || size.width < 40) return;
    const spec = chartOf(shown, series, theme.faint, theme.ink);
    drawn.current = (isPolar ? drawPolar : drawChart)(svg.current!, spec, size.width, size.height, theme);
  });

  const angleAt = (event: PointerEvent): number | undefined => {
    const at = drawn.current,
      rect = svg.current!.getBoundingClientRect();
    if (!at) return undefined;
    const x = event.clientX - rect.left,
      y = event.clientY - rect.top;
    if (!("box" in at)) return (Math.atan2(x - at.x, at.y - y) * 180) / Math.PI;
    return x < at.box.left || x > at.box.left + at.box.width ? undefined : at.x.invert(x);
  };
  const move = (event: PointerEvent): void => {
    const angle = angleAt(event),
      rect = svg.current!.getBoundingClientRect();
    if (event.buttons & 1 && names.isPlane && angle !== undefined)
      store.slide({ theta: Math.min(89.9, Math.round(Math.abs(angle) * 10) / 10) });
    setPointed(
      angle === undefined ? undefined : { angle, left: event.clientX - rect.left, top: event.clientY - rect.top },
    );
  };
  return (
    <Figure name={state.curve}>
      <div class="room" ref={room}>
        <svg
          ref={svg}
          role="img"
          aria-label={`${names.title}: ${names.y} over ${names.x}`}
          class={names.isPlane ? "can-drag" : ""}
          onPointerDown={event => {
            event.currentTarget.setPointerCapture(event.pointerId);
            move(event);
          }}
          onPointerMove={move}
          onPointerLeave={() => setPointed(undefined)}
        />
        {pointed && size && series.length > 0 && <Tip at={pointed} series={series} width={size.width} />}
      </div>
      <Legend lines={lines} />
    </Figure>
  );
}
