/* controls.tsx: the browser's own controls with a label each, for the settings of the views.
 *
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";

export function Choice<T extends string>(props: {
  label: string;
  value: T;
  values: readonly (readonly [T, string])[];
  set: (value: T) => void;
}): JSX.Element {
  return (
    <fieldset class="choice">
      <legend>{props.label}</legend>
      {props.values.map(([value, name]) => (
        <label key={value} class={value === props.value ? "is-on" : ""}>
          <input
            type="radio"
            name={props.label}
            value={value}
            checked={value === props.value}
            onChange={() => props.set(value)}
          />
          <span>{name}</span>
        </label>
      ))}
    </fieldset>
  );
}

export function Menu<T extends string>(props: {
  label: string;
  value: T;
  values: readonly (readonly [T, string])[];
  set: (value: T) => void;
}): JSX.Element {
  return (
    <label class="menu">
      <span>{props.label}</span>
      <select value={props.value} onChange={event => props.set(event.currentTarget.value as T)}>
        {props.values.map(([value, name]) => (
          <option key={value} value={value}>
            {name}
          </option>
        ))}
      </select>
    </label>
  );
}

export function Check(props: { label: string; value: boolean; set: (value: boolean) => void }): JSX.Element {
  return (
    <label class="check">
      <input type="checkbox" checked={props.value} onChange={event => props.set(event.currentTarget.checked)} />
      <span>{props.label}</span>
    </label>
  );
}

/** A slider with its value, typed or slid; double click resets. */
export function Amount(props: {
  label: string;
  unit: string;
  low: number;
  high: number;
  step: number;
  value: number;
  initial: number;
  set: (value: number) => void;
}): JSX.Element {
  const { label, low, high, step, value } = props;
  const typed = (input: HTMLInputElement): void => {
    const number = Number(input.value);
    if (input.value.trim() && Number.isFinite(number)) props.set(Math.min(Math.max(number, low), high));
    else input.value = String(value);
  };
  return (
    <label
      class="amount"
      title="double click resets"
      onDblClick={event => {
        if (!(event.target as HTMLElement).matches(".typed")) props.set(props.initial);
      }}
    >
      <span>{label}</span>
      <input
        type="range"
        class="slider"
        aria-label={label}
        min={low}
        max={high}
        step={step}
        value={value}
        onInput={event => props.set(Number(event.currentTarget.value))}
      />
      <input
        type="text"
        class="typed"
        inputMode="decimal"
        aria-label={`${label}, value`}
        value={String(Number(value.toFixed(3)))}
        onChange={event => typed(event.currentTarget)}
      />
      <small>{props.unit}</small>
    </label>
  );
}
