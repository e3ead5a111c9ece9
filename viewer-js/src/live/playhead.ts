// Which second of the session is shown: a little behind the newest pose, as much as poses come irregularly.

const FIRST = 0.08; // [s] behind the quickest delivery, before it is known how regular they are
const [LEAST, MOST] = [0.04, 0.4]; // [s]
const BETWEEN = 0.025; // [s] to the next pose, and to the next picture
const [BUCKET, BUCKETS] = [0.5, 16]; // [s] and how many: deliveries of the last eight seconds count
const [LATER, SOONER] = [0.06, 0.008]; // [s/s] how fast the delay grows, and shrinks: sound keeps up with that
const SNAP = 0.25; // [s] an error that is jumped, not pulled
const PULL = 4; // [1/s]
const [AHEAD, LATE] = [3, 30]; // [s] poses farther off than that are astray …
const PATIENCE = 5; // … unless so many of them come in a row

interface Bucket {
  number: number;
  least: number; // [s] of a delivery's lag: the page's clock when it came less its own time
  most: number;
}

export class Playhead {
  delay = FIRST;
  private buckets: Bucket[] = [];
  private base = Infinity; // [s] lag of the quickest delivery
  private strays = 0;
  private shown?: number;
  private shownAt = 0;

  /** Whether anything has come yet. */
  get started(): boolean {
    return this.base < Infinity;
  }

  forget(): void {
    this.buckets = [];
    this.base = Infinity;
    this.strays = 0;
    this.shown = undefined;
  }

  /** Something of a time came at a second of the page's clock; false where that cannot be. */
  came(time: number, at: number): boolean {
    const lag = at - time;
    if (this.started && (lag < this.base - AHEAD || lag > this.base + LATE)) {
      if (++this.strays < PATIENCE) return false;
      this.forget();
    }
    this.strays = 0;
    const number = Math.floor(at / BUCKET);
    const bucket = this.buckets[this.buckets.length - 1];
    if (bucket?.number === number) {
      bucket.least = Math.min(bucket.least, lag);
      bucket.most = Math.max(bucket.most, lag);
    } else {
      this.buckets = [...this.buckets.filter((old) => old.number > number - BUCKETS), { number, least: lag, most: lag }];
    }
    this.base = Math.min(...this.buckets.map(({ least }) => least));
    return true;
  }

  /** Seconds of the session at a second of the page's clock; they never go back. */
  now(at: number): number {
    if (!this.started) return this.shown ?? 0;
    const passed = Math.max(at - this.shownAt, 0);
    this.shownAt = at;
    if (this.shown === undefined) return (this.shown = at - this.base - this.delay);
    const most = Math.min(passed, 0.1);
    this.delay += Math.min(Math.max(this.wanted() - this.delay, -SOONER * most), LATER * most);
    const error = at - this.base - this.delay - (this.shown + passed);
    if (Math.abs(error) > SNAP) return (this.shown = at - this.base - this.delay);
    return (this.shown = Math.max(this.shown + passed + error * Math.min(1, passed * PULL), this.shown));
  }

  /** As late as deliveries were; a single stall is bridged, not waited for ever after. */
  private wanted(): number {
    if (this.buckets.length < 4) return FIRST;
    const latest = this.buckets.map(({ most }) => most).sort((a, b) => b - a);
    return Math.min(Math.max(latest[1] - this.base + BETWEEN, LEAST), MOST);
  }
}
