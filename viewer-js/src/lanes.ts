// Drawing what happens in a stretch of time on a strip: beats, waveform, stops, clips and joins.

import type { ClipColours } from "./colours";
import type { EnergyData, PageData } from "./contract";
import { type Curve, lastBefore, readCurve } from "./data";
import { paint } from "./palette";

export const FONT = '11px system-ui, -apple-system, "Segoe UI", Roboto, sans-serif';

/** A stretch of time laid on pixels. */
export interface Span {
  from: number; // [s]
  to: number; // [s]
  width: number; // [px]
}

export const xOf = (span: Span, time: number): number => ((time - span.from) / (span.to - span.from)) * span.width;
export const timeAt = (span: Span, x: number): number => span.from + (x / span.width) * (span.to - span.from);

type Pen = CanvasRenderingContext2D;

/** Calls `draw` for each of the sorted times inside the span. */
export function inside(times: readonly number[], span: Span, margin: number, draw: (time: number) => void): void {
  for (let i = lastBefore(times, span.from - margin) + 1; i < times.length && times[i] <= span.to + margin; i++) {
    draw(times[i]);
  }
}

export function drawBeats(pen: Pen, span: Span, page: PageData, top: number, bottom: number): void {
  const downbeats = new Set(page.downbeats);
  inside(page.beats, span, 0, (time) => {
    const first = downbeats.has(time);
    pen.fillStyle = first ? paint.soft : paint.faint;
    pen.fillRect(Math.round(xOf(span, time)) - (first ? 1 : 0.5), top, first ? 2 : 1, bottom - top);
  });
}

/** Mean of the values from index `low` up to before `high`, as far as there are any. */
function mean(values: Float32Array, low: number, high: number): number {
  const part = values.subarray(Math.max(Math.floor(low), 0), Math.floor(high));
  return part.reduce((sum, value) => sum + value, 0) / Math.max(part.length, 1);
}

export function drawWaveform(
  pen: Pen, span: Span, wave: Curve, middle: number, half: number, colour: string, step: number, until = Infinity,
): void {
  if (!wave.values.length) return;
  pen.fillStyle = colour;
  // Bars stand at fixed times, so that they do not shimmer while the strip glides.
  const seconds = (step * (span.to - span.from)) / span.width;
  for (let bar = Math.floor(span.from / seconds); bar * seconds < span.to; bar++) {
    if (bar * seconds > until) break;
    const low = Math.floor(bar * seconds * wave.rate);
    const high = Math.max(low + 1, Math.floor((bar + 1) * seconds * wave.rate));
    if (low < 0 || low >= wave.values.length) continue;
    const height = Math.max(mean(wave.values, low, high) * half, 0.75);
    pen.fillRect(xOf(span, bar * seconds), middle - height, step - 1, 2 * height);
  }
}

export function drawClips(
  pen: Pen, span: Span, page: PageData, colours: ClipColours, top: number, height: number,
): void {
  pen.textBaseline = "middle";
  page.moves.forEach((move, i) => {
    const end = page.moves[i + 1]?.at_s ?? page.duration;
    if (end < span.from || move.at_s > span.to) return;
    const left = xOf(span, move.at_s);
    const right = xOf(span, end);
    pen.fillStyle = colours.fill(move.clip);
    rounded(pen, left + 0.75, top, Math.max(right - left - 1.5, 1), height, Math.min(4, (right - left) / 4));
    const [from, to] = [Math.max(left, 0) + 6, Math.min(right, span.width) - 5];
    pen.fillStyle = colours.ink(move.clip);
    pen.fillText(shortened(pen, move.clip, to - from), from, top + height / 2 + 0.5);
  });
}

/** As much of a name as has room, with an ellipsis where some is left out; nothing where too little is left. */
export function shortened(pen: Pen, name: string, room: number): string {
  if (pen.measureText(name).width <= room) return name;
  let [fits, length] = [0, name.length];
  while (fits < length) {
    const half = (fits + length + 1) >> 1;
    if (pen.measureText(`${name.slice(0, half)}…`).width <= room) fits = half;
    else length = half - 1;
  }
  return fits < 3 ? "" : `${name.slice(0, fits).trimEnd()}…`;
}

export function rounded(pen: Pen, x: number, y: number, width: number, height: number, radius: number): void {
  if (!pen.roundRect) return pen.fillRect(x, y, width, height); // browsers of before 2023
  pen.beginPath();
  pen.roundRect(x, y, width, height, radius);
  pen.fill();
}

export function drawStops(pen: Pen, span: Span, page: PageData, middle: number, size: number, now = -1): void {
  inside(page.stops, span, 1, (time) => {
    const x = xOf(span, time);
    const flash = now >= time ? Math.max(0, 1 - (now - time) / 0.35) : 0;
    const reach = size * (1 + 0.6 * flash);
    pen.fillStyle = flash > 0 ? paint.accent : paint.ink;
    pen.beginPath();
    pen.moveTo(x, middle - reach);
    pen.lineTo(x + reach, middle);
    pen.lineTo(x, middle + reach);
    pen.lineTo(x - reach, middle);
    pen.fill();
  });
}

