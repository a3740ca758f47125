/* readout.tsx: the numbers at one pair of directions, with all their digits: what `facet eval` and `facet terms` print.
 *
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import { direction, type Vector } from "../brdf/angles";
import { sameDirections, type Brdf } from "../brdf/brdf";
import { FacetBrdf } from "../facet/facet_brdf";
import { useAround } from "../session";
import { visibleEntries, type State } from "../state/state";
import { lineColour } from "../state/theme";

/** The two directions of the readout: one at -theta, the other one at theta2 in a plane turned by phi2. */
export function readoutDirections(state: State): { wi: Vector; wo: Vector } {
  const still = direction(-state.theta, state.phi),
    moving = direction(state.theta2, state.phi + state.phi2);
  return state.fixed === "viewer" ? { wi: moving, wo: still } : { wi: still, wo: moving };
}

/** Nine digits tell all floats apart; the same form as C's %.9g. */
export function floatText(value: number): string {
  if (value === 0) return "0";
  const exponent = Math.floor(Math.log10(Math.abs(Number(value.toPrecision(9)))));
  if (exponent >= -5 && exponent < 9) return String(Number(value.toPrecision(9)));
  const [digits, power] = value.toExponential(8).split("e");
  return `${digits.replace(/\.?0+$/, "")}e${power[0]}${power.slice(1).padStart(2, "0")}`;
}

interface Values {
  readonly f: readonly number[];
  readonly fcos: readonly number[];
  readonly pdf?: number;
  /** D of the half vector, G1 of the viewer. */
  readonly D?: number;
  readonly G1?: number;
}

export function readoutValues(brdf: Brdf, wi: Vector, wo: Vector): Values {
  const wis = sameDirections(1, wi),
    wos = sameDirections(1, wo);
  const { r, g, b } = brdf.eval(wis, wos),
    fcos = [r[0], g[0], b[0]],
    cosine = Math.fround(Math.abs(wis.z[0]));
  const f = fcos.map(value => (cosine > 0 ? Math.fround(value / cosine) : 0));
  if (!(brdf instanceof FacetBrdf)) return { f, fcos };
  const h = [wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]],
    length = Math.hypot(h[0], h[1], h[2]);
  const terms = brdf.hasTerms && length > 1e-9 ? { D: brdf.D(h.map(x => x / length)), G1: brdf.terms(wo).G1 } : {};
  return { f, fcos, ...(brdf.isDelta ? {} : { pdf: brdf.pdf(wis, wos)[0] }), ...terms };
}

function Row({ place, brdf, wi, wo }: { place: number; brdf: Brdf; wi: Vector; wo: Vector }): JSX.Element {
  const { theme } = useAround();
  const values = readoutValues(brdf, wi, wo);
  const cell = (name: string, value: number | undefined): JSX.Element => (
    <td data-value={name}>{value === undefined ? "–" : floatText(value)}</td>
  );
  return (
    <tr>
      <th scope="row">
        <i class="dot" style={{ background: lineColour(theme, place) }} />
        {brdf.label}
      </th>
      {cell("f_r", values.f[0])}
      {cell("f_g", values.f[1])}
      {cell("f_b", values.f[2])}
      {cell("fcos_r", values.fcos[0])}
      {cell("fcos_g", values.fcos[1])}
      {cell("fcos_b", values.fcos[2])}
      {cell("pdf", values.pdf)}
      {cell("D", values.D)}
      {cell("G1", values.G1)}
    </tr>
  );
}

export function Readout({ state }: { state: State }): JSX.Element {
  const { session } = useAround();
  const { wi, wo } = readoutDirections(state);
  const text = (v: Vector): string => v.map(x => String(Number(x.toPrecision(4)))).join(", ");
  return (
    <section class="readout" aria-label="numbers">
      <p class="directions" data-wi={wi.join(",")} data-wo={wo.join(",")}>
        ω<sub>i</sub> = ({text(wi)}) · ω<sub>o</sub> = ({text(wo)})
      </p>
      <div class="scroll" tabIndex={0}>
        <table>
          <thead>
            <tr>
              <th />
              <th colSpan={3}>f [1/sr], red, green, blue</th>
              <th colSpan={3}>
                f cos θ<sub>i</sub> [1/sr]
              </th>
              <th>pdf [1/sr]</th>
              <th>
                D(ω<sub>m</sub>) [1/sr]
              </th>
              <th>
                G<sub>1</sub>(ω<sub>o</sub>)
              </th>
            </tr>
          </thead>
          <tbody>
            {visibleEntries(state).map(({ entry, place }) => {
              const { brdf } = session.resolve(entry);
              return brdf && <Row key={entry.id} place={place} brdf={brdf} wi={wi} wo={wo} />;
            })}
          </tbody>
        </table>
      </div>
    </section>
  );
}
