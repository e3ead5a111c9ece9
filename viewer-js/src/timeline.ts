// Two strips: lanes about now, which can be zoomed and scrolled, and below them the whole song. Both seek.

import type { ClipColours } from "./colours";
import type { PageData } from "./contract";
import { type Curve, readCurve } from "./data";
import * as lanes from "./lanes";
import type { Loop } from "./loop";
import { paint } from "./palette";
import { drag, Strip } from "./strip";
import { type Track, tracksOf, evened } from "./tracks";
import { View } from "./view";
import { Pinch, wheel } from "./wheel";
import * as words from "./words";

const [KEYPOSES, WHOLE_KEYPOSES] = [20, 14]; // [px] height of the keyposes' lanes above the two strips
const GAP = 3; // [px] between lanes
const GRIP = 7; // [px] within which an end of the loop is taken hold of

type Hold = "tape" | "loop" | "end";

/** A lane where it lies. */
interface Laid {
  track: Track;
  top: number;
  bottom: number;
}

export class Timeline {
  readonly view: View;
  readonly tracks: Track[];
  private readonly detail: Strip;
  private readonly overview: Strip;
  private readonly picture: Strip; // of the overview but for what moves
  private painted = ""; // how the picture was
  private named = ""; // where the lanes' names are
  private readonly wave: Curve;
  private readonly music: Curve;
  private readonly motion: Curve;
  private readonly energy?: lanes.EnergyCurves;

  constructor(
    detail: HTMLCanvasElement,
    overview: HTMLCanvasElement,
    private readonly names: HTMLElement, // beside the detail strip
    private readonly page: PageData,
    private readonly colours: ClipColours,
    private readonly seek: (time: number) => void,
    private readonly now: () => number,
    private readonly loop?: Loop,
    private readonly isPlaying: () => boolean = () => false,
  ) {
    [this.detail, this.overview] = [new Strip(detail), new Strip(overview)];
    this.picture = new Strip(document.createElement("canvas"));
    this.view = new View(page.duration);
    this.tracks = tracksOf(page, colours);
    this.wave = evened(readCurve(page.waveform));
    this.music = readCurve(page.music_intensity);
    this.motion = readCurve(page.motion_intensity);
    this.energy = page.energy ? lanes.readEnergy(page.energy) : undefined;
    this.listenOverview();
    this.listenDetail();
  }

  draw(now: number): void {
    this.drawDetail(now);
    this.drawOverview(now);
  }

  /** The height in pixels at which all lanes that are shown have theirs. */
  get tall(): number {
    return this.visible().reduce((sum, { tall }) => sum + tall + GAP, -GAP);
  }

  /** What lies under a place of the detail strip. */
  sayDetail(x: number, y: number): string[] {
    const span = this.around();
    const time = lanes.timeAt(span, x);
    if (time < 0 || time > this.page.duration) return [];
    const laid = this.layout().find(({ top, bottom }) => y >= top && y < bottom);
    const join = words.nearest(this.page.joins, time, this.seconds(4));
    const at = [words.seconds(time, 2), words.place(this.page, time)].filter(Boolean).join(" · ");
    const told = laid?.track.name === "clips" && join >= 0 ? this.sayJoin(join) : laid?.track.say(time, this.seconds(8));
    return [at, told ?? ""].filter(Boolean);
  }

  /** What lies under a place of the overview. */
  sayOverview(x: number): string[] {
    const time = lanes.timeAt(this.whole(), x);
    return [words.seconds(time, 1), words.move(this.page, time)].filter(Boolean);
  }

  private sayJoin(index: number): string {
    if (this.page.compared) return "where a segment begins";
    const [from, to] = [this.page.moves[index], this.page.moves[index + 1]];
    return from && to ? `join: from ${from.clip} at ${from.to_s.toFixed(1)} s to ${to.clip} at ${to.from_s.toFixed(1)} s` : "join";
  }

  private visible(): Track[] {
    return this.tracks.filter(({ there, shown }) => there && shown);
  }

