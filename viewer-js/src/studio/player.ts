// The one clock of what plays. Where there is sound, the sound leads: it ticks coarsely, so that the time in between is
// followed by the screen's clock and gently pulled to it. A dance that was retimed plays its song faster at the same pitch.

const SNAP = 0.08; // [s] an error that is jumped, not pulled
const PULL = 4; // [1/s]
const AT_END = 0.02; // [s]
const STALLED = 250; // [ms] without the sound going on, after which the picture waits for it
const THERE = 0.001; // [s] of the sound that need no seeking

/** What plays: the sound at `url`, whose second `start + speed t` is heard at second t. */
export interface Playable {
  url: string | null;
  start: number;
  speed: number;
  duration: number;
}

const NOTHING: Playable = { url: null, start: 0, speed: 1, duration: 0 };

export class Player {
  playing = false;
  loop = false;
  rate = 1;
  turns = 0; // counts pauses, jumps, other speeds: what was to sound and will not
  readonly audio = new Audio();
  private what = NOTHING;
  private shown = 0;
  private shownAt = 0;
  private moved = false; // whether the sound has begun to go on
  private movedAt = 0; // [ms] when it was last seen to
  private last = 0; // [s] that was heard then

  constructor(
    private readonly changed: () => void,
    private readonly trouble: (words: string) => void,
  ) {
    this.audio.preload = "auto";
    this.audio.addEventListener("error", () => this.audio.hasAttribute("src") && this.fail());
  }

  get duration(): number {
    return this.what.duration;
  }

  load(what: Playable): void {
    this.pause();
    const other = what.url !== this.what.url || this.audio.error !== null;
    this.what = what;
    this.shown = 0;
    if (other && what.url) this.audio.src = what.url;
    if (!what.url) this.audio.removeAttribute("src");
    this.pace();
    this.place(0);
    this.changed();
  }

  toggle(): void {
    if (this.playing) this.pause();
    else this.play();
  }

  play(): void {
    if (this.playing || !this.duration) return;
    if (this.shown >= this.duration - AT_END) this.shown = 0;
    if (this.audio.error && this.what.url) this.audio.src = this.what.url; // the server may be back
    this.playing = true;
    this.begin(this.shown);
    this.changed();
  }

  pause(): void {
    if (!this.playing) return;
    this.shown = this.now(performance.now());
    this.playing = false;
    this.turns++;
    this.audio.pause();
    this.changed();
  }

  seek(time: number): void {
    const to = Math.min(Math.max(time, 0), this.duration);
    this.shown = to;
    if (this.playing) this.begin(to);
    else this.place(to);
  }

  setRate(rate: number): void {
    const at = this.now(performance.now());
    this.rate = rate;
    this.pace();
    if (this.playing) this.begin(at);
    this.changed();
  }

  /** Seconds of what plays, at the screen's time `now` in milliseconds. */
  now(now: number): number {
    if (!this.playing) return this.shown;
    const passed = Math.min(Math.max(now - this.shownAt, 0) / 1000, 1);
    this.shownAt = now;
    const guess = this.shown + passed * this.rate;
    this.shown = this.leads ? this.pulled(guess, passed) : guess;
    if (this.shown >= this.duration) this.end();
    return this.shown;
  }

  /** The second that is heard, or that of the screen's clock; what plays is compared with it. */
  get heard(): number {
    return this.leads ? (this.audio.currentTime - this.what.start) / this.what.speed : this.shown;
  }

  /** Whether there is sound now, that the picture has to follow. */
  get leads(): boolean {
    return this.what.url !== null && !this.audio.error && !this.audio.ended;
  }

  /** [1/s] seconds of the song in one of the listener. */
  get pitchless(): number {
    return this.rate * this.what.speed;
  }

  /** Pulled to the sound; before it begins, and where it waits for data, time stands still. */
  private pulled(guess: number, passed: number): number {
    const heard = this.heard;
    if (heard > this.last + 0.001) [this.moved, this.movedAt] = [true, this.shownAt];
    this.last = heard;
    if (!this.moved) return this.shown;
    const error = heard - guess;
    if (Math.abs(error) > SNAP) return heard;
    if (this.shownAt - this.movedAt > STALLED) return this.shown;
    return Math.max(guess + error * Math.min(1, passed * PULL), this.shown);
  }

  private begin(at: number): void {
    this.turns++;
    this.place(at);
    this.moved = false;
    this.last = this.heard;
    this.shownAt = performance.now();
    if (!this.what.url || this.audio.error) return;
    this.audio.play().catch((error: DOMException) => {
      if (error.name === "AbortError") return; // paused before it began
      this.pause();
      this.trouble(
        error.name === "NotAllowedError"
          ? "The browser wants a click before it lets sound begin: press play."
          : error.message,
      );
    });
  }

  private place(time: number): void {
    const to = this.what.start + time * this.what.speed;
    if (this.what.url && Math.abs(this.audio.currentTime - to) > THERE) this.audio.currentTime = to;
  }

  private pace(): void {
    this.audio.preservesPitch = true;
    this.audio.playbackRate = this.audio.defaultPlaybackRate = this.pitchless;
  }

  private end(): void {
    this.shown = this.duration;
    if (this.loop) return this.seek(0);
    this.playing = false;
    this.turns++;
    this.audio.pause();
    this.changed();
  }

  private fail(): void {
    this.trouble("The sound could not be played; the picture plays without it.");
    this.shownAt = performance.now();
  }
}
