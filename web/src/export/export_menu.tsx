/* export_menu.tsx: saves the view and the selected material, and copies the link.
 *
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { ShaderBrdf } from "../brdf/shader_brdf";
import { FacetBrdf } from "../facet/facet_brdf";
import { Icon, IconButton } from "../panel/icons";
import { useAround } from "../session";
import { selectedEntry, type State } from "../state/state";
import { bparamFile, cFile, gltfFile, glslMaterial, specFile, type TextFile } from "./material_files";
import { pictureOf, pngOf, save } from "./picture";

export function ExportMenu({ state }: { state: State }): JSX.Element {
  const { session, theme, facet } = useAround();
  const menu = useRef<HTMLDetailsElement>(null);
  const [isCopied, setIsCopied] = useState(false);
  const entry = selectedEntry(state),
    brdf = entry && session.resolve(entry).brdf;
  useEffect(() => {
    const close = (event: Event): void => {
      const isKey = event instanceof KeyboardEvent;
      if (isKey ? event.key === "Escape" : !menu.current?.contains(event.target as Node))
        menu.current?.removeAttribute("open");
    };
    document.addEventListener("pointerdown", close);
    document.addEventListener("keydown", close);
    return () => {
      document.removeEventListener("pointerdown", close);
      document.removeEventListener("keydown", close);
    };
  }, []);

  const saveView = async (kind: "svg" | "png"): Promise<void> => {
    const view = document.querySelector<HTMLElement>(".view"),
      figure = view?.querySelector<HTMLElement>(".figure");
    if (!view || !figure) return;
    const picture = pictureOf(view, theme),
      name = `facet-${figure.dataset.figure}.${kind}`;
    save(kind === "svg" ? new Blob([picture.svg], { type: "image/svg+xml" }) : await pngOf(picture), name);
    menu.current?.removeAttribute("open");
  };
  const saveFile = ({ name, type, text }: TextFile): void => {
    save(new Blob([text], { type }), name);
    menu.current?.removeAttribute("open");
  };
  const saveText = async (make: (one: FacetBrdf) => TextFile | Promise<TextFile>): Promise<void> => {
    if (brdf instanceof FacetBrdf) saveFile(await make(brdf));
  };
  const copy = async (): Promise<void> => {
    await navigator.clipboard.writeText(location.href);
    setIsCopied(true);
    setTimeout(() => setIsCopied(false), 1500);
  };
  const texts: readonly (readonly [string, () => void])[] = [
    ["spec (.txt)", () => void saveText(specFile)],
    ["glTF (.gltf)", () => void saveText(one => gltfFile(one, facet.version))],
    ["GLSL (.glsl)", () => void saveText(glslMaterial)],
    ["C (.c)", () => void saveText(cFile)],
  ];
  return (
    <>
      <IconButton name="link" label={isCopied ? "copied" : "copy a link to this view"} onClick={() => void copy()} />
      <details class="export" ref={menu}>
        <summary class="text-button">
          <Icon name="save" /> Save
        </summary>
        <div class="export-list">
          <p>this view</p>
          <button type="button" onClick={() => void saveView("svg")}>
            SVG
          </button>
          <button type="button" onClick={() => void saveView("png")}>
            PNG
          </button>
          {brdf instanceof ShaderBrdf && (
            <>
              <p>{brdf.label}</p>
              <button type="button" onClick={() => saveFile(bparamFile(brdf))}>
                parameters (.bparam)
              </button>
            </>
          )}
          <p>{brdf instanceof FacetBrdf ? brdf.text : "a material of the library's, selected"}</p>
          {texts.map(([label, act]) => (
            <button key={label} type="button" disabled={!(brdf instanceof FacetBrdf)} onClick={act}>
              {label}
            </button>
          ))}
        </div>
      </details>
    </>
  );
}
