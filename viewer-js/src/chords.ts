// The motion graph as a picture: the way that is danced in strong lines, the current place lit.

import type { ClipColours } from "./colours";
import type { PageData } from "./contract";
import { type Arc, type Chord, type Graph } from "./graph";
import { FONT, shortened } from "./lanes";
import { paint } from "./palette";
import { Strip } from "./strip";
import type { Tip } from "./tip";

type Pen = CanvasRenderingContext2D;
const [THICK, THIN] = [15, 6]; // [px] of arcs that are danced and that are not
const NAMED = 14; // [px] that a name is high
const BESIDE = 84; // [px] for names on each side of the circle, if there is as much
const RECENT = 4; // joins that are still seen as danced just now
const LIT = 0.5; // [s] that a join is lit after it was danced

export class Chords {
  private readonly strip: Strip;
  private readonly still: Strip; // what does not move
  private painted = "";

  constructor(
    canvas: HTMLCanvasElement,
    private readonly graph: Graph,
    private readonly page: PageData,
    private readonly colours: ClipColours,
    private readonly seek: (time: number) => void,
    private readonly now: () => number,
    tip: Tip,
  ) {
    this.strip = new Strip(canvas);
    this.still = new Strip(document.createElement("canvas"));
    tip.watch(canvas, (x, y) => this.say(x, y));
    canvas.addEventListener("click", (event) => this.go(event.offsetX, event.offsetY));
    const [clips, joins] = [graph.arcs.length, graph.path.length];
    canvas.setAttribute("aria-label", `The motion graph: the dance goes through ${clips} clips that are drawn, over ${joins} joins.`);
  }

  draw(time: number): void {
    const { strip } = this;
    strip.fit();
    const { pen, width, height } = strip;
    if (!width || !height) return;
    this.drawStill(width, height);
    pen.clearRect(0, 0, width, height);
    pen.drawImage(this.still.canvas, 0, 0, width, height);
    pen.save();
    pen.translate(width / 2, height / 2);
    this.drawNow(pen, time);
    pen.restore();
  }

  /** Pixels from the middle to the arcs' outer rim. */
  private get radius(): number {
    const { width, height } = this.strip;
    return Math.max(Math.min(height / 2 - NAMED, width / 2 - Math.min(BESIDE, width / 4)), 40);
  }

  private drawStill(width: number, height: number): void {
    const scale = Math.min(devicePixelRatio || 1, 3);
    const like = `${width} ${height} ${scale} ${paint.dark}`;
    if (like === this.painted) return;
    this.painted = like;
    const { canvas, pen } = this.still;
    [canvas.width, canvas.height] = [Math.round(width * scale), Math.round(height * scale)];
    pen.setTransform(scale, 0, 0, scale, (scale * width) / 2, (scale * height) / 2);
    pen.font = FONT;
    pen.lineWidth = 1;
    pen.strokeStyle = paint.quiet;
    for (const chord of this.graph.sample) this.chord(pen, chord);
    pen.lineWidth = 1.5;
    pen.globalAlpha = 0.6;
    this.graph.path.forEach((chord, i) => {
      pen.strokeStyle = this.colours.strong(this.page.moves[i].clip);
      this.chord(pen, chord);
    });
    pen.globalAlpha = 1;
    for (const arc of this.graph.arcs) this.drawArc(pen, arc);
    this.drawNames(pen, width / 2, height / 2);
  }

  private drawArc(pen: Pen, { clip, from, to, danced }: Arc): void {
    const thick = danced.length ? THICK : THIN;
    pen.lineWidth = thick;
    pen.strokeStyle = danced.length ? this.colours.fill(clip.name) : paint.faint;
    this.arc(pen, from, to, this.radius - thick / 2);
    pen.strokeStyle = this.colours.strong(clip.name);
    pen.lineWidth = 4;
    for (const index of danced) {
      const { from_s, to_s } = this.page.moves[index];
      this.arc(pen, this.graph.angle(clip.name, from_s), this.graph.angle(clip.name, to_s), this.radius - THICK + 2);
    }
  }

