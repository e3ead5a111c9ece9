// Drawing a dance over its song: waveform and beats, stops of the hands, the clips used and their joins, both intensities.

import { ClipColours } from "../colours";
import type { PageData } from "../contract";
import { type Curve, lastBefore, readCurve } from "../data";
import { drawCurve, drawJoins, drawWaveform, shortened, type Span, xOf } from "../lanes";
import type { Stretch } from "./locks";
import type { Palette } from "./palette";
import { type Painter, RULER } from "./track";

export const [CLIPS, LEVELS, GAP] = [24, 52, 5]; // [px]
const ON_BEAT = 0.1; // [s]
const [STOPS, NAME] = [16, 15]; // [px] lane of the stops, and of a second dance's name

/** A second dance below the first, whose clips are drawn too; `at` says where a second of it is on the first one's clock. */
export interface Beside {
  name: string;
  scene: PageData;
  at: (time: number) => number;
}

export class ScorePainter implements Painter {
  locks: () => readonly Stretch[] = () => [];
  /** Seconds that are being dragged over. */
  drawn?: Stretch;
  wave: Curve;
  private readonly music: Curve;
  private readonly motion: Curve;
  private hues: ClipColours;
  private other?: Beside;
  private otherMotion: Curve;

  constructor(
    readonly scene: PageData,
    private readonly colours: () => Palette,
  ) {
    this.wave = readCurve(scene.waveform);
    [this.music, this.motion] = [readCurve(scene.music_intensity), readCurve(scene.motion_intensity)];
    this.otherMotion = this.motion;
    this.hues = huesOf(scene);
  }

  get beside(): Beside | undefined {
    return this.other;
  }

  set beside(beside: Beside | undefined) {
    this.other = beside;
    this.otherMotion = readCurve((beside ?? this).scene.motion_intensity);
    this.hues = huesOf(this.scene, beside?.scene);
  }

  /** Height that all lanes need. */
  get height(): number {
    const waves = this.wave.values.length || this.scene.beats.length ? 74 : 30;
    return RULER + waves + this.clipLane + this.besideLane + GAP + LEVELS;
  }

  /** Height of the clips. */
  private get clipLane(): number {
    return this.scene.moves.length ? CLIPS + GAP : 0;
  }

  /** Height of what is drawn of the second dance: its name, its stops, its clips. */
  private get besideLane(): number {
    if (!this.other) return 0;
    return NAME + STOPS + GAP + (this.other.scene.moves.length ? CLIPS + GAP : 0);
  }

  paint(pen: CanvasRenderingContext2D, span: Span, height: number, now: number): void {
    const colours = this.colours();
    const levels = height - LEVELS;
    const second = levels - GAP - this.besideLane;
    const clips = second - this.clipLane;
    const bottom = clips - GAP;
    pen.fillStyle = colours.lane;
    pen.fillRect(0, RULER, span.width, bottom - RULER);
    pen.fillRect(0, levels, span.width, LEVELS);
    const [middle, half] = [(RULER + STOPS + bottom) / 2, (bottom - RULER - STOPS) / 2 - 2];
    drawWaveform(pen, span, this.wave, middle, half, colours.wave, 3);
    drawWaveform(pen, span, this.wave, middle, half, colours.played, 3, now);
    this.drawBeats(pen, span, RULER, bottom, colours);
    this.drawLevels(pen, span, levels, height, colours);
    if (this.scene.moves.length) this.drawClips(pen, span, this.scene, (t) => t, clips);
    if (this.other) this.drawBeside(pen, span, this.other, second, now, colours);
    drawJoins(pen, span, this.scene, RULER, clips + (this.scene.moves.length ? CLIPS : 0));
    this.drawStopsOn(pen, span, this.scene, (t) => t, RULER, now);
    this.drawKeyposes(pen, span, bottom, colours);
    this.drawLocks(pen, span, clips, colours);
  }

