// A click on every beat, to hear whether the beats are right: higher and louder where a bar begins. Clicks are handed to
// an audio context a little ahead, at the second at which the loudspeaker will be there in the song.

import { lastBefore } from "../data";
import type { Player } from "./player";

const AHEAD = 0.6; // [s] longer than a busy page lets its next picture wait
const LENGTH = 0.04; // [s]
const BEAT = { tone: 1000, level: 0.28 };
const DOWNBEAT = { tone: 1600, level: 0.44 };

export interface Struck {
  times: readonly number[];
  down: (index: number) => boolean;
}

export class Clicks {
  on = false;
  sounded = 0;
  private context?: AudioContext;
  private next = 0;
  private turn = -1;
  private pending: OscillatorNode[] = [];

  constructor(
    private readonly player: Player,
    private readonly beats: () => Struck,
  ) {}

  toggle(): void {
    this.on = !this.on;
    if (this.on) void (this.context ??= new AudioContext()).resume();
    this.anew();
  }

  /** Beats were changed: what is handed over no longer holds. */
  anew(): void {
    this.turn = -1;
    for (const click of this.pending) click.disconnect();
    this.pending = [];
  }

  /** Hands over the clicks of the next moments; called every frame with the time that is shown. */
  update(time: number): void {
    const { context, player } = this;
    if (!this.on || !context) return;
    const { times, down } = this.beats();
    if (this.turn !== player.turns) {
      this.anew();
      this.turn = player.turns;
      this.next = lastBefore(times, time) + 1;
    }
    if (!player.playing || (player.leads && player.audio.seeking)) return;
    for (; this.next < times.length; this.next++) {
      const wait = (times[this.next] - player.heard) / player.rate;
      if (wait > AHEAD) return;
      if (wait >= 0) this.click(context, this.loudspeaker(context) + wait, down(this.next));
    }
  }

  stop(): void {
    this.on = false;
    this.anew();
  }

  /** The context's second that leaves the loudspeaker now. */
  private loudspeaker(context: AudioContext): number {
    const stamp = context.getOutputTimestamp?.();
    const plain = context.currentTime - (context.outputLatency || 0);
    if (!stamp?.contextTime || !stamp.performanceTime) return plain;
    const output = stamp.contextTime + (performance.now() - stamp.performanceTime) / 1000;
    return Math.abs(output - plain) < 0.3 ? output : plain;
  }

  private click(context: AudioContext, at: number, first: boolean): void {
    if (at < context.currentTime) return;
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
