// Correcting beats: they are dragged, added where somebody clicks twice, taken away by a key; every step can be undone.

import { xOf } from "../lanes";
import { BeatPainter } from "./beat_painter";
import type { Beat, BeatSheet } from "./beat_sheet";
import type { SongView } from "./contract";
import { button, h, say } from "./elements";
import { songInWords } from "./in_words";
import type { Palette } from "./palette";
import type { Player } from "./player";
import { type Hand, Track, zooms } from "./track";

const NEAR = 8; // [px] of a beat that can be taken hold of
const [FIRST_SHOWN, ROOM] = [12, 50]; // [s] that are shown at first, if each has so many [px]
const NUDGE = 0.005; // [s]
const HOW = "Drag one to move it, click twice to add one; click a beat to choose it.";
const KEYS =
  "Comma and full stop choose the beat before and after, Alt with arrows moves it, Delete takes it away, A adds one at the play head, D begins a bar there, B begins bars from there on, Ctrl Z undoes. What was done is told below.";

export class BeatEditor implements Hand {
  readonly root: HTMLElement;
  readonly track: Track;
  private readonly painter: BeatPainter;
  private readonly told = h("p", { class: "told", role: "status", "aria-live": "polite" });
  private did = ""; // what was done to the beats just now, to be told
  private readonly undoing = button("Undo", () => this.undo(), { title: "Undo (Ctrl+Z)" });
  private readonly redoing = button("Redo", () => this.redo(), { title: "Redo (Ctrl+Shift+Z)" });
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
    const words = (): string => songInWords(song, sheet.beats, sheet.meter);
    const seconds = Math.min(FIRST_SHOWN, innerWidth / ROOM);
    this.track = new Track(words, KEYS, song.duration, seconds, 0, this.painter, this, (t) => player.seek(t), colours);
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
        button("Halve", () => this.does("Halved", () => sheet.halve()), { title: "Half as many beats" }),
        button("Double", () => this.does("Doubled", () => sheet.double()), { title: "Twice as many beats" }),
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
    const done = this.did && `${this.did}. `;
    this.did = "";
    say(this.told, done + (this.where() || `${sheet.beats.length} beats. ${HOW}`));
    this.track.stale();
  }

  /** The chosen beat in words. */
  private where(): string {
    const { sheet, painter } = this;
    const beat = sheet.beats[painter.selected];
    if (!beat) return "";
    const place = `Beat ${painter.selected + 1} of ${sheet.beats.length} at ${beat.time.toFixed(3)} s`;
    return `${place}${beat.down ? ", a bar begins" : ""}`;
  }

  /** Changes the beats, and says what was done. */
  private does(what: string, change: () => void): void {
    this.did = what;
    change();
    if (!this.did) return; // it was told with the change
    this.did = "Nothing changed";
    this.show();
  }

  private undo(): void {
    if (this.sheet.canUndo) this.back("Undone", () => this.sheet.undo());
  }

  private redo(): void {
    if (this.sheet.canRedo) this.back("Done again", () => this.sheet.redo());
  }

  /** Goes a step back or on; where that changes one beat, it is chosen. */
  private back(what: string, step: () => void): void {
    const before = this.sheet.beats;
    step();
    this.did = what;
    this.select(this.sheet.changedFrom(before) ?? this.selected);
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
      if (key === "y" || event.shiftKey) this.redo();
      else this.undo();
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
    };
    does[key]?.();
    return does[key] !== undefined || this.track.key(event);
  }

  down(t?: number, x?: number, _y?: number): void {
    if (t === undefined || x === undefined) {
      this.change("Changed", () => this.sheet.toggleDown(this.selected));
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
    if (to !== undefined && this.moved) this.change("Moved", () => this.sheet.move(this.selected, to));
    else if (to === undefined && !this.moved) this.player.seek(t);
  }

  hover(t: number, x: number): string {
    return this.beatAt(t, x) >= 0 ? "ew-resize" : "default";
  }

  twice(t: number, x: number): void {
    if (this.beatAt(t, x) < 0) this.addAt(t);
  }

  private add(): void {
    this.addAt(this.player.now(performance.now()));
  }

  private addAt(time: number): void {
    const before = this.sheet.beats.length;
    const index = this.sheet.add(time);
    this.did = this.sheet.beats.length > before ? "Added" : "One is there already";
    this.select(index);
  }

  private remove(): void {
    this.change("Taken away; chosen now", () => this.sheet.remove(this.selected));
  }

  private bars(): void {
    this.change("Bars begin here and go on so", () => this.sheet.barsFrom(this.selected, this.sheet.meter));
  }

  /** Changes the chosen beat, if there is one. */
  private change(what: string, change: () => void): void {
    if (this.selected >= 0) this.does(what, change);
  }

  private step(by: number): void {
    const near = this.sheet.nearest(this.player.now(performance.now()));
    this.select(this.selected < 0 ? near : Math.max(this.selected + by, 0));
  }

  private nudge(by: number, far: boolean): boolean {
    if (!by || this.selected < 0) return false;
    this.does("Moved", () => this.sheet.move(this.selected, this.sheet.beats[this.selected].time + by * (far ? 4 : 1)));
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
