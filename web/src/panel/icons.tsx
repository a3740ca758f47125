/* icons.tsx: the page's own small drawings, 16 by 16.
 *
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";

const PATHS = {
  eye: "M1.5 8S4 3.5 8 3.5 14.5 8 14.5 8 12 12.5 8 12.5 1.5 8 1.5 8ZM8 6a2 2 0 1 0 0 4 2 2 0 0 0 0-4Z",
  hidden:
    "M2 2l12 12M3.5 5.2C2.2 6.4 1.5 8 1.5 8S4 12.5 8 12.5c1.2 0 2.3-.4 3.2-.9M6 3.8C6.6 3.6 7.3 3.5 8 3.5c4 0 6.5 4.5 6.5 4.5s-.6 1.1-1.7 2.2",
  solo: "M8 2.5a5.5 5.5 0 1 0 0 11 5.5 5.5 0 0 0 0-11ZM8 6.2a1.8 1.8 0 1 0 0 3.6 1.8 1.8 0 0 0 0-3.6Z",
  copy: "M5.5 5.5h8v8h-8zM2.5 10.5v-8h8",
  remove: "M3.5 3.5l9 9M12.5 3.5l-9 9",
  add: "M8 2.5v11M2.5 8h11",
  link: "M6.5 9.5l3-3M7 4.5l1.5-1.5a3 3 0 0 1 4.5 4.5L11.5 9M9 11.5l-1.5 1.5A3 3 0 0 1 3 8.5L4.5 7",
  save: "M8 2v8M4.5 7L8 10.5 11.5 7M2.5 13.5h11",
  theme: "M8 2.5a5.5 5.5 0 1 0 0 11V2.5Z",
  reset: "M3 8a5 5 0 1 0 1.7-3.7M3 2.5v3h3",
  file: "M4 1.5h5l3 3v10H4zM9 1.5v3h3",
} as const;

export type IconName = keyof typeof PATHS;

export function Icon({ name }: { name: IconName }): JSX.Element {
  return (
    <svg
      class="icon"
      width="16"
      height="16"
      viewBox="0 0 16 16"
      aria-hidden="true"
      fill={name === "theme" ? "currentColor" : "none"}
      stroke="currentColor"
      stroke-width="1.4"
      stroke-linecap="round"
      stroke-linejoin="round"
    >
      <path d={PATHS[name]} />
      {name === "theme" && <circle cx="8" cy="8" r="5.5" fill="none" />}
    </svg>
  );
}

export function IconButton(props: {
  name: IconName;
  label: string;
  isOn?: boolean | undefined;
  onClick: () => void;
}): JSX.Element {
  return (
    <button
      type="button"
      class={"icon-button" + (props.isOn ? " is-on" : "")}
      title={props.label}
      aria-label={props.label}
      {...(props.isOn === undefined ? {} : { "aria-pressed": props.isOn })}
      onClick={props.onClick}
    >
      <Icon name={props.name} />
    </button>
  );
}
