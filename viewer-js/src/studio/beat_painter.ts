// Drawing a song: its waveform under the beats, how much the chords change at each, and how intense it is.

import { type Curve, readCurve } from "../data";
import { drawCurve, drawWaveform, type Span, xOf } from "../lanes";
import type { Beat } from "./beat_sheet";
import type { SongView } from "./contract";
import type { Palette } from "./palette";
import { type Painter, RULER } from "./track";

const [CHORDS, LEVELS, GAP] = [30, 46, 6]; // [px]
const GRIP = 13; // [px] of the head by which a beat is held
const CROWDED = 15; // [px] between beats, below which the weak ones have no heads

export class BeatPainter implements Painter {
  selected = -1;
  private readonly wave: Curve;
  private readonly intensity: Curve;

  constructor(
    private readonly song: SongView,
    private readonly beats: () => readonly Beat[],
    private readonly colours: () => Palette,
  ) {
    this.wave = evened(readCurve(song.waveform));
    this.intensity = readCurve(song.intensity);
  }

  paint(pen: CanvasRenderingContext2D, span: Span, height: number, now: number): void {
    const colours = this.colours();
    const chords = height - LEVELS - GAP - CHORDS;
    const bottom = chords - GAP;
    pen.fillStyle = colours.lane;
    pen.fillRect(0, RULER, span.width, bottom - RULER);
    pen.fillRect(0, chords, span.width, CHORDS);
    pen.fillRect(0, chords + CHORDS + GAP, span.width, LEVELS);
    const middle = (RULER + GRIP + bottom) / 2;
    const half = (bottom - RULER - GRIP) / 2 - 2;
    drawWaveform(pen, span, this.wave, middle, half, colours.wave, 3);
    drawWaveform(pen, span, this.wave, middle, half, colours.played, 3, now);
    this.drawChords(pen, span, chords, colours);
    drawCurve(pen, span, this.intensity, chords + CHORDS + GAP + 3, height, colours.music, true);
    this.drawBeats(pen, span, bottom, height, colours);
    this.name(pen, "chord change", chords, colours);
    this.name(pen, "intensity", chords + CHORDS + GAP, colours);
  }

  paintWhole(pen: CanvasRenderingContext2D, span: Span, height: number): void {
    const colours = this.colours();
    drawCurve(pen, span, this.intensity, 2, height, colours.music, true);
    drawWaveform(pen, span, this.wave, height / 2, height / 2 - 3, colours.wave, 2);
    for (const { time, down } of this.beats()) {
      if (!down) continue;
      pen.fillStyle = colours.soft;
      pen.fillRect(xOf(span, time), height - 6, 1, 6);
    }
  }

  private drawBeats(pen: CanvasRenderingContext2D, span: Span, bottom: number, height: number, colours: Palette): void {
    const beats = this.beats();
    const seconds = beats.length > 1 ? (beats[beats.length - 1].time - beats[0].time) / (beats.length - 1) : 1;
    const crowded = xOf(span, span.from + seconds) < CROWDED;
    let place = 0;
    pen.textAlign = "center";
    beats.forEach(({ time, down }, i) => {
      place = down ? 1 : place + (place > 0 ? 1 : 0);
      const x = Math.round(xOf(span, time));
      if (x < -20 || x > span.width + 20) return;
      const chosen = i === this.selected;
      pen.fillStyle = chosen ? colours.accent : down ? colours.soft : colours.beat;
      pen.fillRect(x - (down || chosen ? 1 : 0.5), RULER, down || chosen ? 2 : 1, bottom - RULER);
      pen.globalAlpha = 0.35;
      pen.fillRect(x - 0.5, bottom, 1, height - bottom);
      pen.globalAlpha = 1;
      if (crowded && !down && !chosen) return;
      this.head(pen, x, chosen, down, colours);
      pen.fillStyle = chosen || down ? colours.mark : colours.ink;
      if (place > 0 && !crowded) pen.fillText(String(place), x, RULER + GRIP / 2 + 1);
    });
    pen.textAlign = "start";
  }

  private head(pen: CanvasRenderingContext2D, x: number, chosen: boolean, down: boolean, colours: Palette): void {
    const half = down || chosen ? 8 : 7;
    pen.fillStyle = chosen ? colours.accent : down ? colours.soft : colours.line;
    pen.beginPath();
    pen.moveTo(x - half, RULER);
    pen.lineTo(x + half, RULER);
    pen.lineTo(x + half, RULER + GRIP - 3);
    pen.lineTo(x, RULER + GRIP + 4);
    pen.lineTo(x - half, RULER + GRIP - 3);
    pen.fill();
  }

  /** Chord change was measured on the beats that the server had; it stands where they were. */
  private drawChords(pen: CanvasRenderingContext2D, span: Span, top: number, colours: Palette): void {
    pen.fillStyle = colours.chord;
    this.song.beats.forEach((time, i) => {
      const tall = (CHORDS - 3) * Math.min(Math.max(this.song.chord_change[i] ?? 0, 0), 1);
      const x = xOf(span, time);
      if (x > -4 && x < span.width + 4) pen.fillRect(x - 2, top + CHORDS - tall, 4, tall);
    });
  }

  private name(pen: CanvasRenderingContext2D, words: string, top: number, colours: Palette): void {
    pen.fillStyle = colours.ground;
    pen.globalAlpha = 0.75;
    pen.fillRect(0, top, pen.measureText(words).width + 12, 15);
    pen.globalAlpha = 1;
    pen.fillStyle = colours.soft;
    pen.fillText(words, 6, top + 8);
  }
}

/** The waveform bent so that quiet and loud songs alike show their notes: its median becomes 0.45. */
export function evened(wave: Curve): Curve {
  const median = Float32Array.from(wave.values).sort()[wave.values.length >> 1];
  const bend = Math.min(Math.max(Math.log(0.45) / Math.log(median), 0.5), 2) || 1;
  return { values: wave.values.map((value) => value ** bend), rate: wave.rate };
}