  /** Where each lane lies: those shown share the height there is. */
  private layout(): Laid[] {
    const visible = this.visible();
    const room = this.detail.height - GAP * (visible.length - 1);
    const fixed = (track: Track): boolean => track.name === "keyposes" || track.name === "ruler";
    const [rigid, soft] = [true, false].map((is) => visible.filter((t) => fixed(t) === is).reduce((sum, t) => sum + t.tall, 0));
    const stretch = Math.max(room - rigid, 0) / Math.max(soft, 1);
    let top = 0;
    return visible.map((track) => {
      const bottom = top + track.tall * (fixed(track) ? 1 : stretch);
      const laid = { track, top, bottom };
      top = bottom + GAP;
      return laid;
    });
  }

  private whole(): lanes.Span {
    return { from: 0, to: this.page.duration, width: this.overview.width };
  }

  /** The stretch of time that the detail strip shows. */
  around(now = this.now()): lanes.Span {
    return this.view.span(now, this.detail.width, this.isPlaying());
  }

  /** So many pixels of the detail strip, in seconds. */
  private seconds(pixels: number): number {
    const span = this.around();
    return (pixels * (span.to - span.from)) / span.width;
  }

  private drawDetail(now: number): void {
    const strip = this.detail;
    strip.fit();
    const { pen, width, height } = strip;
    const laid = height ? this.layout() : [];
    this.nameLanes(laid);
    if (!height) return;
    const span = this.around(now);
    pen.fillStyle = paint.paper;
    pen.fillRect(0, 0, width, height);
    pen.font = lanes.FONT;
    this.drawGrounds(span, laid);
    for (const { track, top, bottom } of laid) track.draw(pen, span, top, bottom, now);
    this.drawThrough(span, laid, now);
    pen.fillStyle = paint.accent;
    pen.fillRect(lanes.xOf(span, now) - 1, 0, 2, height);
  }

  /** The lanes' own ground where there is dance, and the beats through them. */
  private drawGrounds(span: lanes.Span, laid: Laid[]): void {
    const { pen, width } = this.detail;
    const [left, right] = [Math.max(lanes.xOf(span, 0), 0), Math.min(lanes.xOf(span, this.page.duration), width)];
    for (const { track, top, bottom } of laid) {
      if (track.name === "clips" || track.name === "keyposes") continue;
      pen.fillStyle = paint.band;
      pen.fillRect(left, top, Math.max(right - left, 0), bottom - top);
    }
    const crowded = this.page.beats.length * 9 * (span.to - span.from) > this.page.duration * width;
    const beats = laid.find(({ track }) => track.name === "beats");
    const through = laid.filter(({ track }) => !["keyposes", "ruler", "beats", "clips"].includes(track.name));
    if (!crowded && beats) for (const { top, bottom } of through) lanes.drawBeats(pen, span, this.page, top, bottom);
  }

  /** What goes through several lanes: keyposes, joins, the loop. */
  private drawThrough(span: lanes.Span, laid: Laid[], now: number): void {
    const { pen, height } = this.detail;
    const [first, clips] = [laid[0], laid.find(({ track }) => track.name === "clips")];
    if (first?.track.name === "keyposes") {
      const bottom = clips ? clips.top - GAP : height;
      for (const { time, source } of this.page.keyposes) {
        if (time < span.from || time > span.to) continue;
        pen.fillStyle = lanes.keyposeColour(source);
        pen.globalAlpha = 0.28;
        pen.fillRect(lanes.xOf(span, time) - 0.5, first.bottom, 1, bottom - first.bottom);
      }
      pen.globalAlpha = 1;
      lanes.drawKeyposes(pen, span, this.page, KEYPOSES / 2, 8, 0, now);
    }
    if (clips || this.page.compared) lanes.drawJoins(pen, span, this.page, first?.bottom ?? 0, clips ? clips.top : height);
    this.drawLoop(pen, span, laid.find(({ track }) => track.name === "ruler"), height);
  }

