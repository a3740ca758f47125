/* change.ts: a parameter is set as the library allows it.
 *
 * Some parameters exclude each other and some need another one.  Which, the library says by refusing: the smallest
 * change beside the wanted one that it takes is the one that is made.
 * SPDX-License-Identifier: MIT */
import { specText, type Facet, type Settings } from "../facet/library";

function withGiven(settings: Settings, given: readonly boolean[]): Settings {
  return { ...settings, given };
}

/** The settings without one parameter, and then without those that need it. */
export function resetParameter(facet: Facet, settings: Settings, k: number): string {
  const given = settings.given.map((is, i) => is && i !== k);
  if (facet.accepts(specText(withGiven(settings, given)))) return specText(withGiven(settings, given));
  for (let i = 0; i < given.length; i++) {
    const fewer = specText(
      withGiven(
        settings,
        given.map((is, j) => is && j !== i),
      ),
    );
    if (given[i] && facet.accepts(fewer)) return fewer;
  }
  return settings.model.name;
}

/** The spec with values[k] set; undefined if the library takes it in no way. */
export function setParameter(
  facet: Facet,
  settings: Settings,
  k: number,
  values: readonly number[],
): string | undefined {
  const parameters = settings.model.parameters,
    n = parameters.length;
  const changed = { ...settings, values: settings.values.map((old, i) => (i === k ? values : old)) };
  const attempt = (isGiven: (i: number) => boolean): string | undefined => {
    const text = specText(
      withGiven(
        changed,
        parameters.map((_, i) => i === k || isGiven(i)),
      ),
    );
    return facet.accepts(text) ? text : undefined;
  };
  const { given } = settings;
  const others = [...Array(n).keys()].filter(i => i !== k);
  const plain = attempt(i => given[i]);
  if (plain) return plain;
  for (const out of others.filter(i => given[i])) {
    const text = attempt(i => given[i] && i !== out);
    if (text) return text;
  }
  for (const added of others.filter(i => !given[i]))
    for (const out of [-1, ...others.filter(i => given[i])]) {
      const text = attempt(i => (given[i] && i !== out) || i === added);
      if (text) return text;
    }
  for (const a of others.filter(i => given[i]))
    for (const b of others.filter(i => given[i] && i > a)) {
      const text = attempt(i => given[i] && i !== a && i !== b);
      if (text) return text;
    }
  return undefined;
}
