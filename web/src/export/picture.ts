/* picture.ts: what a view shows, as SVG or PNG: its drawings as they are, its rasters as pictures inside.
 *
 * SPDX-License-Identifier: MIT */
import type { Theme } from "../state/theme";

const SVG = "http://www.w3.org/2000/svg";

function element(name: string, attributes: Record<string, string | number>): SVGElement {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  return made;
}

interface Place {
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
}

function placeIn(frame: DOMRect, { left, top, width, height }: DOMRect): Place {
  return { x: left - frame.left, y: top - frame.top, width, height };
}

function rasterOf(canvas: HTMLCanvasElement, place: Place): SVGElement {
  return element("image", { ...place, href: canvas.toDataURL("image/png"), preserveAspectRatio: "none" });
}

function drawingOf(svg: SVGSVGElement, place: Place): SVGElement {
  const copy = svg.cloneNode(true) as SVGSVGElement;
  for (const name of ["class", "tabindex", "role", "aria-label", "aria-hidden"]) copy.removeAttribute(name);
  for (const [key, value] of Object.entries(place)) copy.setAttribute(key, String(value));
  copy.setAttribute("overflow", "visible");
  return copy;
}

interface Line {
  text: string;
  left: number;
  right: number;
  readonly top: number;
  readonly bottom: number;
}

/** The lines that the browser made of a text, cut as it cuts those that are too long. */
function linesOf(node: Text): Line[] {
  const lines: Line[] = [],
    range = document.createRange(),
    box = node.parentElement!.closest(".tile-name, .panel-title, th")?.getBoundingClientRect();
  for (let i = 0; i < node.length; i++) {
    range.setStart(node, i);
    range.setEnd(node, i + 1);
    const { left, right, top, bottom, width } = range.getBoundingClientRect(),
      last = lines[lines.length - 1];
    if (!width) continue;
    const isBlank = !node.data[i].trim();
    if (last && Math.abs(last.top - top) < (bottom - top) / 2) {
      last.text += node.data[i];
      if (!isBlank) last.right = right;
    } else if (!isBlank) lines.push({ text: node.data[i], left, right, top, bottom });
  }
  for (const line of lines) {
    const over = box ? line.right - box.right : 0;
    if (over > 0.5) {
      const each = (line.right - line.left) / line.text.length,
        n = Math.ceil(over / each) + 1;
      line.text = `${line.text.slice(0, -n)}…`;
      line.right -= (n - 1) * each;
    }
  }
  return lines;
}

/** The words of a node where they stand. */
function wordsOf(node: HTMLElement, frame: DOMRect): SVGElement[] {
  const walker = document.createTreeWalker(node, NodeFilter.SHOW_TEXT),
    made: SVGElement[] = [];
  while (walker.nextNode()) {
    const part = walker.currentNode as Text,
      style = getComputedStyle(part.parentElement!),
      isCentred = style.textAlign === "center";
    for (const { text, left, right, top, bottom } of linesOf(part)) {
      const words = element("text", {
        x: (isCentred ? (left + right) / 2 : left) - frame.left,
        y: (top + bottom) / 2 - frame.top,
        fill: style.color,
        "font-family": style.fontFamily.replace(/"/g, "'"),
        "font-size": style.fontSize,
        "font-weight": style.fontWeight,
        // As wide as here, for the next words begin where they begin here.
        textLength: right - left,
        "text-anchor": isCentred ? "middle" : "start",
        "dominant-baseline": "central",
      });
      words.textContent = text.trim();
      made.push(words);
    }
  }
  return made;
}

export interface Picture {
  readonly svg: string;
  readonly width: number;
  readonly height: number;
}

/** What is inside the view, with its words. */
export function pictureOf(view: HTMLElement, theme: Theme): Picture {
  const frame = view.getBoundingClientRect(),
    // A table that is scrolled is there as a whole.
    tables = [...view.querySelectorAll("table[data-export-text]")].map(one => one.getBoundingClientRect().right),
    width = Math.ceil(Math.max(frame.right, ...tables) - frame.left),
    height = Math.ceil(frame.height);
  const root = element("svg", { xmlns: SVG, width, height, viewBox: `0 0 ${width} ${height}` });
  root.append(element("rect", { width, height, fill: theme.page }));
  for (const node of view.querySelectorAll<HTMLElement | SVGSVGElement>("canvas, svg, .dot, [data-export-text]")) {
    const rect = node.getBoundingClientRect();
    if (!rect.width || !rect.height) continue;
    const place = placeIn(frame, rect);
    if (node instanceof HTMLCanvasElement) {
      if (node.width && node.height) root.append(rasterOf(node, place));
    } else if (node instanceof SVGSVGElement) root.append(drawingOf(node, place));
    else if (node.classList.contains("dot")) {
      const { backgroundColor: fill } = getComputedStyle(node);
      root.append(element("circle", { cx: place.x + 4, cy: place.y + 4, r: 4, fill }));
    } else root.append(...wordsOf(node, frame));
  }
  return { svg: new XMLSerializer().serializeToString(root), width, height };
}

/** Twice as many pixels each way as it has on the screen. */
export async function pngOf({ svg, width, height }: Picture): Promise<Blob> {
  const image = new Image(),
    address = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
  try {
    image.src = address;
    await image.decode();
    const canvas = new OffscreenCanvas(2 * width, 2 * height),
      context = canvas.getContext("2d")!;
    context.drawImage(image, 0, 0, 2 * width, 2 * height);
    return await canvas.convertToBlob({ type: "image/png" });
  } finally {
    URL.revokeObjectURL(address);
  }
}

export function save(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