  private drawLoop(pen: CanvasRenderingContext2D, span: lanes.Span, ruler: Laid | undefined, height: number): void {
    const loop = this.loop;
    if (!loop?.chosen) return;
    const [left, right] = [loop.from, loop.to].map((time) => lanes.xOf(span, time));
    pen.fillStyle = paint.accent;
    pen.globalAlpha = loop.on ? 0.13 : 0.05;
    pen.fillRect(left, 0, right - left, height);
    pen.globalAlpha = loop.on ? 1 : 0.45;
    if (ruler) pen.fillRect(left, ruler.top, right - left, 3);
    for (const x of [left, right]) pen.fillRect(x - 1, ruler?.top ?? 0, 2, height);
    pen.globalAlpha = 1;
  }

  /** The lanes' names beside them, where nothing is drawn over. */
  private nameLanes(laid: Laid[]): void {
    const like = laid.map(({ track, top, bottom }) => `${track.name} ${top} ${bottom}`).join();
    if (like === this.named) return;
    this.named = like;
    this.names.replaceChildren(
      ...laid.filter(({ track }) => track.name !== "ruler").map(({ track, top, bottom }) => {
        const name = document.createElement("span");
        name.textContent = track.title;
        name.style.top = `${(top + bottom) / 2}px`;
        return name;
      }),
    );
  }

  private drawOverview(now: number): void {
    const strip = this.overview;
    strip.fit();
    if (!strip.height) return;
    this.drawPicture(strip.width, strip.height);
    const { pen, width, height } = strip;
    const span = this.whole();
    pen.clearRect(0, 0, width, height);
    const x = lanes.xOf(span, now);
    const clips = this.clipsHeight();
    lanes.drawWaveform(pen, span, this.wave, this.waveMiddle(height), this.waveHalf(height), paint.wave, 3);
    lanes.drawWaveform(pen, span, this.wave, this.waveMiddle(height), this.waveHalf(height), paint.accent, 3, now);
    pen.drawImage(this.picture.canvas, 0, 0, width, height);
    if (!this.wave.values.length) {
      pen.fillStyle = paint.accent;
      pen.fillRect(0, height - clips - 3, x, 2);
    }
    this.drawLoop(pen, span, undefined, height);
    this.drawWindow(pen, span, height);
    pen.fillStyle = paint.ink;
    pen.fillRect(Math.min(Math.max(x - 1, 0), width - 2), 0, 2, height);
  }

  /** Which stretch the detail strip shows, where that is not the whole. */
  private drawWindow(pen: CanvasRenderingContext2D, span: lanes.Span, height: number): void {
    const shown = this.around();
    const left = Math.max(lanes.xOf(span, shown.from), 0.5);
    const right = Math.min(lanes.xOf(span, shown.to), span.width - 0.5);
    if (right - left > span.width - 4 || right <= left || !this.detail.height) return;
    pen.strokeStyle = paint.soft;
    pen.lineWidth = 1;
    pen.strokeRect(Math.round(left) + 0.5, 0.5, Math.round(right - left) - 1, height - 1);
  }

  private clipsHeight(): number {
    return this.page.moves.length ? 14 : 0;
  }

  private laneHeight(): number {
    return this.page.keyposes.length ? WHOLE_KEYPOSES : 0;
  }

  private waveMiddle(height: number): number {
    return this.laneHeight() + (height - this.laneHeight() - this.clipsHeight() - 4) * 0.36;
  }

  private waveHalf(height: number): number {
    return this.waveMiddle(height) - this.laneHeight() - 1;
  }

  /** What does not move is drawn once for each size and scheme. */
  private drawPicture(width: number, height: number): void {
    const strip = this.picture;
    const scale = Math.min(devicePixelRatio || 1, 3);
    const like = `${width} ${height} ${scale} ${paint.dark}`;
    if (like === this.painted) return;
    this.painted = like;
    strip.canvas.width = Math.round(width * scale);
    strip.canvas.height = Math.round(height * scale);
    const pen = strip.pen;
    pen.setTransform(scale, 0, 0, scale, 0, 0);
    pen.font = lanes.FONT;
    const span = this.whole();
    const clips = this.clipsHeight();
    const bottom = height - clips - 4;
    const compared = this.page.compared !== null;
    const top = this.page.compared?.heat ? 4 : this.waveMiddle(height) + this.waveHalf(height) + 3;
    if (compared) lanes.drawJoins(pen, span, this.page, 0, bottom);
    if (this.energy && !this.wave.values.length) {
      lanes.drawEnergy(pen, span, this.energy, this.laneHeight() + 3, top - 6, false);
    }
    lanes.drawCurve(pen, span, this.music, top, bottom, paint.music, true);
    lanes.drawCurve(pen, span, this.motion, top, bottom, paint.dance, false);
    lanes.drawClips(pen, span, this.page, this.colours, height - clips, clips);
    pen.font = "10px system-ui, sans-serif";
    lanes.drawKeyposes(pen, span, this.page, WHOLE_KEYPOSES / 2, 6, 0);
  }

