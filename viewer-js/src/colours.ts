// Clip colours: one hue a clip, far from those before it.

import { paint } from "./palette";

const TURN = 137.508; // [degrees], the golden angle
const FIRST = 205;

export class ClipColours {
  private readonly hues = new Map<string, number>();

  constructor(clips: readonly string[]) {
    for (const clip of clips) {
      if (!this.hues.has(clip)) this.hues.set(clip, (FIRST + TURN * this.hues.size) % 360);
    }
  }

  fill(clip: string): string {
    return this.hsl(clip, paint.dark ? "34% 27%" : "52% 82%");
  }

  ink(clip: string): string {
    return this.hsl(clip, paint.dark ? "70% 86%" : "52% 24%");
  }

  strong(clip: string): string {
    return this.hsl(clip, paint.dark ? "62% 62%" : "55% 48%");
  }

  private hsl(clip: string, rest: string): string {
    return `hsl(${this.hues.get(clip) ?? FIRST} ${rest})`;
  }
}
