// Which stretch of time the detail strip shows: that about now, or another one that was scrolled or zoomed to.

import type { Span } from "./lanes";

const FIRST = 95; // [px/s]
const NEAREST = 600; // [px/s]
const STEP = 1.35; // of a zoom by a key or button

export class View {
  private scale = FIRST; // [px/s]
  private from?: number; // [s] at the left edge; undefined where the view goes with the head
  private width = 1; // [px]

  constructor(private readonly duration: number) {}

  /** Whether the play head stays in the middle. */
  get following(): boolean {
    return this.from === undefined;
  }

  /** The stretch shown on so many pixels; a view that the head has left goes with it again. */
  span(now: number, width: number, playing = false): Span {
    this.width = Math.max(width, 1);
    this.scale = Math.min(Math.max(this.scale, this.least()), NEAREST);
    const seconds = this.width / this.scale;
    if (playing && this.from !== undefined && (now < this.from || now > this.from + seconds)) this.from = undefined;
    const from = this.from ?? now - seconds / 2;
    return { from, to: from + seconds, width: this.width };
  }

  /** Zooms so that the time at `x` stays there; without it, about the head or the middle. */
  zoom(by: number, now: number, x?: number): void {
    const before = this.span(now, this.width);
    this.scale = Math.min(Math.max(this.scale * by, this.least()), NEAREST);
    if (x === undefined && this.following) return;
    const at = x ?? this.width / 2;
    const time = before.from + at / (this.width / (before.to - before.from));
    this.put(time - at / this.scale);
  }

  nearer(now: number): void {
    this.zoom(STEP, now);
  }

  farther(now: number): void {
    this.zoom(1 / STEP, now);
  }

  /** Scrolls by pixels, away from the head if need be. */
  scroll(pixels: number, now: number): void {
    this.put(this.span(now, this.width).from + pixels / this.scale);
  }

  /** Goes with the head again. */
  follow(): void {
    this.from = undefined;
  }

  /** The whole dance, or the first scale again. */
  whole(): void {
    const all = this.scale <= this.least() * 1.01;
    this.scale = all ? FIRST : this.least();
    if (all) this.from = undefined;
    else this.put(0);
  }

  private put(from: number): void {
    const seconds = this.width / this.scale;
    const room = 0.1 * seconds; // seen past both ends
    this.from = Math.max(Math.min(from, this.duration + room - seconds), -room);
    if (seconds >= this.duration) this.from = (this.duration - seconds) / 2;
  }

  private least(): number {
    return Math.min(this.width / Math.max(this.duration * 1.02, 1), FIRST);
  }
}