  /** Names of clips that are danced, beside the circle, where there is room for them: the longest danced first. */
  private drawNames(pen: Pen, halfWidth: number, halfHeight: number): void {
    const taken: [x: number, y: number][] = [];
    pen.textBaseline = "middle";
    const longest = this.graph.arcs.filter(({ danced }) => danced.length).sort((a, b) => b.danced.length - a.danced.length);
    for (const { clip, from, to } of longest) {
      const [x, y] = point((from + to) / 2, this.radius + 8);
      const left = x < 0;
      if (Math.abs(y) > halfHeight - NAMED / 2) continue;
      if (taken.some(([ox, oy]) => ox < 0 === left && Math.abs(oy - y) < NAMED)) continue;
      taken.push([x, y]);
      pen.textAlign = left ? "right" : "left";
      pen.fillStyle = this.colours.ink(clip.name);
      pen.fillText(shortened(pen, clip.name, halfWidth - Math.abs(x) - 4), x, y);
    }
  }

  private drawNow(pen: Pen, time: number): void {
    const { move, angle } = this.graph.here(time);
    const { clip, from_s, at_s } = this.page.moves[move];
    for (let back = RECENT; back >= 0; back--) {
      const index = move - 1 - back;
      if (index < 0) continue;
      const lit = back === 0 && time - at_s < LIT;
      pen.strokeStyle = back === 0 ? paint.accent : this.colours.strong(this.page.moves[index].clip);
      pen.globalAlpha = 1 - back / (RECENT + 1);
      pen.lineWidth = lit ? 4.5 : back === 0 ? 3 : 2.5;
      this.chord(pen, this.graph.path[index]);
    }
    pen.globalAlpha = 1;
    pen.setLineDash([3, 4]);
    pen.strokeStyle = paint.accent;
    pen.lineWidth = 1.5;
    const next = this.graph.path[move];
    if (next) this.chord(pen, next);
    pen.setLineDash([]);
    pen.lineWidth = THICK;
    pen.strokeStyle = this.colours.strong(clip);
    this.arc(pen, this.graph.angle(clip, from_s), angle, this.radius - THICK / 2);
    const [x, y] = point(angle, this.radius - THICK / 2);
    pen.fillStyle = paint.accent;
    pen.strokeStyle = paint.paper;
    pen.lineWidth = 2;
    pen.beginPath();
    pen.arc(x, y, 8, 0, 2 * Math.PI);
    pen.fill();
    pen.stroke();
  }

  private arc(pen: Pen, from: number, to: number, radius: number): void {
    pen.beginPath();
    pen.arc(0, 0, radius, from - Math.PI / 2, Math.max(to, from + 0.004) - Math.PI / 2);
    pen.stroke();
  }

  /** A line through the circle, bent towards its middle the more the farther apart its ends are. */
  private chord(pen: Pen, { from, to }: Chord): void {
    const inside = this.radius - THICK;
    const [ax, ay] = point(from, inside);
    const [bx, by] = point(to, inside);
    const apart = Math.abs(Math.sin((to - from) / 2));
    const [mx, my] = point(middle(from, to), inside * (1 - apart) * 0.75);
    pen.beginPath();
    pen.moveTo(ax, ay);
    pen.quadraticCurveTo(mx, my, bx, by);
    pen.stroke();
  }

  private under(x: number, y: number): Arc | undefined {
    const [dx, dy] = [x - this.strip.width / 2, y - this.strip.height / 2];
    if (Math.hypot(dx, dy) < this.radius - 2 * THICK) return undefined;
    return this.graph.at(Math.atan2(dx, -dy));
  }

  private say(x: number, y: number): string[] {
    const arc = this.under(x, y);
    if (!arc) return [];
    const { clip, danced } = arc;
    const times = danced.map((index) => `${this.page.moves[index].at_s.toFixed(1)} s`);
    const when = times.length > 4 ? [...times.slice(0, 4), "…"] : times;
    return [clip.name, `${clip.seconds.toFixed(1)} s long`, times.length ? `danced at ${when.join(", ")}` : "not danced"];
  }

  /** Goes to where a clip is danced next, or first. */
  private go(x: number, y: number): void {
    const danced = this.under(x, y)?.danced ?? [];
    const times = danced.map((index) => this.page.moves[index].at_s);
    const time = times.find((at) => at > this.now() + 0.01) ?? times[0];
    if (time !== undefined) this.seek(time);
  }
}

/** A place at an angle clockwise from the top. */
function point(angle: number, radius: number): [number, number] {
  return [radius * Math.sin(angle), -radius * Math.cos(angle)];
}

/** The angle half-way between two, on the shorter way. */
function middle(a: number, b: number): number {
  return Math.abs(b - a) <= Math.PI ? (a + b) / 2 : (a + b) / 2 + Math.PI;
}
