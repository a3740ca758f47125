/* drop.tsx: files that are dropped anywhere on the page, or chosen; what is wrong with one is said.
 *
 * SPDX-License-Identifier: MIT */
import type { JSX } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { EXTENSIONS, openFile } from "../brdf/opened";
import { useAround } from "../session";
import { IconButton } from "./icons";

/** `open.current` lets the reader choose files. */
export function Drop({ open }: { open: { current: () => void } }): JSX.Element {
  const { session } = useAround();
  const [isOver, setIsOver] = useState(false);
  const [reading, setReading] = useState("");
  const [problems, setProblems] = useState<readonly string[]>([]);
  const input = useRef<HTMLInputElement>(null);
  open.current = () => input.current?.click();

  const take = async (files: readonly File[]): Promise<void> => {
    const wrong: string[] = [];
    setProblems([]);
    for (const file of files) {
      try {
        setReading(file.name);
        session.show(await openFile(file, name => session.file(name)));
      } catch (error) {
        wrong.push(error instanceof Error ? error.message : String(error));
      }
    }
    setReading("");
    setProblems(wrong);
  };

  useEffect(() => {
    const over = (event: DragEvent): void => {
      if (!event.dataTransfer?.types.includes("Files")) return;
      event.preventDefault();
      setIsOver(true);
    };
    const leave = (event: DragEvent): void => {
      if (!event.relatedTarget) setIsOver(false);
    };
    const drop = (event: DragEvent): void => {
      setIsOver(false);
      if (!event.dataTransfer?.files.length) return;
      event.preventDefault();
      void take([...event.dataTransfer.files]);
    };
    addEventListener("dragover", over);
    addEventListener("dragleave", leave);
    addEventListener("drop", drop);
    return () => {
      removeEventListener("dragover", over);
      removeEventListener("dragleave", leave);
      removeEventListener("drop", drop);
    };
  }, []);
  return (
    <>
      <input
        ref={input}
        type="file"
        class="file-input"
        accept={EXTENSIONS.join()}
        multiple
        tabIndex={-1}
        aria-label="files"
        onChange={event => {
          const files = [...(event.currentTarget.files ?? [])];
          event.currentTarget.value = "";
          void take(files);
        }}
      />
      {isOver && <div class="drop-here">Drop materials, light or objects here: {EXTENSIONS.join(" ")}</div>}
      {reading && (
        <div class="notice" role="status">
          reading {reading} …
        </div>
      )}
      {problems.length > 0 && (
        <div class="message" role="alert">
          <div>
            {problems.map(problem => (
              <p key={problem}>{problem}</p>
            ))}
          </div>
          <IconButton name="remove" label="close the message" onClick={() => setProblems([])} />
        </div>
      )}
    </>
  );
}
