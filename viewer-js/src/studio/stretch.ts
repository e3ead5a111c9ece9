// Which part of a song is danced to: dragged over its waveform, and heard.

import { type Curve, readCurve } from "../data";
import { drawCurve, drawWaveform, type Span, xOf } from "../lanes";
import { ask, words } from "./api";
import { evened } from "./beat_painter";
import type { SongView } from "./contract";
import { h } from "./elements";
import { palette } from "./palette";
import { type Hand, type Painter, RULER, Track } from "./track";
import { Transport } from "./transport";
import type { Studio } from "./view";
import { exactly } from "./words";

const [HEIGHT, DRAGGED, SHORTEST] = [170, 5, 1]; // [px] [px] [s]

export interface Part {
  from: number; // [s]
  to: number; // [s]
}

export class StretchChooser implements Painter, Hand {
  readonly root = h("section", { class: "stretch", "aria-label": "The song" });
  private track?: Track;
  private transport?: Transport;
  private wave: Curve = { values: new Float32Array(), rate: 1 };
  private intensity = this.wave;
  private downbeats: readonly number[] = [];
  private shown = "";
  private began = 0;
  private beganAt = 0;
  private drawn?: Part;

  constructor(
    private readonly studio: Studio,
    private readonly part: () => Part,
    private readonly chosen: (part: Part) => void,
  ) {}

  /** Another song is to be danced to. */
  async open(id: string): Promise<void> {
    if (!id || id === this.shown) return;
    this.shown = id;
    try {
      const song = await ask<SongView>("GET", `songs/${id}`);
      if (this.shown === id) this.show(song);
    } catch (error) {
      this.root.replaceChildren(h("p", { class: "problem", role: "alert" }, words(error)));
    }
  }

  frame(time: number): void {
    this.transport?.update(time);
    this.track?.draw(time, this.studio.player.playing);
  }

  key(event: KeyboardEvent): boolean {
    return this.transport?.key(event) ?? false;
  }

  dim(): void {
    this.track?.stale();
  }

  paint(pen: CanvasRenderingContext2D, span: Span, height: number, now: number): void {
    const colours = palette(this.studio.dark());
    pen.fillStyle = colours.lane;
    pen.fillRect(0, RULER, span.width, height - RULER);
    drawCurve(pen, span, this.intensity, RULER + 4, height, colours.music, true);
    const [middle, half] = [(RULER + height) / 2, (height - RULER) / 2 - 4];
    drawWaveform(pen, span, this.wave, middle, half, colours.wave, 3);
    drawWaveform(pen, span, this.wave, middle, half, colours.played, 3, now);
    pen.fillStyle = colours.soft;
    for (const time of this.downbeats) pen.fillRect(xOf(span, time), height - 8, 1, 8);
    const { from, to } = this.drawn ?? this.part();
    const [left, right] = [xOf(span, from), xOf(span, to)];
    pen.fillStyle = colours.locked;
    pen.fillRect(left, RULER, right - left, height - RULER);
    pen.strokeStyle = colours.lock;
    pen.lineWidth = 2;
    pen.strokeRect(left + 1, RULER + 1, right - left - 2, height - RULER - 2);
  }

  paintWhole(): void {
    // all of it is in the strip itself
  }

  down(t: number, x: number): void {
    [this.began, this.beganAt] = [this.snapped(t), x];
  }

  move(t: number, x: number): void {
    if (Math.abs(x - this.beganAt) < DRAGGED && !this.drawn) return;
    const to = this.snapped(t);
    this.drawn = {
      from: Math.max(Math.min(this.began, to), 0),
      to: Math.min(Math.max(this.began, to), this.studio.player.duration),
    };
    this.track?.touch();
  }

  up(t: number): void {
    const { drawn } = this;
    this.drawn = undefined;
    this.track?.touch();
    if (!drawn) this.studio.player.seek(t);
    else if (drawn.to - drawn.from >= SHORTEST) this.chosen(drawn);
  }

  hover(): string {
    return "text";
  }

  private show(song: SongView): void {
    const { player, dark } = this.studio;
    this.wave = evened(readCurve(song.waveform));
    this.intensity = readCurve(song.intensity);
    this.downbeats = song.downbeats;
    player.load({ url: `/api/songs/${song.id}/sound`, start: 0, speed: 1, duration: song.duration });
    this.transport = new Transport(player);
    const words = (): string => {
      const { from, to } = this.part();
      return `The song, ${exactly(song.duration)} long; danced to is ${exactly(from)} to ${exactly(to)}.`;
    };
    this.track = new Track(
      words,
      "Give the seconds above, in From second and Seconds.",
      song.duration,
      song.duration,
      HEIGHT,
      this,
      this,
      (t) => player.seek(t),
      () => palette(dark()),
    );
    this.root.replaceChildren(
      h("p", { class: "soft" }, "Drag over the song to choose what is danced to."),
      this.track.root,
      this.transport.root,
    );
  }

  /** A time near the beginning of a bar is that beginning. */
  private snapped(t: number): number {
    const near = this.downbeats.find(
      (time) => Math.abs(time - t) < (6 * (this.track?.seconds ?? 0)) / (this.track?.span.width ?? 1),
    );
    return Math.round((near ?? t) * 10) / 10;
  }
}
