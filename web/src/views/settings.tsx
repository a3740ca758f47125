/* settings.tsx: the settings that the view at hand has, above it.
 *
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import { Amount, Check, Choice, Menu } from "../panel/controls";
import { useAround } from "../session";
import { isColoured } from "./curve_data";
import { DEFAULTS, ENVIRONMENTS, OBJECTS, type Channel, type Curve, type Scale, type State } from "../state/state";

const CURVE_NAMES: readonly (readonly [Curve, string])[] = [
  ["D", "D: normals"],
  ["Lambda", "Λ: Smith's function"],
  ["G1", "G₁: masking"],
  ["F", "F: Fresnel"],
  ["f", "f over θ (theta-v)"],
  ["fcos", "f cos θ over θ"],
  ["pdf", "pdf of the sampler"],
  ["theta-h", "f over θ_h"],
  ["theta-d", "f over θ_d"],
  ["albedo", "albedo"],
  ["error", "error of the published masking"],
];
const SCALE_NAMES: readonly (readonly [Scale, string])[] = [
  ["linear", "linear"],
  ["log", "log"],
  ["shifted", "log(1+y)"],
];
const CHANNEL_NAMES: readonly (readonly [Channel, string])[] = [
  ["luminance", "luminance"],
  ["red", "red"],
  ["green", "green"],
  ["blue", "blue"],
];
/** An angle of the state with its slider. */
type AngleKey =
  | "theta"
  | "phi"
  | "theta2"
  | "phi2"
  | "thetaH"
  | "thetaD"
  | "phiD"
  | "exposure"
  | "lightTheta"
  | "lightPhi"
  | "turn"
  | "tilt";

export function Angle(props: {
  state: State;
  of: AngleKey;
  label: string;
  low: number;
  high: number;
  unit?: string;
  step?: number;
}): JSX.Element {
  const { store } = useAround(),
    { of } = props;
  return (
    <Amount
      label={props.label}
      unit={props.unit ?? "°"}
      low={props.low}
      high={props.high}
      step={props.step ?? 0.1}
      value={props.state[of]}
      initial={DEFAULTS[of]}
      set={value => store.slide({ [of]: value })}
    />
  );
}

function CurveSettings({ state }: { state: State }): JSX.Element {
  const { store } = useAround(),
    { curve } = state;
  return (
    <>
      <Menu label="curve" value={curve} values={CURVE_NAMES} set={next => store.step({ curve: next })} />
      {curve === "error" ? (
        <Choice
          label="of"
          value={state.errorOf}
          values={[
            ["G1", "G₁"],
            ["Lambda", "Λ"],
            ["f", "f"],
          ]}
          set={errorOf => store.step({ errorOf })}
        />
      ) : (
        <Choice label="scale" value={state.scale} values={SCALE_NAMES} set={scale => store.step({ scale })} />
      )}
      {["D", "Lambda", "G1", "F", "f", "fcos", "pdf"].includes(curve) && (
        <Choice
          label="axes"
          value={state.isPolar ? "polar" : "Cartesian"}
          values={[
            ["Cartesian", "Cartesian"],
            ["polar", "polar"],
          ]}
          set={axes => store.step({ isPolar: axes === "polar" })}
        />
      )}
      {curve === "theta-h" && <Angle state={state} of="thetaD" label="θd" low={0} high={90} />}
      {curve === "theta-d" && <Angle state={state} of="thetaH" label="θh" low={0} high={90} />}
      {(curve === "theta-h" || curve === "theta-d") && <Angle state={state} of="phiD" label="φd" low={0} high={180} />}
    </>
  );
}

function LobeSettings({ state }: { state: State }): JSX.Element {
  const { store } = useAround();
  return (
    <>
      <Choice
        label="scale"
        value={state.scale === "linear" ? "linear" : "shifted"}
        values={[SCALE_NAMES[0], SCALE_NAMES[2]]}
        set={scale => store.step({ scale })}
      />
      <Check label="times cos θᵢ" value={state.hasCosine} set={hasCosine => store.step({ hasCosine })} />
      <Angle state={state} of="turn" label="turn" low={0} high={360} step={1} />
      <Angle state={state} of="tilt" label="tilt" low={-90} high={90} step={1} />
    </>
  );
}

function SliceSettings({ state }: { state: State }): JSX.Element {
  const { store } = useAround();
  return (
    <>
      <Angle state={state} of="phiD" label="φd" low={0} high={180} />
      <Angle state={state} of="exposure" label="exposure" low={-6} high={6} unit="stops" />
      <Check label="square θh" value={state.hasSquareThetaH} set={value => store.step({ hasSquareThetaH: value })} />
      <Check label="chroma" value={state.hasChroma} set={hasChroma => store.step({ hasChroma })} />
    </>
  );
}

