// What lies at a time of the dance, in words: for tooltips and for whoever has the page read out.

import type { PageData } from "./contract";
import { type Curve, lastBefore } from "./data";

const FULL = 0.05; // [s] by which a second is full early: the last frame comes before the end

/** `1:05`, the seconds that are full, or `1:05.2`. */
export function seconds(time: number, digits = 0): string {
  const whole = digits ? Number(time.toFixed(digits)) : Math.floor(time + FULL);
  const rest = (whole % 60).toFixed(digits).padStart(digits ? digits + 3 : 2, "0");
  return `${Math.floor(whole / 60)}:${rest}`;
}

export function percent(curve: Curve, time: number): string {
  const value = curve.values[Math.round(time * curve.rate)];
  return value === undefined ? "–" : `${Math.round(100 * value)} %`;
}

/** The index of the time nearest to another, if it is within some seconds; else -1. */
export function nearest(times: readonly number[], time: number, within: number): number {
  const low = lastBefore(times, time);
  const both = [low, low + 1].filter((i) => i >= 0 && i < times.length && Math.abs(times[i] - time) <= within);
  return both.sort((i, j) => Math.abs(times[i] - time) - Math.abs(times[j] - time))[0] ?? -1;
}

/** `bar 6, beat 3`; where bars are not known `beat 23`; empty before the first beat. */
export function place(page: PageData, time: number): string {
  const index = lastBefore(page.beats, time + 0.001);
  if (index < 0) return "";
  const bar = lastBefore(page.downbeats, page.beats[index] + 0.001);
  if (bar < 0) return `beat ${index + 1}`;
  return `bar ${bar + 1}, beat ${index - lastBefore(page.beats, page.downbeats[bar] + 0.001) + 1}`;
}

export function beat(page: PageData, time: number, within: number): string {
  const index = nearest(page.beats, time, within);
  if (index < 0) return place(page, time);
  const gap = (page.beats[index + 1] ?? page.beats[index]) - page.beats[index] || page.beats[index] - page.beats[index - 1];
  const tempo = gap > 0 ? `, ${Math.round(60 / gap)} a minute` : "";
  return `beat ${index + 1} at ${page.beats[index].toFixed(2)} s${tempo}`;
}

export function stop(page: PageData, time: number, within: number): string {
  const index = nearest(page.stops, time, within);
  if (index < 0) return "stops of the hands";
  const at = page.stops[index];
  return `stop at ${at.toFixed(2)} s${offBeat(page, at)}`;
}

/** `, 20 ms after its beat`. */
function offBeat(page: PageData, time: number): string {
  const index = nearest(page.beats, time, Infinity);
  if (index < 0) return "";
  const off = Math.round(1000 * (time - page.beats[index]));
  if (off === 0) return ", on its beat";
  return `, ${Math.abs(off)} ms ${off > 0 ? "after" : "before"} a beat`;
}

export function keypose(page: PageData, time: number, within: number): string {
  const index = nearest(page.keyposes.map((each) => each.time), time, within);
  if (index < 0) return "keyposes";
  const { number, beat: on, source, time: at } = page.keyposes[index];
  return `keypose ${number} at ${at.toFixed(2)} s, beat ${on}, ${source}`;
}

/** A move: its clip, and which seconds of it. */
export function clip(page: PageData, move: number): string {
  const { clip: name, from_s, to_s } = page.moves[move];
  return `${name}, ${from_s.toFixed(1)} to ${to_s.toFixed(1)} s`;
}

/** The clip that is danced at a time, and which second of it. */
export function move(page: PageData, time: number): string {
  const index = lastBefore(page.moves.map((each) => each.at_s), time);
  const here = page.moves[index];
  if (!here) return "";
  const end = page.moves[index + 1]?.at_s ?? page.duration;
  const part = Math.min(Math.max((time - here.at_s) / Math.max(end - here.at_s, 1e-6), 0), 1);
  const second = here.from_s + part * (here.to_s - here.from_s);
  return `${here.clip}, ${second.toFixed(1)} s of it (move ${index + 1} of ${page.moves.length})`;
}