  private listenOverview(): void {
    const canvas = this.overview.canvas;
    const to = (event: PointerEvent) => {
      const box = canvas.getBoundingClientRect();
      const [x, y] = [event.clientX - box.left, event.clientY - box.top];
      const keypose = y < this.laneHeight() ? lanes.keyposeAt(this.whole(), this.page, x, 8) : undefined;
      this.view.follow();
      this.seek(keypose ?? (x / box.width) * this.page.duration);
    };
    drag(canvas, to, to);
    const turned = {
      zoom: (by: number) => this.view.zoom(by, this.now()),
      scroll: (pixels: number) => this.view.scroll(pixels, this.now()),
    };
    wheel(canvas, turned);
  }

  /** The detail strip is dragged like a tape; a click brings the head to where it was. Along the ruler a loop is chosen. */
  private listenDetail(): void {
    const canvas = this.detail.canvas;
    const turned = {
      zoom: (by: number, x: number) => this.view.zoom(by, this.now(), this.isPlaying() && this.view.following ? undefined : x),
      scroll: (pixels: number) => this.view.scroll(pixels, this.now()),
    };
    const pinch = new Pinch(canvas, turned);
    wheel(canvas, turned);
    let [grip, last, moved, pinched] = [0, 0, false, false];
    let [hold, anchor, keypose]: [Hold, number, number | undefined] = ["tape", 0, undefined];
    drag(
      canvas,
      (event) => {
        const span = this.around();
        [grip, last, moved, pinched] = [lanes.timeAt(span, event.offsetX), event.offsetX, false, false];
        [hold, anchor] = this.held(span, event.offsetX, event.offsetY);
        keypose = event.offsetY < KEYPOSES ? lanes.keyposeAt(span, this.page, event.offsetX, 14) : undefined;
      },
      (event) => {
        pinched ||= pinch.busy;
        if (pinched) return;
        const start = lanes.xOf(this.around(), grip);
        moved ||= Math.abs(event.offsetX - (this.view.following && hold === "tape" ? last : start)) > 4;
        if (moved) this.dragTo(hold === "tape" ? undefined : anchor, grip, event.offsetX, last);
        if (moved || hold !== "tape") last = event.offsetX;
      },
      () => {
        if (!moved && !pinched) this.seek(keypose ?? grip);
      },
    );
    canvas.addEventListener("pointermove", ({ offsetX, offsetY }) => {
      canvas.dataset.hold = this.held(this.around(), offsetX, offsetY)[0];
    });
  }

  /** What a pointer would take hold of, and the other end of the stretch that it would choose. */
  private held(span: lanes.Span, x: number, y: number): [hold: Hold, anchor: number] {
    const loop = this.loop;
    const ruler = this.layout().find(({ track }) => track.name === "ruler");
    if (!loop || !ruler || y < ruler.top || y >= ruler.bottom) return ["tape", 0];
    if (loop.chosen && Math.abs(lanes.xOf(span, loop.to) - x) <= GRIP) return ["end", loop.from];
    if (loop.chosen && Math.abs(lanes.xOf(span, loop.from) - x) <= GRIP) return ["end", loop.to];
    return ["loop", lanes.timeAt(span, x)];
  }

  /** Drags the other end of a stretch from its anchor, or the tape. */
  private dragTo(anchor: number | undefined, grip: number, x: number, last: number): void {
    if (anchor !== undefined) this.loop?.choose(anchor, lanes.timeAt(this.around(), x));
    else if (this.view.following) this.seek(grip - lanes.timeAt(this.around(0), x));
    else this.view.scroll(last - x, this.now());
  }
}
