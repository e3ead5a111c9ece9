// The time of the dance. Where there is sound, the audio context's clock leads, as it is heard at the loudspeaker; at
// other speeds than 1 that of a media element, which keeps the pitch. Both tick coarsely, so that the time in between is
// followed by the screen's clock and gently pulled to them.

import type { AudioData } from "./contract";
import { bytesOf } from "./data";
import { Stretched } from "./stretched";

const SNAP = 0.08; // [s] an error that is jumped, not pulled
const PULL = 3; // [1/s]
const LEAD = 0.04; // [s] from asking for sound to its first sample
const CODEC_DELAY = 1105; // [samples] that an MP3 begins with; most browsers cut them off, some do not

export class Clock {
  playing = false;
  rate = 1;
  turns = 0; // counts what was to sound and will not: pauses, jumps, other speeds
  private context?: AudioContext;
  private buffer?: AudioBuffer;
  private source?: AudioBufferSourceNode;
  private stretched?: Stretched; // made when another speed is first asked for
  private keepsPitch = true;
  private silent = 0; // [s] before the song in the sound
  private origin = 0; // time of the dance at `mark`
  private mark = 0; // [s] of the leading clock
  private shown = 0;
  private shownAt = 0;

  constructor(
    readonly duration: number,
    private readonly withSound: boolean,
  ) {}

  private get isStretched(): boolean {
    return this.rate !== 1 && this.keepsPitch;
  }

  get hasSound(): boolean {
    return this.buffer !== undefined;
  }

  /** Unpack the sound; before that, and if it fails, the dance plays without. */
  async load(audio: AudioData): Promise<void> {
    const bytes = bytesOf(audio.uri.slice(audio.uri.indexOf(",") + 1));
    const buffer = await new OfflineAudioContext(2, 1, audio.rate).decodeAudioData(bytes.buffer);
    const at = this.now(performance.now());
    this.silent = buffer.duration - audio.seconds > CODEC_DELAY / audio.rate / 2 ? CODEC_DELAY / audio.rate : 0;
    this.buffer = buffer;
    if (this.playing) this.restart(at);
  }

  play(): void {
    if (this.playing) return;
    if (this.shown >= this.duration - 0.02) this.shown = 0;
    if (this.withSound) this.wake();
    this.playing = true;
    this.restart(this.shown);
  }

  pause(): void {
    if (!this.playing) return;
    this.shown = this.now(performance.now());
    this.playing = false;
    this.silence();
    void this.context?.suspend();
  }

  seek(time: number): void {
    const at = Math.min(Math.max(time, 0), this.duration);
    if (this.playing) this.restart(at);
    else this.shown = at;
  }

  setRate(rate: number): void {
    const at = this.now(performance.now());
    this.rate = rate;
    if (rate !== 1) this.prepare();
    if (this.playing) this.restart(at);
  }

  /** Makes ready for other speeds than 1, which may take a moment. */
  prepare(): void {
    if (this.buffer && this.keepsPitch) this.stretched ??= new Stretched(this.buffer, this.silent, () => this.forgoPitch());
  }

  /** Second of the song that is heard now, as its sound says by itself; undefined where nothing sounds. */
  heard(): number | undefined {
    if (!this.playing || !this.buffer) return undefined;
    if (this.isStretched) return this.stretched?.heard;
    return this.source && this.context?.state === "running" ? this.led(performance.now()) : undefined;
  }

  /** Seconds of the dance at the screen's time `now` in milliseconds. */
  now(now: number): number {
    if (!this.playing) return this.shown;
    const heard = this.led(now);
    if (heard <= this.origin) {
      this.shownAt = now; // the first sound is still on its way
      return this.shown;
    }
    const passed = Math.max(now - this.shownAt, 0) / 1000;
    const stopped = this.buffer !== undefined && !this.isStretched && this.context?.state !== "running";
    const guess = this.shown + (stopped ? 0 : passed * this.rate);
    const error = heard - guess;
    const pulled = guess + error * Math.min(1, passed * PULL);
    this.shown = Math.abs(error) > SNAP ? heard : Math.max(pulled, this.shown);
    this.shownAt = now;
    return (this.shown = Math.min(this.shown, this.duration));
  }

  /** The audio context, and its time at which a second of the dance sounds; undefined while nothing sounds. */
  sounding(time: number): { context: AudioContext; at: number } | undefined {
    if (!this.playing || !this.context) return undefined;
    const heard = this.isStretched ? this.stretched?.heard : undefined;
    if (heard !== undefined) return { context: this.context, at: this.context.currentTime - latency(this.context) + (time - heard) / this.rate };
    if (!this.source) return undefined;
    return { context: this.context, at: this.mark + (time - this.origin) / this.rate };
  }

  private restart(at: number): void {
    this.silence();
    this.origin = this.shown = at;
    this.shownAt = performance.now();
    if (this.buffer && this.isStretched) this.startStretched(this.buffer, at);
    else if (this.buffer) this.startSound(this.buffer, at);
    else this.mark = performance.now() / 1000;
  }

  /** Browsers let sound begin only while a key or finger is down, so that this cannot wait for the sound's decoding. */
  private wake(): void {
    const session = (navigator as { audioSession?: { type: string } }).audioSession;
    if (session) session.type = "playback"; // a phone's mute switch is for ringing
    this.context ??= new AudioContext({ latencyHint: "playback" });
    void this.context.resume();
  }

  private startSound(buffer: AudioBuffer, at: number): void {
    this.context ??= new AudioContext({ latencyHint: "playback" });
    this.mark = this.context.currentTime + LEAD;
    if (at + this.silent >= buffer.duration) return;
    this.source = this.context.createBufferSource();
    this.source.buffer = buffer;
    this.source.playbackRate.value = this.rate;
    this.source.connect(this.context.destination);
    this.source.start(this.mark, at + this.silent);
  }

  /** The screen's clock leads past the sound's end, and until the sound begins nothing moves. */
  private startStretched(buffer: AudioBuffer, at: number): void {
    this.prepare();
    this.mark = performance.now() / 1000;
    if (at + this.silent < buffer.duration) this.stretched?.start(at, this.rate);
  }

  /** Where no media element plays, other speeds have another pitch. */
  private forgoPitch(): void {
    const at = this.shown;
    this.keepsPitch = false;
    if (this.playing) this.restart(at);
  }

  private silence(): void {
    this.turns++;
    this.stretched?.stop();
    this.source?.stop();
    this.source?.disconnect();
    this.source = undefined;
  }

  /** Second of the dance as the clock that leads has it. */
  private led(now: number): number {
    const timed = this.origin + (this.leading(now) - this.mark) * this.rate;
    if (!this.buffer || !this.isStretched) return timed;
    if (this.stretched?.over || this.origin + this.silent >= this.buffer.duration) return Math.max(timed, this.shown);
    return this.stretched?.heard ?? this.origin;
  }

  /** Seconds of the clock that leads: what leaves the loudspeaker now, or the screen's time. */
  private leading(now: number): number {
    const context = this.context;
    if (!context || !this.buffer || this.isStretched) return now / 1000;
    const delayed = context.currentTime - latency(context);
    const stamp = context.getOutputTimestamp?.();
    if (context.state !== "running" || !stamp?.contextTime || !stamp.performanceTime) return delayed;
    // Just after a pause the stamp may be from before it.
    const output = stamp.contextTime + (now - stamp.performanceTime) / 1000;
    const behind = context.currentTime - output;
    return behind > -0.03 && behind < 0.5 ? output : delayed;
  }
}

function latency(context: AudioContext): number {
  return context.outputLatency || 0;
}
