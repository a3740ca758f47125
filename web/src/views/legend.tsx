/* legend.tsx: which curve is whose, in the order of the list.
 *
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import { useAround } from "../session";
import { DASHES, lineColour } from "../state/theme";

export interface LegendLine {
  readonly place: number;
  readonly label: string;
  readonly note?: string;
}

export function Legend({ lines }: { lines: readonly LegendLine[] }): JSX.Element {
  const { theme } = useAround();
  return (
    <figcaption class="legend">
      {lines.map(({ place, label, note }) => (
        <span key={place} class="legend-line">
          <svg width="26" height="10" aria-hidden="true">
            <line
              x1="1"
              x2="25"
              y1="5"
              y2="5"
              stroke={lineColour(theme, place)}
              stroke-width="2.5"
              stroke-dasharray={DASHES[place % DASHES.length]}
            />
          </svg>
          <span data-export-text>
            {label}
            {note ? `: ${note}` : ""}
          </span>
        </span>
      ))}
    </figcaption>
  );
}
