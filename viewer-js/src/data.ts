// Reads the document that Python put into the page.

import { type CurveData, type PageData, type PathData, VERSION } from "./contract";

export function readPage(): PageData {
  const text = document.getElementById("data")?.textContent;
  if (!text) throw new Error("This page holds no dance: it was saved without its data.");
  const page = JSON.parse(text) as PageData;
  if (page.version !== VERSION) throw new Error(`This page holds data of version ${page.version}, not ${VERSION}.`);
  return page;
}

export function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/** Joint positions in metres, frames first, then joints, then x y z. */
export function readPath(path: PathData): Float32Array {
  const view = new DataView(bytesOf(path.base64).buffer);
  const positions = new Float32Array(view.byteLength / 2);
  for (let i = 0; i < positions.length; i++) {
    positions[i] = path.origin[i % 3] + path.step * view.getUint16(2 * i, true);
  }
  return positions;
}

export interface Curve {
  values: Float32Array;
  rate: number;
}

export function readCurve(curve: CurveData): Curve {
  return { values: Float32Array.from(bytesOf(curve.base64), (value) => value / 255), rate: curve.rate };
}

/** Index of the last of the sorted times that is not after t; -1 before the first. */
export function lastBefore(times: readonly number[], t: number): number {
  let low = 0;
  let high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}
