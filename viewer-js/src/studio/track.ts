// A strip of time that can be moved and zoomed, with its seconds above and the whole of it below. What it shows is drawn by
// its painter; what is pressed on it is told to its hand.

import { type Span, timeAt, xOf } from "../lanes";
import { drag, Strip } from "../strip";
import { button, h } from "./elements";
import { FONT, type Palette } from "./palette";
import { exactly } from "./words";

export const RULER = 20; // [px]
const CLOSEST = 1.5; // [s] of which never less is shown
const STEPS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 60, 120, 300]; // [s] between numbers
const ROOM = 62; // [px] that a number gets
const LEFT_AT = 0.92; // of the width: where the strip turns its page while it plays

export interface Painter {
  /** What is in the span, below the ruler; with the time that plays. */
  paint(pen: CanvasRenderingContext2D, span: Span, height: number, now: number): void;
  /** The whole of it, small. */
  paintWhole(pen: CanvasRenderingContext2D, span: Span, height: number): void;
}

/** What pointers do on the strip below its ruler; `x` and `y` in pixels, `t` in seconds. */
export interface Hand {
  down(t: number, x: number, y: number, event: PointerEvent): void;
  move(t: number, x: number, y: number, event: PointerEvent): void;
  up(t: number, x: number, y: number): void;
  hover?(t: number, x: number, y: number): string;
  twice?(t: number, x: number, y: number): void;
}

let hints = 0;

/** Buttons that zoom. */
export function zooms(track: Track): HTMLElement {
  return h(
    "span",
    { class: "zooms" },
    button("−", () => track.zoom(1.6), {
      "aria-label": "Zoom out",
      title: "Zoom out (ctrl and wheel)",
      class: "text round",
    }),
    button("+", () => track.zoom(1 / 1.6), {
      "aria-label": "Zoom in",
      title: "Zoom in (ctrl and wheel)",
      class: "text round",
    }),
  );
}

export class Track {
  readonly root: HTMLElement;
  readonly canvas: HTMLCanvasElement;
  from = 0; // [s] at the left edge
  seconds: number; // that are shown
  duration: number;
  private readonly strip: Strip;
  private readonly whole: Strip;
  private readonly picture = new Strip(h("canvas"));
  private pictureOf = "";
  private drawn = "";
  private ruled = false; // whether the pointer is on the ruler
  private held = false; // whether a pointer is down: the strip must not turn its page under it

  private readonly words: () => string;
  private told = ""; // which part the small strip says is shown

  /** Of `height` pixels, or as its style has it where that is 0; `words` say what is drawn, `keys` what can be done. */
  constructor(
    words: () => string,
    keys: string,
    duration: number,
    seconds: number,
    height: number,
    private readonly painter: Painter,
    private readonly hand: Hand,
    private readonly seek: (time: number) => void,
    private readonly colours: () => Palette,
  ) {
    this.duration = Math.max(duration, 0.1);
    this.seconds = Math.min(seconds, this.duration);
    this.words = words;
    const hint = h("p", { class: "unseen", id: `keys${++hints}` }, keys);
    this.canvas = h("canvas", { class: "track", tabindex: 0, role: "application", "aria-describedby": hint.id });
    if (height) this.canvas.style.height = `${height}px`;
    const whole = h("canvas", { class: "whole", role: "img" });
    this.root = h("div", { class: "tracks" }, this.canvas, whole, hint);
    this.name();
    [this.strip, this.whole] = [new Strip(this.canvas), new Strip(whole)];
    this.listen();
    drag(
      whole,
      (event) => this.centre(event),
      (event) => this.centre(event),
    );
  }

  get span(): Span {
    return { from: this.from, to: this.from + this.seconds, width: this.canvas.clientWidth || 1 };
  }

  /** What is in it is other than it was. */
  stale(): void {
    this.pictureOf = "";
    this.name();
    this.touch();
  }

  private name(): void {
    const words = this.words();
    if (this.canvas.getAttribute("aria-label") !== words) this.canvas.setAttribute("aria-label", words);
  }

  /** It is to be drawn again though nothing has moved. */
  touch(): void {
    this.drawn = "";
  }

  draw(now: number, playing: boolean): void {
    const fitted = this.strip.fit();
    if (!this.strip.width) return;
    if (playing && !this.held) this.goAlong(now);
    const { pen, width, height } = this.strip;
    const [colours, span] = [this.colours(), this.span];
    const what = `${now} ${this.from} ${this.seconds} ${width} ${height} ${colours.ground}`;
    if (what === this.drawn && !fitted) return; // a paused page must not heat a phone
    this.drawn = what;
    pen.fillStyle = colours.ground;
    pen.fillRect(0, 0, width, height);
    pen.font = FONT;
    this.rule(pen, span, colours);
    pen.save();
    pen.beginPath();
    pen.rect(0, RULER, width, height - RULER);
    pen.clip();
    this.painter.paint(pen, span, height, now);
    pen.restore();
    pen.fillStyle = colours.accent;
    pen.fillRect(xOf(span, now) - 1, 0, 2, height);
    this.drawWhole(now, colours);
  }

  zoom(factor: number, at = this.from + this.seconds / 2): void {
    const seconds = Math.min(Math.max(this.seconds * factor, CLOSEST), this.duration);
    this.goTo(at - ((at - this.from) * seconds) / this.seconds, seconds);
  }

  /** Plus and minus zoom. */
  key(event: KeyboardEvent): boolean {
    if (event.ctrlKey || event.metaKey || event.altKey || !"+=-".includes(event.key)) return false;
    this.zoom(event.key === "-" ? 1.6 : 1 / 1.6);
    return true;
  }

