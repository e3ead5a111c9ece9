// Two strips: the seconds around now, gliding under a fixed line, and the whole song. Both seek.

import type { ClipColours } from "./colours";
import type { PageData } from "./contract";
import { type Curve, readCurve } from "./data";
import * as lanes from "./lanes";
import { drag, Strip } from "./strip";

const SECONDS_PER_PIXEL = 1 / 95;
const [LANE, WHOLE_LANE] = [20, 14]; // [px] height of the keyposes' lanes above the two strips

/** The waveform bent so that quiet and loud songs alike show their notes: its median becomes 0.45. */
function evened(wave: Curve): Curve {
  const median = Float32Array.from(wave.values).sort()[wave.values.length >> 1];
  const bend = Math.min(Math.max(Math.log(0.45) / Math.log(median), 0.5), 2) || 1;
  return { values: wave.values.map((value) => value ** bend), rate: wave.rate };
}

export class Timeline {
  private readonly detail: Strip;
  private readonly overview: Strip;
  private readonly picture: Strip; // of the overview but for what moves
  private readonly wave: Curve;
  private readonly music: Curve;
  private readonly motion: Curve;
  private readonly energy?: lanes.EnergyCurves;

  constructor(
    detail: HTMLCanvasElement,
    overview: HTMLCanvasElement,
    private readonly page: PageData,
    private readonly colours: ClipColours,
    seek: (time: number) => void,
    private readonly now: () => number,
  ) {
    [this.detail, this.overview] = [new Strip(detail), new Strip(overview)];
    this.picture = new Strip(document.createElement("canvas"));
    this.wave = evened(readCurve(page.waveform));
    detail.hidden = !(page.beats.length || page.stops.length || page.moves.length || page.keyposes.length || this.wave.values.length);
    this.music = readCurve(page.music_intensity);
    this.motion = readCurve(page.motion_intensity);
    this.energy = page.energy ? lanes.readEnergy(page.energy) : undefined;
    this.listenOverview(seek);
    this.listenDetail(seek);
  }

  draw(now: number): void {
    this.drawDetail(now);
    this.drawOverview(now);
  }

  private whole(): lanes.Span {
    return { from: 0, to: this.page.duration, width: this.overview.width };
  }

  private around(now: number): lanes.Span {
    const half = (this.detail.width * SECONDS_PER_PIXEL) / 2;
    return { from: now - half, to: now + half, width: this.detail.width };
  }

  private drawDetail(now: number): void {
    const strip = this.detail;
    strip.fit();
    const { pen, width, height } = strip;
    if (!height) return;
    const span = this.around(now);
    const clips = this.page.moves.length ? 22 : 0;
    const lane = this.page.keyposes.length ? LANE : 0;
    const middle = (height - clips + lane) / 2 + 4;
    const tall = middle - lane - 16;
    pen.clearRect(0, 0, width, height);
    pen.fillStyle = "#fafafb";
    pen.fillRect(0, 0, width, height);
    pen.fillStyle = "#f1f3f6";
    const [left, right] = [Math.max(lanes.xOf(span, 0), 0), Math.min(lanes.xOf(span, this.page.duration), width)];
    pen.fillRect(left, lane, right - left, height - clips - 4 - lane);
    pen.font = lanes.FONT;
    lanes.drawBeats(pen, span, this.page, lane, height - clips - 4);
    lanes.drawWaveform(pen, span, this.wave, middle, tall, "#d3d8e2", 3);
    lanes.drawWaveform(pen, span, this.wave, middle, tall, "#f0b9ab", 3, now);
    if (this.energy) lanes.drawEnergy(pen, span, this.energy, lane + 6, height - clips - 6, true);
    lanes.drawClips(pen, span, this.page, this.colours, height - clips, clips);
    lanes.drawJoins(pen, span, this.page, lane, height - clips);
    lanes.drawStops(pen, span, this.page, lane + 9, 5, now);
    lanes.drawKeyposes(pen, span, this.page, LANE / 2, 8, height - clips - 4, now);
    pen.fillStyle = lanes.ACCENT;
    pen.fillRect(width / 2 - 1, 0, 2, height);
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
    lanes.drawWaveform(pen, span, this.wave, this.waveMiddle(height), this.waveHalf(height), "#c9cfdb", 3);
    lanes.drawWaveform(pen, span, this.wave, this.waveMiddle(height), this.waveHalf(height), lanes.ACCENT, 3, now);
    pen.drawImage(this.picture.canvas, 0, 0, width, height);
    if (!this.wave.values.length) {
      pen.fillStyle = lanes.ACCENT;
      pen.fillRect(0, height - clips - 3, x, 2);
    }
    pen.fillStyle = lanes.INK;
    pen.fillRect(Math.min(Math.max(x - 1, 0), width - 2), 0, 2, height);
  }

  private clipsHeight(): number {
    return this.page.moves.length ? 16 : 0;
  }

  private laneHeight(): number {
    return this.page.keyposes.length ? WHOLE_LANE : 0;
  }

  private waveMiddle(height: number): number {
    return this.laneHeight() + (height - this.laneHeight() - this.clipsHeight() - 4) * 0.36;
  }

  private waveHalf(height: number): number {
    return this.waveMiddle(height) - this.laneHeight() - 1;
  }

  /** What does not move is drawn once for each size. */
  private drawPicture(width: number, height: number): void {
    const strip = this.picture;
    const scale = Math.min(devicePixelRatio || 1, 3);
    if (strip.canvas.width === Math.round(width * scale) && strip.canvas.height === Math.round(height * scale)) return;
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
    lanes.drawCurve(pen, span, this.music, top, bottom, "#d9dee7", true);
    lanes.drawCurve(pen, span, this.motion, top, bottom, "#2f9c95", false);
    lanes.drawClips(pen, span, this.page, this.colours, height - clips, clips);
    pen.font = "10px system-ui, sans-serif";
    lanes.drawKeyposes(pen, span, this.page, WHOLE_LANE / 2, 6, 0);
  }

  private listenOverview(seek: (time: number) => void): void {
    const canvas = this.overview.canvas;
    const to = (event: PointerEvent) => {
      const box = canvas.getBoundingClientRect();
      const [x, y] = [event.clientX - box.left, event.clientY - box.top];
      const keypose = y < this.laneHeight() ? lanes.keyposeAt(this.whole(), this.page, x, 8) : undefined;
      seek(keypose ?? (x / box.width) * this.page.duration);
    };
    drag(canvas, to, to);
  }

  /** The detail strip is dragged like a tape; a click brings the place clicked under the line. */
  private listenDetail(seek: (time: number) => void): void {
    const canvas = this.detail.canvas;
    let [grip, moved] = [0, false];
    let keypose: number | undefined;
    drag(
      canvas,
      (event) => {
        const span = this.around(this.now());
        [grip, moved] = [lanes.timeAt(span, event.offsetX), false];
        keypose = event.offsetY < LANE ? lanes.keyposeAt(span, this.page, event.offsetX, 14) : undefined;
      },
      (event) => {
        const time = grip - lanes.timeAt(this.around(0), event.offsetX);
        if (Math.abs(time - this.now()) > 4 * SECONDS_PER_PIXEL) moved = true;
        if (moved) seek(time);
      },
      () => {
        if (!moved) seek(keypose ?? grip);
      },
    );
  }
}
