/* furnace_table.tsx: what a world of radiance 1 is sent back, and what it should be.
 *
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import type { Brdf } from "../brdf/brdf";
import { FacetBrdf } from "../facet/facet_brdf";
import { useAround } from "../session";
import { visibleEntries, type State } from "../state/state";
import { lineColour } from "../state/theme";
import type { Checked } from "./checks";

function number(value: number | undefined, digits = 6): string {
  return value === undefined || Number.isNaN(value) ? "–" : value.toFixed(digits);
}

function verdict(deviation: number, allowed: number): JSX.Element | string {
  if (Number.isNaN(deviation)) return "–";
  const holds = deviation <= allowed;
  return <span class={holds ? "holds" : "fails"}>{holds ? "holds" : `off by ${deviation.toExponential(1)}`}</span>;
}

export function FurnaceTable(props: { state: State; checked: (brdf: Brdf) => Checked }): JSX.Element {
  const { session, theme } = useAround();
  const resolved = visibleEntries(props.state).map(({ entry }) => session.resolve(entry).brdf);
  const goesThrough = resolved.some(brdf => brdf instanceof FacetBrdf && brdf.transmits);
  return (
    <div class="scroll furnace" tabIndex={0}>
      <table data-export-text>
        <thead>
          <tr>
            <th>
              furnaces, viewer at θ<sub>o</sub> = {props.state.theta}°
            </th>
            <th colSpan={3}>reflected, red, green, blue [1]</th>
            {goesThrough && <th>transmitted, green [1]</th>}
            <th>white furnace</th>
            <th>weak furnace [1]</th>
            <th />
          </tr>
        </thead>
        <tbody>
          {visibleEntries(props.state).map(({ entry, place }) => {
            const { brdf } = session.resolve(entry);
            if (!brdf) return null;
            const { furnace } = props.checked(brdf);
            return (
              <tr key={entry.id} data-is-done={furnace !== undefined}>
                <th scope="row">
                  <i class="dot" style={{ background: lineColour(theme, place) }} />
                  {brdf.label}
                </th>
                {[0, 1, 2].map(k => (
                  <td key={k} data-value={`reflected-${k}`}>
                    {number(furnace?.reflected[k])}
                  </td>
                ))}
                {goesThrough && <td>{number(furnace?.transmitted[1])}</td>}
                <td>{furnace ? verdict(furnace.deviation, furnace.allowed) : "…"}</td>
                <td data-value="weak">{furnace ? number(furnace.weak, 7) : "…"}</td>
                <td>{furnace ? verdict(Math.abs(furnace.weak - 1), furnace.allowedWeak) : ""}</td>
              </tr>
            );
          })}
        </tbody>
      </table>
    </div>
  );
}
