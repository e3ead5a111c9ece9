// What is drawn, in words, for those who do not see it.

import type { PageData } from "../contract";
import { type Curve, lastBefore, readCurve } from "../data";
import type { Beat } from "./beat_sheet";
import type { SongView } from "./contract";
import type { Stretch } from "./locks";
import { exactly, pace, plural } from "./words";

const SAME = 0.004; // [s] a beat that was not moved
const ON_BEAT = 0.1; // [s]
const MOST = 6; // of things that are told one by one

/** How many of the beats are none that was heard, and how many that were heard are gone. */
export function corrected(beats: readonly Beat[], heard: readonly number[]): { own: number; gone: number } {
  const times = beats.map(({ time }) => time);
  const away = (from: readonly number[], to: readonly number[]): number =>
    from.filter((time) => off(to, time) > SAME).length;
  return { own: away(times, heard), gone: away(heard, times) };
}

/** A song: tempo, meter, beats, those that were put right, and where most happens in it. */
export function songInWords(song: SongView, beats: readonly Beat[], meter: number): string {
  const down = beats.filter((beat) => beat.down).length;
  const { own, gone } = corrected(beats, song.heard_beats);
  const parts = [
    `Beats over the waveform of ${exactly(song.duration)}`,
    pace(song.tempo),
    song.tempo > 0 ? `${meter} in a bar` : "",
    `${plural(beats.length, "beat")}, ${down} of them begin bars`,
    own || gone ? `put right: ${own} not as they were heard, ${gone} of those heard are gone` : "all as they were heard",
    highest(readCurve(song.intensity), "the music"),
  ];
  return sentence(parts);
}

/** The lanes of a timeline, from above. */
export function sceneInWords(scene: PageData, locks: readonly Stretch[], beside = ""): string {
  const { beats, downbeats, stops, keyposes, moves } = scene;
  const on = stops.filter((time) => off(beats, time) <= ON_BEAT).length;
  const clips = [...new Set(moves.map(({ clip }) => clip))];
  const parts = [
    `Timeline of ${exactly(scene.duration)}`,
    beats.length ? `${plural(beats.length, "beat")}, ${downbeats.length} of them begin bars` : "no beats",
    `${plural(stops.length, "stop")} of the hands${beats.length ? `, ${on} of them on a beat` : ""}`,
    plural(keyposes.length, "keypose"),
    moves.length ? `${plural(moves.length, "stretch", "stretches")} of ${plural(clips.length, "clip")}: ${some(clips.map((clip) => `“${clip}”`))}` : "",
    beside && `below them the clips of ${beside}`,
    highest(readCurve(scene.music_intensity), "the music"),
    highest(readCurve(scene.motion_intensity), moves.length ? "the dance" : "the motion"),
    locks.length ? `locked: ${some(locks.map(({ from, to }) => `${exactly(from)} to ${exactly(to)}`))}` : "",
  ];
  return sentence(parts);
}

function sentence(parts: readonly string[]): string {
  return `${parts.filter(Boolean).join("; ")}.`;
}

function some(all: readonly string[]): string {
  return all.length > MOST ? `${all.slice(0, MOST).join(", ")} and ${all.length - MOST} more` : all.join(", ");
}

/** Where something is most intense; nothing where that is not known. */
function highest({ values, rate }: Curve, what: string): string {
  if (!values.length) return "";
  let best = 0;
  values.forEach((value, i) => (best = value > values[best] ? i : best));
  return `${what} is most intense at ${exactly(best / rate)}`;
}

/** Seconds from a time to the nearest of others. */
function off(times: readonly number[], time: number): number {
  const before = lastBefore(times, time);
  return Math.min(Math.abs(time - (times[before] ?? -Infinity)), Math.abs(time - (times[before + 1] ?? Infinity)));
}
