// The timeline of a dance: clicks seek, and dragging over it locks a stretch.

import type { PageData } from "../contract";
import type { Curve } from "../data";
import { xOf } from "../lanes";
import { evened } from "./beat_painter";
import { h } from "./elements";
import { sceneInWords } from "./in_words";
import type { Locks } from "./locks";
import type { Palette } from "./palette";
import type { Player } from "./player";
import { type Beside, ScorePainter } from "./score_painter";
import { type Hand, Track, zooms } from "./track";

const SNAPS = 7; // [px] to a beat
const DRAGGED = 5; // [px]
const FIRST_SHOWN = 20; // [s]

export class Score implements Hand {
  readonly root: HTMLElement;
  readonly track: Track;
  readonly painter: ScorePainter;
  private readonly legend = h("ul", { class: "legend" });
  private began = 0;
  private beganAt = 0;

  constructor(
    private readonly scene: PageData,
    private readonly player: Player,
    private readonly locks: Locks | undefined,
    colours: () => Palette,
  ) {
    this.painter = new ScorePainter(scene, colours);
    if (locks) this.painter.locks = () => locks.stretches;
    const keys = "Arrows go back and on, plus and minus zoom.";
    this.track = new Track(
      () => sceneInWords(scene, locks?.stretches ?? [], this.painter.beside?.name),
      locks ? `${keys} Square brackets lock a stretch from and to the play head.` : keys,
      scene.duration,
      FIRST_SHOWN,
      this.painter.height,
      this.painter,
      this,
      (t) => player.seek(t),
      colours,
    );
    this.explain();
    this.root = h(
      "section",
      { class: "score", "aria-label": "Timeline" },
      this.track.root,
      h("div", { class: "row" }, this.legend, zooms(this.track)),
    );
  }

  /** The waveform of the song, of which second `start + speed t` is heard at second t. */
  sound(song: Curve, start: number, speed: number): void {
    const { rate } = song;
    const count = Math.max(Math.floor(this.scene.duration * rate), 0);
    const values = Float32Array.from(
      { length: count },
      (_, i) => song.values[Math.round(start * rate + i * speed)] ?? 0,
    );
    this.painter.wave = evened({ values, rate });
    this.track.stale();
  }

  private explain(): void {
    const all = this.painter.legend().map(([sign, colour, means]) => h("li", {}, mark(sign, colour), means));
    this.legend.replaceChildren(...all);
  }

  compare(beside?: Beside): void {
    this.painter.beside = beside;
    this.explain();
    this.track.canvas.style.height = `${this.painter.height}px`;
    this.track.stale();
  }

  down(t: number, x: number): void {
    [this.began, this.beganAt] = [this.snapped(t), x];
  }

  move(t: number, x: number): void {
    if (!this.locks || (Math.abs(x - this.beganAt) < DRAGGED && !this.painter.drawn)) return;
    const to = this.snapped(t);
    this.painter.drawn = { from: Math.min(this.began, to), to: Math.max(this.began, to) };
    this.track.touch();
  }

  up(t: number): void {
    const { drawn } = this.painter;
    this.painter.drawn = undefined;
    this.track.touch();
    if (drawn) this.locks?.add(drawn.from, drawn.to);
    else this.player.seek(t);
  }

  hover(): string {
    return this.locks ? "cell" : "default";
  }

  /** A time that is near a beat is the beat's. */
  private snapped(t: number): number {
    const { span } = this.track;
    let best = t;
    let off = SNAPS;
    for (const beat of this.scene.beats) {
      const away = Math.abs(xOf(span, beat) - xOf(span, t));
      if (away < off) [best, off] = [beat, away];
    }
    return best;
  }
}

/** A sign of the legend in the colour that it is drawn in; pale ones get the legend's own. */
function mark(sign: string, colour: keyof Palette): HTMLElement {
  return h("b", { class: `of-${colour}`, "aria-hidden": "true" }, sign);
}