/** The colour of what rests in a keypose. */
export function keyposeColour(source: string): string {
  if (source === "local") return paint.local;
  return source === "global" || source === "kept" ? paint.global : paint.other;
}

/** Numbered marks, round or square as what rests there, on lines down to `bottom`; dots where they would crowd. */
export function drawKeyposes(
  pen: Pen, span: Span, page: PageData, middle: number, size: number, bottom: number, now = -1,
): void {
  const times = page.keyposes.map(({ time }) => time);
  const shown = lastBefore(times, now + 0.001);
  const crowded = page.keyposes.length * 3 * size * (span.to - span.from) > page.duration * span.width;
  let free = -Infinity; // where the last number ends
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  page.keyposes.forEach((keypose, i) => {
    if (keypose.time < span.from - 1 || keypose.time > span.to + 1) return;
    const x = xOf(span, keypose.time);
    const reach = i === shown ? size + 1.5 : size;
    const half = Math.max(reach, 2 + 3.4 * String(keypose.number).length);
    const numbered = crowded ? i === shown : x - half > free;
    pen.fillStyle = i === shown ? paint.accent : keyposeColour(keypose.source);
    pen.globalAlpha = 0.5;
    if (bottom > middle) pen.fillRect(x - 0.75, middle, 1.5, bottom - middle);
    pen.globalAlpha = 1;
    if (!numbered) return rounded(pen, x - 2, middle - 3, 4, 6, keypose.source === "local" ? 0 : 2);
    rounded(pen, x - half, middle - reach, 2 * half, 2 * reach, keypose.source === "local" ? 2 : reach);
    pen.fillStyle = paint.dark ? "#12141c" : "#ffffff";
    pen.fillText(String(keypose.number), x, middle + 0.5);
    free = x + half;
  });
  pen.textAlign = "start";
}

/** The time of the keypose nearest to a place, if it is within some pixels; else undefined. */
export function keyposeAt(span: Span, page: PageData, x: number, within: number): number | undefined {
  let [best, found]: [number, number | undefined] = [within, undefined];
  for (const { time } of page.keyposes) {
    const off = Math.abs(xOf(span, time) - x);
    if (off <= best) [best, found] = [off, time];
  }
  return found;
}

export function drawJoins(pen: Pen, span: Span, page: PageData, top: number, bottom: number): void {
  pen.strokeStyle = paint.ink;
  pen.lineWidth = 1;
  pen.setLineDash([2, 3]);
  pen.beginPath();
  inside(page.joins, span, 0, (time) => {
    const x = Math.round(xOf(span, time)) + 0.5;
    pen.moveTo(x, top);
    pen.lineTo(x, bottom);
  });
  pen.stroke();
  pen.setLineDash([]);
}

/** A curve 0…1 over the span between `bottom` and `top`; filled to the bottom where `fill`. */
export function drawCurve(pen: Pen, span: Span, curve: Curve, top: number, bottom: number, colour: string, fill: boolean): void {
  if (!curve.values.length) return;
  // A point each 3 px is enough: more would draw a long song as a thicket.
  const step = Math.max(1, Math.round((3 * curve.rate * (span.to - span.from)) / span.width));
  pen.beginPath();
  const first = Math.max(Math.floor((span.from * curve.rate) / step) - 1, 0) * step;
  const end = Math.min(curve.values.length, span.to * curve.rate + 2 * step);
  for (let i = first; i < end; i += step) {
    const level = mean(curve.values, i - step / 2, i + step / 2 + 1);
    pen.lineTo(xOf(span, i / curve.rate), bottom - level * (bottom - top));
  }
  if (fill) {
    pen.lineTo(xOf(span, (curve.values.length - 1) / curve.rate), bottom);
    pen.lineTo(xOf(span, first / curve.rate), bottom);
    pen.fillStyle = colour;
    pen.fill();
  } else {
    pen.strokeStyle = colour;
    pen.lineWidth = 1.5;
    pen.lineJoin = "round";
    pen.stroke();
  }
}

export type EnergyCurves = { name: string; curve: Curve; candidates: readonly number[] }[];

export function readEnergy(energy: EnergyData): EnergyCurves {
  return [
    { name: "local", curve: readCurve(energy.local), candidates: energy.local_candidates },
    { name: "global", curve: readCurve(energy.world), candidates: energy.world_candidates },
  ];
}

/** Both energies, and where asked for hollow marks, round and square, at their candidates. */
export function drawEnergy(
  pen: Pen, span: Span, energies: EnergyCurves, top: number, bottom: number, marked: boolean,
): void {
  for (const { name, curve, candidates } of energies) {
    const colour = keyposeColour(name);
    drawCurve(pen, span, curve, top, bottom, colour, false);
    if (!marked) continue;
    pen.fillStyle = paint.band;
    inside(candidates, span, 1, (time) => {
      const level = curve.values[Math.round(time * curve.rate)] ?? 0;
      const [x, y] = [xOf(span, time), bottom - level * (bottom - top)];
      pen.beginPath();
      if (name === "local") pen.rect(x - 2.5, y - 2.5, 5, 5);
      else pen.arc(x, y, 3, 0, 2 * Math.PI);
      pen.fill();
      pen.stroke();
    });
  }
}
