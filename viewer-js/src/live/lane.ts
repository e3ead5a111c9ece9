// The lane that scrolls by: what was heard left of now, the beats foretold right of it.

import { FONT, type Span, xOf } from "../lanes";
import { Strip } from "../strip";
import type { Beat, Beats } from "./beats";
import type { Levels } from "./levels";

const SECONDS_PER_PIXEL = 1 / 95;
const NOW = 0.6; // of the width
const MARKS = 30; // [px] height of the beats' row
const SIZE = 9; // [px] of a mark
const STEP = 3; // [px] a bar of the waveform
const FLASH = 0.35; // [s]

const LIGHT = {
  ground: "#f1f3f6", ahead: "#fafafb", wave: "#f0b9ab", beat: "#5b6472", line: "#b9bfcc", first: "#e2583e", now: "#e2583e",
  paper: "#ffffff", words: "#6b7183",
};
const DARK = {
  ground: "#1d212d", ahead: "#171a24", wave: "#8d4537", beat: "#a9b1c4", line: "#4a5165", first: "#ff7a5c", now: "#ff7a5c",
  paper: "#14161f", words: "#9aa2b6",
};

type Colours = typeof LIGHT;

export class Lane {
  dark = false;
  marks = 0; // drawn with the last picture
  private readonly strip: Strip;

  constructor(
    canvas: HTMLCanvasElement,
    private readonly beats: Beats,
    private readonly levels: Levels,
  ) {
    this.strip = new Strip(canvas);
  }

  draw(now: number): void {
    this.strip.fit();
    const { pen, width, height } = this.strip;
    if (!height) return;
    const colours = this.dark ? DARK : LIGHT;
    const from = now - NOW * width * SECONDS_PER_PIXEL;
    const span = { from, to: from + width * SECONDS_PER_PIXEL, width };
    const x = xOf(span, now);
    pen.clearRect(0, 0, width, height);
    pen.fillStyle = colours.ahead;
    pen.fillRect(0, 0, width, height);
    pen.fillStyle = colours.ground;
    const began = Math.max(xOf(span, 0), 0);
    pen.fillRect(began, MARKS, Math.max(x - began, 0), height - MARKS);
    this.drawWave(span, now, (MARKS + height) / 2, (height - MARKS) / 2 - 3, colours);
    this.drawBeats(span, now, height, colours);
    pen.fillStyle = colours.now;
    pen.fillRect(x - 1, 0, 2, height);
    this.drawWords(now, x, width, height, colours);
  }

  private drawWave(span: Span, now: number, middle: number, half: number, colours: Colours): void {
    const { pen } = this.strip;
    pen.fillStyle = colours.wave;
    // Bars stand at fixed times, so that they do not shimmer while the lane glides.
    const seconds = STEP * SECONDS_PER_PIXEL;
    for (let bar = Math.max(Math.floor(span.from / seconds), 0); (bar + 1) * seconds <= now; bar++) {
      const level = this.levels.between(bar * seconds, (bar + 1) * seconds);
      if (level === undefined) continue;
      const tall = Math.max(level ** 0.7 * half, 0.75);
      pen.fillRect(xOf(span, bar * seconds), middle - tall, STEP - 1, 2 * tall);
    }
  }

  private drawBeats(span: Span, now: number, height: number, colours: Colours): void {
    const { pen } = this.strip;
    this.marks = 0;
    pen.font = `600 ${FONT}`;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    const margin = SIZE * 2 * SECONDS_PER_PIXEL;
    const inside = ({ time }: Beat): boolean => time > span.from - margin && time < span.to + margin;
    for (const beat of this.beats.unheard().filter(inside)) this.drawForetold(beat, span, now, height, colours);
    for (const beat of this.beats.heard.filter(inside)) this.drawHeard(beat, span, now, height, colours);
    pen.textAlign = "start";
  }

  private drawHeard(beat: Beat, span: Span, now: number, height: number, colours: Colours): void {
    // One that is known but not due yet looks like one foretold.
    if (beat.time > now) return this.drawForetold(beat, span, now, height, colours);
    const { pen } = this.strip;
    const first = beat.position === 1;
    const x = xOf(span, beat.time);
    const flash = Math.max(0, 1 - (now - beat.time) / FLASH);
    pen.fillStyle = first ? colours.first : colours.line;
    pen.fillRect(x - (first ? 1 : 0.5), MARKS, first ? 2 : 1, height - MARKS);
    pen.fillStyle = first || flash > 0 ? colours.first : colours.beat;
    this.circle(x, SIZE + 2.5 * flash);
    pen.fill();
    this.number(beat, x, colours.paper);
  }

  /** Hollow, and the fainter the less sure; it stays so where nothing was heard of it. */
  private drawForetold(beat: Beat, span: Span, now: number, height: number, colours: Colours): void {
    const { pen } = this.strip;
    const first = beat.position === 1;
    const x = xOf(span, beat.time);
    pen.globalAlpha = (0.3 + 0.7 * beat.confidence) * (beat.time > now ? 1 : 0.6);
    pen.strokeStyle = first ? colours.first : colours.beat;
    pen.lineWidth = first ? 2 : 1.5;
    this.circle(x, SIZE - 1);
    pen.stroke();
    pen.lineWidth = 1;
    pen.setLineDash([3, 4]);
    pen.beginPath();
    pen.moveTo(x, MARKS);
    pen.lineTo(x, height);
    pen.stroke();
    pen.setLineDash([]);
    this.number(beat, x, first ? colours.first : colours.beat);
    pen.globalAlpha = 1;
  }

  private circle(x: number, size: number): void {
    this.strip.pen.beginPath();
    this.strip.pen.arc(x, MARKS / 2, size, 0, 2 * Math.PI);
    this.marks++;
  }

  private number(beat: Beat, x: number, colour: string): void {
    this.strip.pen.fillStyle = colour;
    this.strip.pen.fillText(String(beat.position), x, MARKS / 2 + 0.5);
  }

  private drawWords(now: number, x: number, width: number, height: number, colours: Colours): void {
    const { pen } = this.strip;
    pen.font = FONT;
    pen.textBaseline = "alphabetic";
    this.word("heard", x - 8 - pen.measureText("heard").width, height, colours);
    this.word("foretold", x + 8, height, colours);
    pen.fillStyle = colours.words;
    if (!this.beats.coming(now).length && width - x > 140) pen.fillText("no beat", x + 10, MARKS / 2 + 4);
  }

  /** A word at the bottom, readable over whatever is drawn there. */
  private word(word: string, x: number, height: number, colours: Colours): void {
    const { pen } = this.strip;
    pen.globalAlpha = 0.85;
    pen.fillStyle = colours.paper;
    pen.fillRect(x - 3, height - 17, pen.measureText(word).width + 6, 15);
    pen.globalAlpha = 1;
    pen.fillStyle = colours.words;
    pen.fillText(word, x, height - 6);
  }
}