function SphereSettings({ state }: { state: State }): JSX.Element {
  const { store } = useAround();
  return (
    <>
      <Angle state={state} of="lightTheta" label="light θ" low={0} high={180} />
      <Angle state={state} of="lightPhi" label="light φ" low={0} high={360} step={1} />
      <Check label="double θ" value={state.isDoubled} set={isDoubled => store.step({ isDoubled })} />
      <Check label="times cos θᵢ" value={state.hasCosine} set={hasCosine => store.step({ hasCosine })} />
      <Angle state={state} of="exposure" label="exposure" low={-6} high={6} unit="stops" />
    </>
  );
}

const SAMPLING_NAMES: readonly (readonly [State["sampling"], string])[] = [
  ["both", "light and material"],
  ["light", "light"],
  ["material", "material"],
];

function ObjectSettings({ state }: { state: State }): JSX.Element {
  const { session, store } = useAround();
  return (
    <>
      <Menu
        label="light"
        value={state.environment}
        values={session.choices(ENVIRONMENTS, "environment", state)}
        set={environment => store.step({ environment })}
      />
      {state.view === "object" && (
        <>
          <Menu
            label="object"
            value={state.object}
            values={session.choices(OBJECTS, "object", state)}
            set={object => store.step({ object })}
          />
          <Menu
            label="directions by"
            value={state.sampling}
            values={SAMPLING_NAMES}
            set={sampling => store.step({ sampling })}
          />
          <Angle state={state} of="turn" label="turn" low={0} high={360} step={1} />
          <Angle state={state} of="tilt" label="tilt" low={-90} high={90} step={1} />
        </>
      )}
      <Angle state={state} of="exposure" label="exposure" low={-6} high={6} unit="stops" />
    </>
  );
}

function CountSettings({ state }: { state: State }): JSX.Element {
  const { store } = useAround(),
    factor = state.view === "checks" ? 20 : 1;
  return (
    <Amount
      label="samples"
      unit=""
      low={100 * factor}
      high={10000 * factor}
      step={100 * factor}
      value={state.samples * factor}
      initial={DEFAULTS.samples * factor}
      set={n => store.slide({ samples: Math.round(n / factor) })}
    />
  );
}

/** The two directions that all views and the numbers share. */
export function Directions({ state }: { state: State }): JSX.Element {
  const { store } = useAround(),
    [still, moving] = state.fixed === "viewer" ? ["ₒ", "ᵢ"] : ["ᵢ", "ₒ"];
  return (
    <div class="directions-line settings-line" role="group" aria-label="directions">
      <Choice
        label="fixed"
        value={state.fixed}
        values={[
          ["viewer", "viewer"],
          ["light", "light"],
        ]}
        set={fixed => store.step({ fixed })}
      />
      <Angle state={state} of="theta" label={`θ${still}`} low={0} high={89.9} />
      <Angle state={state} of="phi" label={`φ${still}`} low={0} high={360} step={1} />
      <Angle state={state} of="theta2" label={`θ${moving}`} low={-90} high={90} />
      <Angle state={state} of="phi2" label={`Δφ${moving}`} low={-180} high={180} step={1} />
    </div>
  );
}

export function Settings({ state }: { state: State }): JSX.Element {
  const { store } = useAround();
  return (
    <div class="settings" role="group" aria-label="settings of the view">
      <div class="settings-line">
        {state.view === "curves" && <CurveSettings state={state} />}
        {state.view === "lobe" && <LobeSettings state={state} />}
        {state.view === "slice" && <SliceSettings state={state} />}
        {state.view === "sphere" && <SphereSettings state={state} />}
        {(state.view === "object" || state.view === "traced") && <ObjectSettings state={state} />}
        {(state.view === "samples" || state.view === "checks") && <CountSettings state={state} />}
        {(state.view === "curves" || state.view === "lobe") && (
          <Menu
            label="channel"
            value={state.channel}
            values={
              state.view === "curves" && isColoured(state.curve)
                ? [...CHANNEL_NAMES, ["colours", "red, green and blue"]]
                : [
                    [state.channel === "colours" ? "colours" : "luminance", "luminance"] as const,
                    ...CHANNEL_NAMES.slice(1),
                  ]
            }
            set={channel => store.step({ channel })}
          />
        )}
      </div>
    </div>
  );
}
