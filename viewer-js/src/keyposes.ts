// The keyposes: which one is shown, stepping from one to the next, and a strip of small pictures of them.

import type { Clock } from "./clock";
import type { KeyposeData, PageData } from "./contract";
import type { Dancer } from "./dancer";
import { lastBefore } from "./data";

const AHEAD = 0.001; // [s] by which a keypose may be ahead and still be the one that is shown
const BACK = 0.5; // [s] of playing within which stepping back goes to the keypose before
const SIDE = 0.42; // [rad] that pictures are taken off the body's front
const [WIDTH, HEIGHT] = [54, 60]; // [px] of a picture
const SHAPES: Record<string, string> = { global: "round", local: "square", kept: "round" };

export class Keyposes {
  private readonly times: number[];
  private readonly buttons: HTMLButtonElement[] = [];
  private shown = -2;

  constructor(
    private readonly page: PageData,
    private readonly clock: Clock,
    private readonly strip: HTMLElement,
    private readonly label: HTMLElement,
    private readonly seek: (time: number) => void,
  ) {
    this.times = page.keyposes.map(({ time }) => time);
    document.body.classList.toggle("keyposed", this.possible);
  }

  get possible(): boolean {
    return this.times.length > 0;
  }

  /** Index of the last keypose that is not after a time; -1 before the first. */
  at(time: number): number {
    return lastBefore(this.times, time + AHEAD);
  }

  step(by: 1 | -1): void {
    const time = this.clock.now(performance.now());
    const here = this.at(time);
    const since = here < 0 ? 0 : time - this.times[here];
    const again = by < 0 && since > (this.clock.playing ? BACK : 2 * AHEAD) ? 1 : 0; // back to the one just passed
    this.go(here + by + again);
  }

  /** The strip of pictures; the dancer is posed for each. */
  draw(dancer: Dancer): void {
    if (!this.possible) return;
    const views = this.page.keyposes.map((keypose) => {
      dancer.pose(keypose.time);
      return new View(dancer, this.page, keypose);
    });
    const scale = HEIGHT / (1.08 * Math.max(...views.map(({ top }) => top), 0.5));
    this.page.keyposes.forEach((keypose, i) => {
      const button = document.createElement("button");
      const number = document.createElement("b");
      number.textContent = String(keypose.number);
      number.className = SHAPES[keypose.source] ?? "other";
      button.title = `Keypose ${keypose.number}: ${keypose.time.toFixed(2)} s, beat ${keypose.beat}, ${keypose.source}`;
      button.append(views[i].picture(scale), number);
      button.addEventListener("click", () => this.go(i));
      this.buttons.push(button);
    });
    this.strip.append(...this.buttons);
  }

  update(time: number): void {
    const index = this.at(time);
    if (index === this.shown || !this.possible) return;
    this.buttons[this.shown]?.removeAttribute("aria-current");
    this.shown = index;
    const keypose = this.page.keyposes[index];
    this.label.textContent = keypose ? `Keypose ${keypose.number}` : "Keypose –";
    const button = this.buttons[Math.max(index, 0)];
    if (keypose) button?.setAttribute("aria-current", "true");
    if (button) this.strip.scrollLeft = button.offsetLeft - (this.strip.clientWidth - button.offsetWidth) / 2;
  }

  private go(index: number): void {
    const to = Math.min(Math.max(index, 0), this.times.length - 1);
    if (to >= 0) this.seek(this.times[to]);
  }
}

interface Line {
  part: boolean; // set off from what is behind it
  from: [x: number, y: number]; // [m] right and up
  to: [x: number, y: number];
  near: number;
  width: number;
  colour: string;
}

/** The dancer as posed, flat, from the front of a keypose. */
class View {
  readonly top: number;
  private readonly lines: Line[];

  constructor(dancer: Dancer, page: PageData, keypose: KeyposeData) {
    const yaw = keypose.facing + SIDE;
    const [dx, dy] = [-Math.sin(yaw), Math.cos(yaw)]; // towards who looks
    const { x, y } = dancer.centre;
    this.lines = page.capsules.map(({ colour, group }, i) => {
      const [a, b] = [dancer.ends[2 * i], dancer.ends[2 * i + 1]];
      const flat = (p: typeof a): [number, number] => [-(p.x - x) * dy + (p.y - y) * dx, p.z - page.floor];
      const near = ((a.x + b.x) * dx + (a.y + b.y) * dy) / 2;
      const part = /arm|hand|leg/.test(group);
      return { part, from: flat(a), to: flat(b), near, width: a.w + b.w, colour };
    });
    this.lines.sort((one, other) => one.near - other.near);
    this.top = Math.max(...this.lines.map(({ from, to, width }) => Math.max(from[1], to[1]) + width / 2));
  }

  picture(scale: number): HTMLCanvasElement {
    const canvas = document.createElement("canvas");
    const sharp = Math.min(Math.max(devicePixelRatio || 1, 2), 3);
    [canvas.width, canvas.height] = [WIDTH * sharp, HEIGHT * sharp];
    const pen = canvas.getContext("2d") as CanvasRenderingContext2D;
    pen.scale(sharp, sharp);
    pen.lineCap = "round";
    pen.fillStyle = "rgba(130, 142, 170, 0.26)"; // in a dark room too
    pen.beginPath();
    pen.ellipse(WIDTH / 2, HEIGHT - 4, 0.38 * scale, 3.2, 0, 0, 2 * Math.PI);
    pen.fill();
    for (const line of this.lines) {
      const width = Math.max(line.width * scale, 1.2);
      if (line.part) this.stroke(pen, line, scale, width + 1.2, "rgba(255, 255, 255, 0.5)");
      this.stroke(pen, line, scale, width, line.colour);
    }
    return canvas;
  }

  private stroke(pen: CanvasRenderingContext2D, line: Line, scale: number, width: number, colour: string): void {
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.beginPath();
    pen.moveTo(WIDTH / 2 + line.from[0] * scale, HEIGHT - 4 - line.from[1] * scale);
    pen.lineTo(WIDTH / 2 + line.to[0] * scale + 0.01, HEIGHT - 4 - line.to[1] * scale);
    pen.stroke();
  }
}
