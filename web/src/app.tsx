/* app.tsx: the page: materials on the left, the views and their settings on the right.
 *
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { FIT_NAMES } from "./brdf/fits";
import { ExportMenu } from "./export/export_menu";
import { Drop } from "./panel/drop";
import { IconButton } from "./panel/icons";
import { Materials } from "./panel/materials";
import { Around, useAround, type Session } from "./session";
import type { State, View } from "./state/state";
import { DARK, LIGHT } from "./state/theme";
import { ChecksView } from "./views/checks";
import { Curves } from "./views/curves";
import { Lobe } from "./views/lobe";
import { LitObject } from "./views/object";
import { Readout } from "./views/readout";
import { Samples } from "./views/samples";
import { Directions, Settings } from "./views/settings";
import { Slice } from "./views/slice";
import { Sphere } from "./views/sphere";
import { Traced } from "./views/traced";

const NAMES: readonly (readonly [View, string])[] = [
  ["curves", "Curves"],
  ["lobe", "Lobe"],
  ["slice", "Slice"],
  ["samples", "Samples"],
  ["checks", "Checks"],
  ["sphere", "Sphere"],
  ["object", "Object"],
  ["traced", "Traced"],
];

type Wish = "light" | "dark" | undefined;

function useTheme(): [typeof LIGHT, () => void] {
  const media = matchMedia("(prefers-color-scheme: dark)");
  const [wish, setWish] = useState<Wish>(() => (localStorage.getItem("facet-theme") ?? undefined) as Wish);
  const [isDark, setIsDark] = useState(media.matches);
  useEffect(() => {
    const change = (): void => setIsDark(media.matches);
    media.addEventListener("change", change);
    return () => media.removeEventListener("change", change);
  }, []);
  const theme = (wish ? wish === "dark" : isDark) ? DARK : LIGHT;
  document.documentElement.dataset.theme = theme.name;
  return [
    theme,
    () => {
      const next = theme.name === "dark" ? "light" : "dark";
      localStorage.setItem("facet-theme", next);
      setWish(next);
    },
  ];
}

function Tabs({ state }: { state: State }): JSX.Element {
  const { store } = useAround();
  const show = (view: View): void => store.step({ view });
  const keys = (event: KeyboardEvent): void => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    // The store's view: a second key comes before the first one's frame.
    const at = NAMES.findIndex(([view]) => view === store.state.view),
      [next] = NAMES[(at + step + NAMES.length) % NAMES.length];
    event.preventDefault();
    show(next);
    document.getElementById(`tab-${next}`)?.focus();
  };
  return (
    <div class="tabs" role="tablist" aria-label="views" onKeyDown={keys}>
      {NAMES.map(([view, name]) => (
        <button
          key={view}
          type="button"
          role="tab"
          id={`tab-${view}`}
          aria-selected={view === state.view}
          aria-controls="view"
          tabIndex={view === state.view ? 0 : -1}
          onClick={() => show(view)}
        >
          {name}
        </button>
      ))}
    </div>
  );
}

function ViewOf({ state }: { state: State }): JSX.Element {
  switch (state.view) {
    case "lobe":
      return <Lobe state={state} />;
    case "slice":
      return <Slice state={state} />;
    case "samples":
      return <Samples state={state} />;
    case "checks":
      return <ChecksView state={state} />;
    case "sphere":
      return <Sphere state={state} />;
    case "object":
      return <LitObject state={state} />;
    case "traced":
      return <Traced state={state} />;
    default:
      return <Curves state={state} />;
  }
}

export function App({ session }: { session: Session }): JSX.Element {
  const { store } = session;
  const [state, setState] = useState(store.state);
  const [theme, toggleTheme] = useTheme();
  const open = useRef(() => {});
  useEffect(() => store.listen(() => setState({ ...store.state })), []);
  return (
    <Around.Provider value={{ session, theme }}>
      <header>
        <h1>
          facet <span>explorer</span>
        </h1>
        <p class="tagline">Microfacet reflection, computed here by libfacet {session.facet.version}</p>
        <div class="actions">
          <ExportMenu state={state} />
          <IconButton name="theme" label="light or dark" onClick={toggleTheme} />
        </div>
      </header>
      <aside aria-label="materials and parameters">
        <Materials state={state} fits={FIT_NAMES} open={() => open.current()} />
      </aside>
      <main>
        <Tabs state={state} />
        <Settings state={state} />
        <Directions state={state} />
        <div class="view" id="view" role="tabpanel" aria-labelledby={`tab-${state.view}`}>
          <ViewOf state={state} />
        </div>
        <Readout state={state} />
      </main>
      <Drop open={open} />
    </Around.Provider>
  );
}
