// The session's sound file, kept in step with what is shown. It needs a click: browsers sound for nobody who did not ask.

import type { HelloData } from "./contract";

const JUMP = 0.08; // [s] an error that is jumped over; smaller ones are caught up with by playing faster or slower
const [SLIGHT, MOST] = [0.008, 0.01]; // [s] an error that is none, and how much faster or slower
const CATCH = 0.25; // [1/s]
const SETTLE = 1.5; // [s] after a jump, before the next
const LONGEST_LEAD = 0.3; // [s] that a jump is aimed ahead, for the time that it takes
const ATTEMPTS = 8;

export class Sound {
  on = false;
  problem = "";
  error = 0; // [s] by which it is late
  jumps = 0;
  private audio?: HTMLAudioElement;
  private hello?: HelloData;
  private jumpedAt = -Infinity; // [s] of the page's clock
  private measured = true; // whether it is known where the last jump led
  private lead = 0; // [s]
  private inVain = 0; // jumps in a row that did not bring it into step

  constructor(private readonly changed: () => void) {}

  get possible(): boolean {
    return this.hello?.sound ?? false;
  }

  /** Whether it sounds now. */
  get sounding(): boolean {
    return this.audio !== undefined && !this.audio.paused && this.audio.currentTime > 0;
  }

  offer(hello: HelloData): void {
    if (this.hello && (!hello.sound || hello.started !== this.hello.started)) this.drop();
    this.hello = hello;
    if (!hello.sound) this.on = false;
    this.changed();
  }

  toggle(): void {
    this.on = this.possible && !this.on;
    this.problem = "";
    this.inVain = 0;
    if (this.on) this.play();
    else this.audio?.pause();
    this.changed();
  }

  /** Keeps in step with the second that is shown; silent while nothing comes. */
  update(time: number, alive: boolean): void {
    if (!this.on || !this.hello) return;
    const audio = (this.audio ??= this.load());
    const wanted = this.placeAt(time);
    if (wanted === undefined || !alive) return audio.pause();
    if (audio.paused) return this.play();
    if (audio.seeking || audio.readyState < HTMLMediaElement.HAVE_CURRENT_DATA) return;
    this.error = this.wrapped(wanted - audio.currentTime);
    if (Math.abs(this.error) > JUMP) return this.jump(audio, wanted);
    this.inVain = 0;
    const faster = Math.abs(this.error) < SLIGHT ? 0 : Math.min(Math.max(CATCH * this.error, -MOST), MOST);
    audio.playbackRate = 1 + Math.round(faster * 1000) / 1000;
  }

  private load(): HTMLAudioElement {
    const audio = new Audio("sound");
    audio.preload = "auto";
    audio.loop = this.hello?.loops ?? false;
    audio.preservesPitch = false; // a hundredth is not heard as pitch, but stretching is heard
    audio.addEventListener("error", () => this.fail("The sound cannot be played here."));
    return audio;
  }

  /** Jumps to where it should be, and learns from where it was a moment later how far ahead to aim. */
  private jump(audio: HTMLAudioElement, wanted: number): void {
    const now = performance.now() / 1000;
    if (!this.measured && now - this.jumpedAt > 0.3) {
      this.lead = Math.min(Math.max(this.lead + 0.6 * this.error, 0), LONGEST_LEAD);
      this.measured = true;
    }
    if (now - this.jumpedAt < SETTLE) return;
    if (++this.inVain > ATTEMPTS) return this.fail("The sound cannot be kept in step here.");
    audio.playbackRate = 1;
    audio.currentTime = this.round(wanted + this.lead);
    [this.jumpedAt, this.measured] = [now, false];
    this.jumps++;
  }

  private play(): void {
    const audio = (this.audio ??= this.load());
    audio.play().catch((error: unknown) => {
      if (!(error instanceof DOMException && error.name === "AbortError")) this.fail("The browser does not let the sound begin.");
    });
  }

  private fail(problem: string): void {
    this.drop();
    this.on = false;
    this.problem = problem;
    this.changed();
  }

  private drop(): void {
    const audio = this.audio;
    this.audio = undefined;
    audio?.pause();
  }

  /** Second of the file that belongs to a second of the session; undefined where it does not sound. */
  private placeAt(time: number): number | undefined {
    const hello = this.hello as HelloData;
    const at = time - hello.sound_at;
    const seconds = this.seconds();
    if (at < 0 || (!hello.loops && at >= seconds)) return undefined;
    return this.round(at);
  }

  private seconds(): number {
    const told = this.hello?.sound_seconds ?? 0;
    return told > 0 ? told : this.audio?.duration || Infinity;
  }

  private round(at: number): number {
    const seconds = this.seconds();
    return this.hello?.loops && Number.isFinite(seconds) ? at % seconds : at;
  }

  private wrapped(error: number): number {
    const seconds = this.seconds();
    return this.hello?.loops && Number.isFinite(seconds) ? error - seconds * Math.round(error / seconds) : error;
  }
}