  /** Brings a time into sight. */
  reveal(time: number): void {
    if (time < this.from || time > this.from + this.seconds) this.goTo(time - this.seconds / 2);
  }

  goTo(from: number, seconds = this.seconds): void {
    this.seconds = seconds;
    this.from = Math.min(Math.max(from, 0), Math.max(this.duration - seconds, 0));
  }

  private goAlong(now: number): void {
    const part = (now - this.from) / this.seconds;
    if (part > LEFT_AT && part < 1.2) this.goTo(now - 0.08 * this.seconds);
    else if (part < 0 || part > 1) this.goTo(now - 0.3 * this.seconds);
  }

  private rule(pen: CanvasRenderingContext2D, span: Span, colours: Palette): void {
    const least = (ROOM * this.seconds) / span.width;
    const step = STEPS.find((seconds) => seconds >= least) ?? 600;
    pen.fillStyle = colours.soft;
    pen.textBaseline = "middle";
    for (let i = Math.floor(span.from / step); i * step <= span.to; i++) {
      const x = xOf(span, i * step);
      pen.fillRect(Math.round(x), 13, 1, 7);
      const seconds = i * step;
      const rest = (seconds % 60).toFixed(step < 1 ? 1 : 0).padStart(step < 1 ? 4 : 2, "0");
      const words = `${Math.floor((seconds + 1e-6) / 60)}:${rest}`;
      if (x + 4 + pen.measureText(words).width <= span.width) pen.fillText(words, x + 4, 9); // none is cut off
    }
  }

  private drawWhole(now: number, colours: Palette): void {
    this.whole.fit();
    const { pen, width, height } = this.whole;
    if (!width) return;
    const span = { from: 0, to: this.duration, width };
    this.tell();
    this.drawPicture(span, height, colours);
    pen.clearRect(0, 0, width, height);
    pen.drawImage(this.picture.canvas, 0, 0, width, height);
    pen.fillStyle = colours.ink;
    pen.globalAlpha = 0.09;
    pen.fillRect(xOf(span, this.from), 0, Math.max(xOf(span, this.seconds), 3), height);
    pen.globalAlpha = 1;
    pen.strokeStyle = colours.soft;
    pen.strokeRect(xOf(span, this.from) + 0.5, 0.5, Math.max(xOf(span, this.seconds) - 1, 2), height - 1);
    pen.fillStyle = colours.accent;
    pen.fillRect(xOf(span, now) - 1, 0, 2, height);
  }

  private tell(): void {
    const told = `All of it, small; above is ${exactly(this.from)} to ${exactly(this.from + this.seconds)}.`;
    if (told !== this.told) this.whole.canvas.setAttribute("aria-label", (this.told = told));
  }

  /** What does not move is drawn once. */
  private drawPicture(span: Span, height: number, colours: Palette): void {
    const canvas = this.picture.canvas;
    const scale = Math.min(devicePixelRatio || 1, 3);
    const what = `${span.width} ${height} ${scale} ${colours.ground}`;
    if (what === this.pictureOf) return;
    this.pictureOf = what;
    [canvas.width, canvas.height] = [Math.round(span.width * scale), Math.round(height * scale)];
    const { pen } = this.picture;
    pen.setTransform(scale, 0, 0, scale, 0, 0);
    pen.fillStyle = colours.lane;
    pen.fillRect(0, 0, span.width, height);
    pen.font = FONT;
    this.painter.paintWhole(pen, span, height);
  }

  private centre(event: PointerEvent): void {
    const box = this.whole.canvas.getBoundingClientRect();
    const time = ((event.clientX - box.left) / box.width) * this.duration;
    if (event.type === "pointerdown") this.seek(time);
    this.goTo(time - this.seconds / 2);
  }

  private listen(): void {
    const { canvas, hand } = this;
    const place = (event: MouseEvent): [number, number, number] => {
      const box = canvas.getBoundingClientRect();
      const [x, y] = [event.clientX - box.left, event.clientY - box.top];
      return [timeAt(this.span, x), x, y];
    };
    let last: [number, number, number] = [0, 0, 0];
    drag(
      canvas,
      (event) => {
        last = place(event);
        this.held = true;
        this.ruled = last[2] < RULER;
        if (this.ruled) this.seek(last[0]);
        else hand.down(...last, event);
      },
      (event) => {
        last = place(event);
        if (this.ruled) this.seek(last[0]);
        else hand.move(...last, event);
      },
      () => {
        this.held = false;
        if (!this.ruled) hand.up(...last);
      },
    );
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons) return;
      const [t, x, y] = place(event);
      canvas.style.cursor = y < RULER ? "col-resize" : (hand.hover?.(t, x, y) ?? "default");
    });
    canvas.addEventListener("dblclick", (event) => hand.twice?.(...place(event)));
    canvas.addEventListener("wheel", (event) => this.wheel(event, place(event)[0]), { passive: false });
  }

  private wheel(event: WheelEvent, at: number): void {
    const sideways = Math.abs(event.deltaX) > Math.abs(event.deltaY);
    if (!event.ctrlKey && !event.metaKey && !event.shiftKey && !sideways) return; // the page scrolls
    event.preventDefault();
    if (event.ctrlKey || event.metaKey) return this.zoom(Math.exp(event.deltaY / 300), at);
    this.goTo(this.from + ((sideways ? event.deltaX : event.deltaY) * this.seconds) / this.strip.width);
  }
}
