// How far each joint is off at any time, and the colours that say so.

import * as THREE from "three";
import type { HeatData } from "./contract";
import { bytesOf } from "./data";

const UNKNOWN = 255;
const STEPS = 254;

export class Heat {
  readonly levels: Float32Array; // joints at the time last read, 0…1; -1 where unknown
  private readonly values: Uint8Array;
  private readonly colours: THREE.Color[];
  private readonly unknown: THREE.Color;

  constructor(
    private readonly data: HeatData,
    private readonly joints: number,
    private readonly fps: number,
  ) {
    this.values = bytesOf(data.base64);
    this.levels = new Float32Array(joints);
    this.colours = data.scale.map((colour) => new THREE.Color(colour));
    this.unknown = new THREE.Color(data.unknown);
    this.read(0);
  }

  /** Levels between the frames about a time; unknown where one of both is. */
  read(time: number): void {
    const last = this.values.length / this.joints - 1;
    const at = Math.min(Math.max(time * this.fps, 0), last);
    const frame = Math.min(Math.floor(at), Math.max(last - 1, 0));
    const t = at - frame;
    const [before, after] = [frame * this.joints, Math.min(frame + 1, last) * this.joints];
    for (let joint = 0; joint < this.joints; joint++) {
      const [a, b] = [this.values[before + joint], this.values[after + joint]];
      this.levels[joint] = a === UNKNOWN || b === UNKNOWN ? -1 : (a + t * (b - a)) / STEPS;
    }
  }

  /** The level between two joints; unknown where one of them is. */
  between(a: number, b: number, part: number): number {
    const [from, to] = [this.levels[a], this.levels[b]];
    if (from < 0 || to < 0) return -1;
    return from + Math.min(Math.max(part, 0), 1) * (to - from);
  }

  colour(level: number, into: THREE.Color): THREE.Color {
    if (level < 0) return into.copy(this.unknown);
    const at = Math.min(level, 1) * (this.colours.length - 1);
    const low = Math.min(Math.floor(at), this.colours.length - 2);
    return into.copy(this.colours[low]).lerp(this.colours[low + 1], at - low);
  }

  /** The scale in words and colours, into the page's legend. */
  legend(figure: HTMLElement, name: string, who: string): void {
    const [words, bar, marks] = Array.from(figure.children) as HTMLElement[];
    words.textContent = `cm from ${name || `the ${who}`} (grey)`;
    bar.style.background = `linear-gradient(90deg, ${this.data.scale.join(", ")})`;
    marks.replaceChildren(
      ...[0, 0.5, 1].map((part) => {
        const mark = document.createElement("span");
        mark.textContent = `${this.data.most * part}${part === 1 ? "+" : ""}`;
        return mark;
      }),
    );
    figure.hidden = false;
  }
}
