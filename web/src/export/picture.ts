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

/** A line of text where it stands; lines that the browser broke stay one. */
function wordsOf(node: HTMLElement, { x, y, width, height }: Place): SVGElement {
  const style = getComputedStyle(node),
    isCentred = style.textAlign === "center" && style.display !== "inline";
  const text = element("text", {
    x: isCentred ? x + width / 2 : x,
    y: y + height / 2,
    fill: style.color,
    "font-family": style.fontFamily.replace(/"/g, "'"),
    "font-size": style.fontSize,
    "text-anchor": isCentred ? "middle" : "start",
    "dominant-baseline": "central",
  });
  text.textContent = node.textContent;
  return text;
}

export interface Picture {
  readonly svg: string;
  readonly width: number;
  readonly height: number;
}

export function pictureOf(figure: HTMLElement, theme: Theme): Picture {
  const frame = figure.getBoundingClientRect(),
    width = Math.ceil(frame.width),
    height = Math.ceil(frame.height);
  const root = element("svg", { xmlns: SVG, width, height, viewBox: `0 0 ${width} ${height}` });
  root.append(element("rect", { width, height, fill: theme.page }));
  for (const node of figure.querySelectorAll<HTMLElement | SVGSVGElement>("canvas, svg, .dot, [data-export-text]")) {
    const rect = node.getBoundingClientRect();
    if (!rect.width || !rect.height) continue;
    const place = placeIn(frame, rect);
    if (node instanceof HTMLCanvasElement) {
      if (node.width && node.height) root.append(rasterOf(node, place));
    } else if (node instanceof SVGSVGElement) root.append(drawingOf(node, place));
    else if (node.classList.contains("dot")) {
      const { backgroundColor: fill } = getComputedStyle(node);
      root.append(element("circle", { cx: place.x + 4, cy: place.y + 4, r: 4, fill }));
    } else if (node.textContent?.trim()) root.append(wordsOf(node, place));
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
