/* materials.tsx: the list of materials: typed specs, shown, hidden, alone, copied, removed; and new ones.
 *
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import { useState } from "preact/hooks";
import { ShaderBrdf } from "../brdf/shader_brdf";
import { FacetBrdf } from "../facet/facet_brdf";
import { specText, type Settings } from "../facet/library";
import { useAround } from "../session";
import { nextId, selectedEntry, type Entry, type State } from "../state/state";
import type { Store } from "../state/store";
import { DASHES, lineColour } from "../state/theme";
import { resetParameter, setParameter } from "./change";
import { IconButton } from "./icons";
import { Parameters } from "./parameters";

/* What events change is the store's state: what was drawn last may be a frame old. */
function replaced({ state }: Store, id: number, change: Partial<Entry>): { entries: Entry[] } {
  return { entries: state.entries.map(entry => (entry.id === id ? { ...entry, ...change } : entry)) };
}

function withValue(settings: Settings, at: number, values: readonly number[], isGiven: boolean): Settings {
  return {
    ...settings,
    values: settings.values.map((old, k) => (k === at ? values : old)),
    given: settings.given.map((is, k) => (k === at ? isGiven : is)),
  };
}

function Key({ place }: { place: number }): JSX.Element {
  const { theme } = useAround();
  return (
    <svg class="key" width="26" height="12" aria-hidden="true">
      <line
        x1="1"
        x2="25"
        y1="6"
        y2="6"
        stroke={lineColour(theme, place)}
        stroke-width="3"
        stroke-dasharray={DASHES[place % DASHES.length]}
      />
    </svg>
  );
}

function EntryRow({ entry, place, state }: { entry: Entry; place: number; state: State }): JSX.Element {
  const { session, store } = useAround();
  const resolved = session.resolve(entry),
    isSelected = selectedEntry(state)?.id === entry.id;
  const isOther = /^(file|fit):/.test(entry.text);
  const select = (): void => {
    if (!isSelected) store.step({ selected: entry.id });
  };
  const remove = (): void => {
    const entries = store.state.entries.filter(one => one.id !== entry.id);
    store.step({
      entries,
      solo: store.state.solo === entry.id ? 0 : store.state.solo,
      selected: entries[Math.max(0, place - 1)]?.id ?? 0,
    });
  };
  const copy = (): void => {
    const { entries } = store.state,
      id = nextId(store.state);
    store.step({
      entries: [...entries.slice(0, place + 1), { ...entry, id }, ...entries.slice(place + 1)],
      selected: id,
    });
  };
  return (
    <li class={"entry" + (isSelected ? " is-selected" : "") + (entry.isHidden ? " is-hidden" : "")} onClick={select}>
      <Key place={place} />
      <input
        class="spec"
        aria-label={`material ${place + 1}`}
        title={resolved.brdf?.label ?? entry.text}
        spellcheck={false}
        value={isOther ? (resolved.brdf?.label ?? entry.text.replace(/^\w+:/, "")) : entry.text}
        readOnly={isOther}
        key={entry.text}
        onFocus={select}
        aria-invalid={resolved.problem !== undefined}
        onChange={event => store.step(replaced(store, entry.id, { text: event.currentTarget.value.trim() }))}
      />
      <span class="tools">
        <IconButton
          name={entry.isHidden ? "hidden" : "eye"}
          label={entry.isHidden ? "show" : "hide"}
          onClick={() => store.step(replaced(store, entry.id, { isHidden: !entry.isHidden }))}
        />
        <IconButton
          name="solo"
          label="show this one alone"
          isOn={state.solo === entry.id}
          onClick={() => store.step({ solo: store.state.solo === entry.id ? 0 : entry.id })}
        />
        <IconButton name="copy" label="copy" onClick={copy} />
        <IconButton name="remove" label="remove" onClick={remove} />
      </span>
      {resolved.problem && (
        <p class="problem" role="alert">
          {resolved.problem}
        </p>
      )}
    </li>
  );
}

function AddMenu({ fits, open }: { fits: readonly string[]; open: () => void }): JSX.Element {
  const { facet, store } = useAround();
  const add = (text: string): void => {
    const id = nextId(store.state);
    store.step({ entries: [...store.state.entries, { id, text, isHidden: false }], selected: id });
  };
  return (
    <div class="add">
      <select
        aria-label="add a material"
        value=""
        onChange={event => {
          const { value } = event.currentTarget;
          event.currentTarget.value = "";
          if (value) add(value);
        }}
      >
        <option value="">Add a material …</option>
        <optgroup label="models">
          {facet.models.map(model => (
            <option key={model.name} value={model.name} title={model.summary}>
              {model.name}
            </option>
          ))}
        </optgroup>
        <optgroup label="fits of MERL materials">
          {fits.map(name => (
            <option key={name} value={`fit:${name}`}>
              {name}
            </option>
          ))}
        </optgroup>
      </select>
      <IconButton name="file" label="open files: materials, light, objects" onClick={open} />
    </div>
  );
}

export function Materials({
  state,
  fits,
  open,
}: {
  state: State;
  fits: readonly string[];
  open: () => void;
}): JSX.Element {
  const { session, store, facet } = useAround();
  const [refused, setRefused] = useState("");
  const entry = selectedEntry(state),
    brdf = entry && session.resolve(entry).brdf;
  const settings = brdf instanceof FacetBrdf || brdf instanceof ShaderBrdf ? brdf.settings : undefined;
  const isFile = brdf instanceof ShaderBrdf;
  const set = (k: number, values: readonly number[]): string | undefined =>
    isFile ? `file:${specText(withValue(settings!, k, values, true))}` : setParameter(facet, settings!, k, values);
  const reset = (k: number): string =>
    isFile
      ? `file:${specText(withValue(settings!, k, settings!.model.parameters[k].initial, false))}`
      : resetParameter(facet, settings!, k);
  const change = (text: string | undefined, isStep: boolean): void => {
    if (!entry) return;
    setRefused(text === undefined ? "The library takes this value with none of the others." : "");
    if (text !== undefined) store[isStep ? "step" : "slide"](replaced(store, entry.id, { text }));
  };
  return (
    <>
      <ul class="entries" aria-label="materials">
        {state.entries.map((one, place) => (
          <EntryRow key={one.id} entry={one} place={place} state={state} />
        ))}
      </ul>
      <AddMenu fits={fits} open={open} />
      {settings && (
        <section class="selected">
          <h2>{settings.model.name}</h2>
          <p class="summary">{settings.model.summary}</p>
          <Parameters
            settings={settings}
            set={(k, values) => change(set(k, values), false)}
            reset={k => change(reset(k), true)}
          />
          {refused && (
            <p class="problem" role="alert">
              {refused}
            </p>
          )}
          <p class="source">{settings.model.source}</p>
        </section>
      )}
    </>
  );
}
