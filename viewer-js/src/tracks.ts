// The lanes of the detail strip: what each is called, how tall it is, how it is drawn, what it says of a time.

import type { ClipColours } from "./colours";
import type { PageData } from "./contract";
import { type Curve, lastBefore, readCurve } from "./data";
import * as lanes from "./lanes";
import { paint } from "./palette";
import * as words from "./words";

type Pen = CanvasRenderingContext2D;
export type TrackName = "keyposes" | "ruler" | "beats" | "stops" | "sound" | "energy" | "intensity" | "clips";

export interface Track {
  name: TrackName;
  title: string;
  tall: number; // [px]
  there: boolean; // whether there is anything to show
  shown: boolean;
  draw(pen: Pen, span: lanes.Span, top: number, bottom: number, now: number): void;
  /** What lies at a time, or within some seconds of it. */
  say(time: number, within: number): string;
}

/** The waveform bent so that quiet and loud songs alike show their notes: its median becomes 0.45. */
export function evened(wave: Curve): Curve {
  const median = Float32Array.from(wave.values).sort()[wave.values.length >> 1];
  const bend = Math.min(Math.max(Math.log(0.45) / Math.log(median), 0.5), 2) || 1;
  return { values: wave.values.map((value) => value ** bend), rate: wave.rate };
}

/** All lanes from top to bottom, those without anything to show too. */
export function tracksOf(page: PageData, colours: ClipColours): Track[] {
  const lane = (name: TrackName, title: string, tall: number, there: boolean, draw: Track["draw"], say: Track["say"]): Track =>
    ({ name, title, tall, there, shown: true, draw, say });
  const ruler: Track["draw"] = (pen, span, top, bottom) => drawRuler(pen, span, page.duration, top, bottom);
  return [
    lane("keyposes", "Keyposes", 20, page.keyposes.length > 0,
      (pen, span, top, bottom, now) => lanes.drawKeyposes(pen, span, page, (top + bottom) / 2, 8, 0, now),
      (time, within) => words.keypose(page, time, within)),
    lane("ruler", "Time", 15, true, ruler, () => "drag to choose a stretch to loop"),
    lane("beats", "Beats and bars", 14, page.beats.length > 0,
      (pen, span, top, bottom, now) => drawBars(pen, span, page, top, bottom, now),
      (time, within) => words.beat(page, time, within)),
    lane("stops", "Stops", 15, page.stops.length > 0,
      (pen, span, top, bottom, now) => lanes.drawStops(pen, span, page, (top + bottom) / 2, 5, now),
      (time, within) => words.stop(page, time, within)),
    soundTrack(page, lane),
    energyTrack(page, lane),
    intensityTrack(page, lane),
    lane("clips", "Clips", 20, page.moves.length > 0,
      (pen, span, top, bottom) => lanes.drawClips(pen, span, page, colours, top + 1, bottom - top - 1),
      (time) => words.move(page, time)),
  ];
}

type Make = (name: TrackName, title: string, tall: number, there: boolean, draw: Track["draw"], say: Track["say"]) => Track;

function soundTrack(page: PageData, lane: Make): Track {
  const wave = evened(readCurve(page.waveform));
  const draw: Track["draw"] = (pen, span, top, bottom, now) => {
    const [middle, half] = [(top + bottom) / 2, (bottom - top) / 2 - 1];
    lanes.drawWaveform(pen, span, wave, middle, half, paint.wave, 3);
    lanes.drawWaveform(pen, span, wave, middle, half, paint.heard, 3, now);
  };
  return lane("sound", "Waveform", 36, wave.values.length > 0, draw, (time) => `loudness ${words.percent(wave, time)}`);
}

function energyTrack(page: PageData, lane: Make): Track {
  const curves = page.energy ? lanes.readEnergy(page.energy) : [];
  return lane("energy", "Energy", 42, curves.length > 0,
    (pen, span, top, bottom) => lanes.drawEnergy(pen, span, curves, top + 3, bottom - 2, true),
    (time) => curves.map(({ name, curve }) => `${name} energy ${words.percent(curve, time)}`).join(", "));
}

function intensityTrack(page: PageData, lane: Make): Track {
  const [music, motion] = [readCurve(page.music_intensity), readCurve(page.motion_intensity)];
  const name = page.compared?.heat ? "distance" : "intensity of the dance";
  const draw: Track["draw"] = (pen, span, top, bottom) => {
    lanes.drawCurve(pen, span, music, top + 2, bottom, paint.music, true);
    lanes.drawCurve(pen, span, motion, top + 2, bottom, paint.dance, false);
  };
  const parts = (time: number): string[] => [
    ...(music.values.length ? [`intensity of the music ${words.percent(music, time)}`] : []),
    ...(motion.values.length ? [`${name} ${words.percent(motion, time)}`] : []),
  ];
  return lane("intensity", page.compared?.heat ? "Distance" : "Intensity", 28, music.values.length + motion.values.length > 0, draw,
    (time) => parts(time).join(", "));
}

const RULES = [0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 60, 120, 300]; // [s]

/** Seconds, as many as there is room for. */
function drawRuler(pen: Pen, span: lanes.Span, duration: number, top: number, bottom: number): void {
  const each = (50 * (span.to - span.from)) / span.width;
  const step = RULES.find((rule) => rule >= each) ?? RULES[RULES.length - 1];
  pen.fillStyle = paint.words;
  pen.textBaseline = "middle";
  for (let i = Math.max(Math.ceil(span.from / step), 0); i * step <= Math.min(span.to, duration); i++) {
    const x = lanes.xOf(span, i * step);
    pen.fillRect(Math.round(x), bottom - 4, 1, 4);
    pen.fillText(words.seconds(i * step, step < 1 ? 1 : 0), x + 4, (top + bottom) / 2 + 0.5);
  }
}

/** Beats as ticks, downbeats taller and with the number of their bar. */
function drawBars(pen: Pen, span: lanes.Span, page: PageData, top: number, bottom: number, now: number): void {
  const apart = page.beats.length > 1 ? (span.width * (page.beats[1] - page.beats[0])) / (span.to - span.from) : 99;
  const last = lastBefore(page.beats, now);
  if (apart > 3) {
    lanes.inside(page.beats, span, 0, (time) => {
      const lit = time === page.beats[last] && now - time < 0.2;
      pen.fillStyle = lit ? paint.accent : paint.soft;
      pen.fillRect(Math.round(lanes.xOf(span, time)) - (lit ? 2 : 1), bottom - 7, lit ? 4 : 2, 7);
    });
  }
  let free = -Infinity;
  pen.textBaseline = "middle";
  page.downbeats.forEach((time, i) => {
    const x = lanes.xOf(span, time);
    if (x < -30 || x > span.width || x < free) return;
    pen.fillStyle = paint.words;
    pen.fillRect(Math.round(x) - 1, top + 1, 2, bottom - top - 1);
    pen.fillText(String(i + 1), x + 4, top + 7);
    free = x + 26;
  });
}