  /** What the signs mean, of those that are drawn. */
  legend(): [sign: string, colour: keyof Palette, means: string][] {
    const { beats, stops, joins, keyposes } = this.scene;
    const all: [boolean, string, keyof Palette, string][] = [
      [beats.length > 0, "┃", "soft", "beat"],
      [stops.length > 0, "◆", "ink", beats.length ? "stop; hollow off the beat" : "stop of the hands"],
      [keyposes.length > 0, "●", "keypose", "keypose"],
      [joins.length > 0, "┊", "ink", "join"],
      [this.music.values.length > 0, "▆", "music", "music's intensity"],
      [this.motion.values.length > 0, "∿", "motion", this.music.values.length ? "dance's intensity" : "intensity"],
      [this.other !== undefined, "╌", "chord", "the second dance's"],
    ];
    return all.filter(([there]) => there).map(([, sign, colour, means]) => [sign, colour, means]);
  }

  paintWhole(pen: CanvasRenderingContext2D, span: Span, height: number): void {
    const colours = this.colours();
    const clips = this.scene.moves.length ? 9 : 0;
    drawCurve(pen, span, this.music, 2, height - clips, colours.music, true);
    drawWaveform(pen, span, this.wave, (height - clips) / 2, (height - clips) / 2 - 3, colours.wave, 2);
    drawCurve(pen, span, this.motion, 2, height - clips, colours.motion, false);
    this.each(this.scene, (clip, from, to) => {
      pen.fillStyle = this.hues.strong(clip);
      pen.fillRect(
        xOf(span, from) + 0.5,
        height - clips + 1,
        Math.max(xOf(span, to) - xOf(span, from) - 1, 1),
        clips - 2,
      );
    });
    pen.fillStyle = colours.lock;
    for (const { from, to } of this.locks()) pen.fillRect(xOf(span, from), 0, xOf(span, to) - xOf(span, from), 3);
  }

  private drawBeats(pen: CanvasRenderingContext2D, span: Span, top: number, bottom: number, colours: Palette): void {
    const starts = new Set(this.scene.downbeats);
    for (const time of this.scene.beats) {
      if (time < span.from || time > span.to) continue;
      const down = starts.has(time);
      pen.fillStyle = down ? colours.soft : colours.beat;
      pen.fillRect(Math.round(xOf(span, time)) - (down ? 1 : 0.5), top, down ? 2 : 1, bottom - top);
    }
  }

  /** Both intensities, 0…1: the music's filled, the dance's as a line. */
  private drawLevels(pen: CanvasRenderingContext2D, span: Span, top: number, bottom: number, colours: Palette): void {
    drawCurve(pen, span, this.music, top + 3, bottom, colours.music, true);
    drawCurve(pen, span, this.motion, top + 3, bottom - 1, colours.motion, false);
    if (!this.other) return;
    const { at } = this.other; // a straight line: the second's clock runs evenly on the first one's
    const [begin, second] = [at(0), at(1) - at(0)];
    const own = { from: (span.from - begin) / second, to: (span.to - begin) / second, width: span.width };
    pen.setLineDash([5, 4]);
    drawCurve(pen, own, this.otherMotion, top + 3, bottom - 1, colours.chord, false);
    pen.setLineDash([]);
  }

  /** The second dance: its name over its stops, and its clips. */
  private drawBeside(
    pen: CanvasRenderingContext2D,
    span: Span,
    { name, scene, at }: Beside,
    top: number,
    now: number,
    colours: Palette,
  ): void {
    pen.fillStyle = colours.soft;
    pen.fillText(shortened(pen, name, span.width - 12), 2, top + NAME / 2 - 1);
    pen.fillStyle = colours.lane;
    pen.fillRect(0, top + NAME, span.width, STOPS);
    this.drawStopsOn(pen, span, scene, at, top + NAME, now);
    this.drawClips(pen, span, scene, at, top + NAME + STOPS + GAP);
  }

