/* parameters.tsx: one row for each parameter in the library's table: slider, typed value, reset by double click.
 *
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import { valueText, type Settings } from "../facet/library";
import type { Parameter } from "../facet/table";
import { fromSlider, STEPS, toSlider } from "./slider";

interface RowProps {
  readonly parameter: Parameter;
  readonly values: readonly number[];
  readonly isGiven: boolean;
  set(values: readonly number[]): void;
  reset(): void;
}

/** One number, or three with commas between them for a colour; undefined for anything else. */
export function typedValues(text: string, parameter: Parameter): number[] | undefined {
  const numbers = text.split(",").map(part => (part.trim() === "" ? NaN : Number(part)));
  const isCount = numbers.length === 1 || (parameter.kind === "colour" && numbers.length === 3);
  if (!isCount || !numbers.every(x => x >= parameter.low && x <= parameter.high)) return undefined;
  return numbers.length === 3 ? numbers : [numbers[0], numbers[0], numbers[0]];
}

function hexOf(values: readonly number[]): string {
  const byte = (x: number): string => {
    const c = Math.min(Math.max(x, 0), 1),
      encoded = c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055;
    return Math.round(255 * encoded)
      .toString(16)
      .padStart(2, "0");
  };
  return "#" + values.map(byte).join("");
}

function fromHex(hex: string): number[] {
  return [1, 3, 5].map(i => {
    const c = parseInt(hex.slice(i, i + 2), 16) / 255,
      linear = c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
    return Number(linear.toPrecision(3));
  });
}

function Typed({ parameter, values, set }: RowProps): JSX.Element {
  const text = valueText(parameter, values);
  const commit = (input: HTMLInputElement): void => {
    const numbers = typedValues(input.value, parameter);
    input.setAttribute("aria-invalid", String(!numbers));
    input.setCustomValidity(numbers ? "" : `from ${parameter.low} to ${parameter.high}`);
    if (numbers && input.value.trim() !== text) set(numbers);
    else if (!numbers) input.reportValidity();
  };
  return (
    <input
      class="typed"
      type="text"
      inputMode="decimal"
      aria-label={`${parameter.name}, value`}
      value={text}
      key={text}
      spellcheck={false}
      title={`${parameter.low} to ${parameter.high}`}
      onChange={event => commit(event.currentTarget)}
    />
  );
}

function ScaleSlider({ parameter, values, set }: RowProps): JSX.Element {
  const largest = parameter.kind === "colour" ? Math.max(...values) : values[0];
  const slide = (step: number): void => {
    const value = fromSlider(parameter, step);
    const isGrey = parameter.kind === "number" || largest <= 0 || values.every(x => x === largest);
    set(
      isGrey
        ? [value, value, value]
        : values.map(x => Math.max(parameter.low, Number(((x * value) / largest).toPrecision(4)))),
    );
  };
  return (
    <input
      class="slider"
      type="range"
      min={0}
      max={STEPS}
      step={1}
      value={toSlider(parameter, largest)}
      aria-label={parameter.name}
      aria-valuetext={valueText(parameter, values)}
      onInput={event => slide(Number(event.currentTarget.value))}
    />
  );
}

function Row(props: RowProps): JSX.Element {
  const { parameter, values, isGiven, set, reset } = props;
  const unit = parameter.unit === "1" || parameter.unit === "" ? "" : parameter.unit;
  return (
    <div
      class={"row" + (isGiven ? " is-given" : "")}
      data-parameter={parameter.name}
      onDblClick={event => {
        if (!(event.target as HTMLElement).matches(".typed, select")) reset();
      }}
    >
      <span
        class="name"
        title={`${parameter.description}\ndefault ${valueText(parameter, parameter.initial)}; double click resets`}
      >
        {parameter.name}
        {unit && <small> {unit}</small>}
      </span>
      {parameter.kind === "choice" ? (
        <select
          aria-label={parameter.name}
          value={String(values[0])}
          onChange={event => set([Number(event.currentTarget.value), 0, 0])}
        >
          {parameter.choices.map((choice, i) => (
            <option key={choice} value={String(i)}>
              {choice}
            </option>
          ))}
        </select>
      ) : (
        <>
          {parameter.kind === "colour" && parameter.high <= 1 ? (
            <span class="with-swatch">
              <input
                type="color"
                aria-label={`${parameter.name}, colour`}
                value={hexOf(values)}
                onInput={event => set(fromHex(event.currentTarget.value))}
              />
              <ScaleSlider {...props} />
            </span>
          ) : (
            <ScaleSlider {...props} />
          )}
          <Typed {...props} />
        </>
      )}
      <button
        type="button"
        class="undo"
        aria-label={`reset ${parameter.name}`}
        title="reset to the default"
        disabled={!isGiven}
        onClick={reset}
      >
        ↺
      </button>
    </div>
  );
}

export function Parameters(props: {
  settings: Settings;
  set: (k: number, values: readonly number[]) => void;
  reset: (k: number) => void;
}): JSX.Element {
  const { settings } = props;
  return (
    <div class="parameters" role="group" aria-label={`parameters of ${settings.model.name}`}>
      {settings.model.parameters.map((parameter, k) => (
        <Row
          key={parameter.name}
          parameter={parameter}
          values={settings.values[k]}
          isGiven={settings.given[k]}
          set={values => props.set(k, values)}
          reset={() => props.reset(k)}
        />
      ))}
    </div>
  );
}
