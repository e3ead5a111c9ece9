// A click on every beat, to hear whether the beats are right: as in `onbeat listen --click`, higher and louder where a
// bar begins. Clicks are handed to the audio context a little ahead, so that they sound to the sample.

import type { Clock } from "./clock";
import type { PageData } from "./contract";
import { lastBefore } from "./data";

const AHEAD = 1.0; // [s] longer than a busy page lets its next picture wait
const LENGTH = 0.04; // [s]
const BEAT = { tone: 1000, level: 0.28 };
const DOWNBEAT = { tone: 1600, level: 0.44 };

export class Clicks {
  on = false;
  sounded = 0;
  private next = 0; // the first beat that is not handed over yet
  private turn = -1;
  private pending: OscillatorNode[] = [];
  private readonly downbeats: Set<number>;

  constructor(
    private readonly clock: Clock,
    private readonly page: PageData,
  ) {
    this.downbeats = new Set(page.downbeats);
  }

  /** Whether there is anything to click to: beats, and sound to hear them against. */
  get possible(): boolean {
    return this.page.audio !== null && this.page.beats.length > 0;
  }

  toggle(): void {
    this.on = !this.on;
    this.turn = -1;
  }

  /** Hands over the clicks of the next moments; called every frame with the time that is shown. */
  update(time: number): void {
    if (this.turn !== this.clock.turns) this.startAnew(time);
    if (!this.on) return;
    for (; this.next < this.page.beats.length; this.next++) {
      const beat = this.page.beats[this.next];
      const sound = this.clock.sounding(beat);
      if (!sound || sound.at > sound.context.currentTime + AHEAD) return;
      if (sound.at >= sound.context.currentTime) this.click(sound.context, sound.at, this.downbeats.has(beat));
    }
  }

  private startAnew(time: number): void {
    for (const click of this.pending) click.disconnect();
    this.pending = [];
    this.next = lastBefore(this.page.beats, time) + 1;
    this.turn = this.clock.turns;
  }

  private click(context: AudioContext, at: number, first: boolean): void {
    const { tone, level } = first ? DOWNBEAT : BEAT;
    const [sound, gain] = [context.createOscillator(), context.createGain()];
    sound.frequency.value = tone;
    gain.gain.setValueAtTime(level, at);
    gain.gain.exponentialRampToValueAtTime(0.001 * level, at + LENGTH);
    sound.connect(gain).connect(context.destination);
    sound.start(at);
    sound.stop(at + LENGTH);
    this.pending = [...this.pending.slice(-8), sound];
    this.sounded++;
  }
}