  /** Hollow where no beat is near: the eye goes to them. */
  private drawStopsOn(
    pen: CanvasRenderingContext2D,
    span: Span,
    { beats, stops }: PageData,
    at: (time: number) => number,
    top: number,
    now: number,
  ): void {
    const off = (time: number): number => {
      const before = lastBefore(beats, time);
      return Math.min(Math.abs(time - (beats[before] ?? -9)), Math.abs(time - (beats[before + 1] ?? 1e9)));
    };
    const y = top + STOPS / 2 + 1;
    const colours = this.colours();
    for (const stop of stops) {
      const time = at(stop);
      if (time < span.from - 1 || time > span.to + 1) continue;
      const size = 5 * (1 + 0.6 * Math.max(0, now >= time ? 1 - (now - time) / 0.35 : 0));
      const x = xOf(span, time);
      pen.beginPath();
      for (const [dx, dy] of [
        [0, -1],
        [1, 0],
        [0, 1],
        [-1, 0],
      ])
        pen.lineTo(x + size * dx, y + size * dy);
      pen.closePath();
      pen.fillStyle = pen.strokeStyle = colours.ink;
      pen.lineWidth = 1.25;
      if (!beats.length || off(stop) <= ON_BEAT) pen.fill();
      else pen.stroke();
    }
  }

  private drawKeyposes(pen: CanvasRenderingContext2D, span: Span, bottom: number, colours: Palette): void {
    pen.fillStyle = colours.keypose;
    for (const { time } of this.scene.keyposes) {
      const x = xOf(span, time);
      if (x < -5 || x > span.width + 5) continue;
      pen.beginPath();
      pen.arc(x, bottom - 6, 4, 0, 2 * Math.PI);
      pen.fill();
    }
  }

  private drawClips(
    pen: CanvasRenderingContext2D,
    span: Span,
    scene: PageData,
    at: (time: number) => number,
    top: number,
  ): void {
    this.each(scene, (clip, from, to) => {
      const [left, right] = [xOf(span, at(from)), xOf(span, at(to))];
      if (right < 0 || left > span.width) return;
      pen.save();
      pen.beginPath();
      pen.rect(left + 0.75, top, Math.max(right - left - 1.5, 1), CLIPS);
      pen.clip();
      pen.fillStyle = this.hues.fill(clip);
      pen.fillRect(left, top, right - left, CLIPS);
      pen.fillStyle = this.hues.ink(clip);
      const [first, last] = [Math.max(left, 0) + 6, Math.min(right, span.width) - 5];
      pen.fillText(shortened(pen, clip, last - first), first, top + CLIPS / 2 + 0.5);
      pen.restore();
    });
  }

  private drawLocks(pen: CanvasRenderingContext2D, span: Span, clips: number, colours: Palette): void {
    const all = this.drawn ? [...this.locks(), this.drawn] : this.locks();
    for (const { from, to } of all) {
      const [left, right] = [xOf(span, from), xOf(span, to)];
      pen.fillStyle = colours.locked;
      pen.fillRect(left, RULER, right - left, clips + CLIPS - RULER);
      pen.strokeStyle = colours.lock;
      pen.lineWidth = 1.5;
      pen.strokeRect(left, RULER + 0.75, right - left, clips + CLIPS - RULER - 1.5);
      if (right - left < 50) continue;
      pen.fillStyle = colours.lock;
      pen.fillRect(left, clips - GAP - 15, 46, 15);
      pen.fillStyle = colours.mark;
      pen.fillText("locked", left + 6, clips - GAP - 7);
    }
  }

  /** Goes through the stretches of clips, each until the next begins. */
  private each(scene: PageData, draw: (clip: string, from: number, to: number) => void): void {
    scene.moves.forEach(({ clip, at_s }, i) => draw(clip, at_s, scene.moves[i + 1]?.at_s ?? scene.duration));
  }
}

/** Colours of the clips of both, the same for the same clip. */
function huesOf(scene: PageData, other?: PageData): ClipColours {
  return new ClipColours([...scene.moves, ...(other?.moves ?? [])].map(({ clip }) => clip));
}
