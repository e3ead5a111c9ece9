// Correcting beats: they are dragged, added where somebody clicks twice, taken away by a key; every step can be undone.

import { xOf } from "../lanes";
import { BeatPainter } from "./beat_painter";
import type { Beat, BeatSheet } from "./beat_sheet";
import type { SongView } from "./contract";
import { button, h, say } from "./elements";
import type { Palette } from "./palette";
import type { Player } from "./player";
import { type Hand, Track, zooms } from "./track";

const NEAR = 8; // [px] of a beat that can be taken hold of
const FIRST_SHOWN = 12; // [s]
const NUDGE = 0.005; // [s]

export class BeatEditor implements Hand {
  readonly root: HTMLElement;
  readonly track: Track;
  private readonly painter: BeatPainter;
  private readonly told = h("p", { class: "told", role: "status", "aria-live": "polite" });
  private readonly undoing = button("Undo", () => this.sheet.undo(), { title: "Undo (Ctrl+Z)" });
  private readonly redoing = button("Redo", () => this.sheet.redo(), { title: "Redo (Ctrl+Shift+Z)" });
  private readonly one: HTMLButtonElement[];
  private dragged?: number; // [s] where the beat that is held would be
  private panned = 0; // [s] under the pointer when it went down
  private moved = false;

  constructor(
    song: SongView,
    private readonly sheet: BeatSheet,
    private readonly player: Player,
    colours: () => Palette,
    extra: readonly HTMLElement[],
  ) {
    this.painter = new BeatPainter(song, () => this.drawn(), colours);
    const words =
      "Beats of the song. Comma and full stop choose a beat, Alt with arrows moves it, Delete takes it away, A adds one at the play head, D begins a bar.";
    this.track = new Track(words, song.duration, FIRST_SHOWN, 0, this.painter, this, (t) => player.seek(t), colours);
    this.one = [
      button("Delete", () => this.remove(), { title: "Take the chosen beat away (Delete)" }),
      button("Bar begins", () => this.down(), { title: "A bar begins at the chosen beat, or not (D)" }),
      button("Bars from here", () => this.bars(), { title: "Bars begin here and go on so (B)" }),
    ];
    this.root = h(
      "section",
      { class: "editor", "aria-label": "Beats" },
      h(
        "div",
        { class: "row tools" },
        this.undoing,
        this.redoing,
        h("i", { class: "gap" }),
        button("Add", () => this.add(), { title: "A beat at the play head (A); or click twice" }),
        ...this.one,
        h("i", { class: "gap" }),
        button("Halve", () => sheet.halve(), { title: "Half as many beats" }),
        button("Double", () => sheet.double(), { title: "Twice as many beats" }),
        h("i", { class: "gap" }),
        ...extra,
        h("i", { class: "fill" }),
        zooms(this.track),
      ),
      this.track.root,
      this.told,
    );
    this.show();
  }

  /** After every change of the beats. */
  show(): void {
    const { sheet, painter } = this;
    if (painter.selected >= sheet.beats.length) painter.selected = -1;
    this.undoing.disabled = !sheet.canUndo;
    this.redoing.disabled = !sheet.canRedo;
    for (const one of this.one) one.disabled = painter.selected < 0;
    const beat = sheet.beats[painter.selected];
    const where = beat
      ? `Beat ${painter.selected + 1} of ${sheet.beats.length} at ${beat.time.toFixed(3)} s${beat.down ? ", a bar begins" : ""}`
      : "";
    say(
      this.told,
      where || `${sheet.beats.length} beats. Drag one to move it, click twice to add one; click a beat to choose it.`,
    );
    this.track.stale();
  }

  select(index: number): void {
    this.painter.selected = Math.min(Math.max(index, -1), this.sheet.beats.length - 1);
    const beat = this.sheet.beats[this.painter.selected];
    if (beat) this.track.reveal(beat.time);
    this.show();
  }

  get selected(): number {
    return this.painter.selected;
  }

  key(event: KeyboardEvent): boolean {
    const key = event.key.toLowerCase();
    if ((event.ctrlKey || event.metaKey) && (key === "z" || key === "y")) {
      if (key === "y" || event.shiftKey) this.sheet.redo();
      else this.sheet.undo();
      return true;
    }
    if (event.ctrlKey || event.metaKey) return false;
    if (event.altKey)
      return this.nudge(key === "arrowleft" ? -NUDGE : key === "arrowright" ? NUDGE : 0, event.shiftKey);
    const does: Record<string, () => void> = {
      ",": () => this.step(-1),
      ".": () => this.step(1),
      delete: () => this.remove(),
      backspace: () => this.remove(),
      a: () => this.add(),
      d: () => this.down(),
      b: () => this.bars(),
      escape: () => this.select(-1),
      "+": () => this.track.zoom(1 / 1.6),
      "=": () => this.track.zoom(1 / 1.6),
      "-": () => this.track.zoom(1.6),
    };
    does[key]?.();
    return does[key] !== undefined;
  }

  down(t?: number, x?: number, _y?: number): void {
    if (t === undefined || x === undefined) {
      if (this.selected >= 0) this.sheet.toggleDown(this.selected);
      return;
    }
    [this.panned, this.moved] = [t, false];
    const beat = this.beatAt(t, x);
    this.select(beat);
    this.dragged = beat >= 0 ? this.sheet.beats[beat].time : undefined;
  }

  move(t: number): void {
    if (Math.abs(t - this.panned) > (3 / this.track.span.width) * this.track.seconds) this.moved = true;
    if (!this.moved) return;
    if (this.dragged === undefined) this.track.goTo(this.track.from + this.panned - t);
    else this.dragged = this.sheet.within(this.selected, t);
    this.track.touch();
  }

  up(t: number): void {
    const to = this.dragged;
    this.dragged = undefined;
    this.track.touch();
    if (to !== undefined && this.moved) this.sheet.move(this.selected, to);
    else if (to === undefined && !this.moved) this.player.seek(t);
  }

  hover(t: number, x: number): string {
    return this.beatAt(t, x) >= 0 ? "ew-resize" : "default";
  }

  twice(t: number, x: number): void {
    if (this.beatAt(t, x) < 0) this.select(this.sheet.add(t));
  }

  private add(): void {
    this.select(this.sheet.add(this.player.now(performance.now())));
  }

  private remove(): void {
    if (this.selected >= 0) this.sheet.remove(this.selected);
  }

  private bars(): void {
    if (this.selected >= 0) this.sheet.barsFrom(this.selected, this.sheet.meter);
  }

  private step(by: number): void {
    const near = this.sheet.nearest(this.player.now(performance.now()));
    this.select(this.selected < 0 ? near : Math.max(this.selected + by, 0));
  }

  private nudge(by: number, far: boolean): boolean {
    if (!by || this.selected < 0) return false;
    this.sheet.move(this.selected, this.sheet.beats[this.selected].time + by * (far ? 4 : 1));
    return true;
  }

  private beatAt(t: number, x: number): number {
    const near = this.sheet.nearest(t);
    return near >= 0 && Math.abs(xOf(this.track.span, this.sheet.beats[near].time) - x) <= NEAR ? near : -1;
  }

  /** The beats as they are drawn: one that is being dragged is under the pointer already. */
  private drawn(): readonly Beat[] {
    const { dragged } = this;
    if (dragged === undefined) return this.sheet.beats;
    return this.sheet.beats.map((beat, i) => (i === this.selected ? { ...beat, time: dragged } : beat));
  }
}
