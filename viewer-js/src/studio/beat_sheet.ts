// Beats as somebody corrects them, with every step back and forth.

export interface Beat {
  time: number; // [s]
  down: boolean; // whether a bar begins here
}

const CLOSEST = 0.06; // [s] two beats are never closer
const SAME = 0.004; // [s]

export class BeatSheet {
  beats: readonly Beat[] = [];
  changed: () => void = () => undefined; // is called after every change
  private past: (readonly Beat[])[] = [];
  private future: (readonly Beat[])[] = [];

  constructor(readonly duration: number) {}

  /** What the server has: where that is what is here, all steps stay; other beats are a step more. */
  open(beats: readonly number[], downbeats: readonly number[]): void {
    const told = joined(beats, downbeats);
    if (alike(told, this.beats)) return;
    if (this.beats.length) this.past.push(this.beats);
    this.beats = told;
    this.future = [];
  }

  /** Other beats in place of these, which can be undone. */
  replace(beats: readonly number[], downbeats: readonly number[]): void {
    this.put(joined(beats, downbeats));
  }

  get times(): number[] {
    return this.beats.map(({ time }) => time);
  }

  get downbeats(): number[] {
    return this.beats.filter(({ down }) => down).map(({ time }) => time);
  }

  get canUndo(): boolean {
    return this.past.length > 0;
  }

  get canRedo(): boolean {
    return this.future.length > 0;
  }

  /** Beats in a bar, as most bars have them. */
  get meter(): number {
    const starts = this.beats.flatMap(({ down }, i) => (down ? [i] : []));
    const lengths = starts
      .slice(1)
      .map((start, i) => start - starts[i])
      .sort((a, b) => a - b);
    return lengths[lengths.length >> 1] ?? 4;
  }

  nearest(time: number): number {
    let best = -1;
    this.beats.forEach((beat, i) => {
      if (best < 0 || Math.abs(beat.time - time) < Math.abs(this.beats[best].time - time)) best = i;
    });
    return best;
  }

  /** Where a beat may be moved to: between its neighbours. */
  within(index: number, time: number): number {
    const low = index > 0 ? this.beats[index - 1].time + CLOSEST : 0;
    const high = index + 1 < this.beats.length ? this.beats[index + 1].time - CLOSEST : this.duration;
    return Math.min(Math.max(time, Math.min(low, high)), Math.max(low, high));
  }

  move(index: number, time: number): void {
    const to = this.within(index, time);
    if (Math.abs(to - this.beats[index].time) < 1e-4) return;
    this.put(this.beats.map((beat, i) => (i === index ? { ...beat, time: to } : beat)));
  }

  /** Adds a beat; the index of it, or of one that is there already. */
  add(time: number): number {
    const near = this.nearest(time);
    if (near >= 0 && Math.abs(this.beats[near].time - time) < CLOSEST) return near;
    const beats = [...this.beats, { time: Math.min(Math.max(time, 0), this.duration), down: false }];
    this.put(beats.sort((a, b) => a.time - b.time));
    return this.nearest(time);
  }

  remove(index: number): void {
    this.put(this.beats.filter((_, i) => i !== index));
  }

  toggleDown(index: number): void {
    this.put(this.beats.map((beat, i) => (i === index ? { ...beat, down: !beat.down } : beat)));
  }

  /** Bars of `meter` beats begin here, and go on so to both ends. */
  barsFrom(index: number, meter: number): void {
    this.put(this.beats.map((beat, i) => ({ ...beat, down: (i - index) % meter === 0 })));
  }

  /** Every second beat goes; those that begin bars stay where that is possible. */
  halve(): void {
    const first = this.beats.findIndex(({ down }) => down);
    const kept = this.beats.filter((_, i) => (i - Math.max(first, 0)) % 2 === 0);
    this.put(kept.some(({ down }) => down) ? kept : kept.map((beat, i) => ({ ...beat, down: i % 4 === 0 })));
  }

  /** A beat between every two. */
  double(): void {
    this.put(
      this.beats.flatMap((beat, i) => {
        const next = this.beats[i + 1];
        return next ? [beat, { time: (beat.time + next.time) / 2, down: false }] : [beat];
      }),
    );
  }

  undo(): void {
    const before = this.past.pop();
    if (!before) return;
    this.future.push(this.beats);
    this.beats = before;
    this.changed();
  }

  redo(): void {
    const after = this.future.pop();
    if (!after) return;
    this.past.push(this.beats);
    this.beats = after;
    this.changed();
  }

  /** Which beat is other than it was, or comes after one that is gone; undefined where more than one is. */
  changedFrom(before: readonly Beat[]): number | undefined {
    const { beats } = this;
    const [shorter, longer] = [Math.min(beats.length, before.length), Math.max(beats.length, before.length)];
    let same = 0;
    while (same < shorter && beats[same] === before[same]) same++;
    let after = 0;
    while (after < shorter - same && beats[beats.length - 1 - after] === before[before.length - 1 - after]) after++;
    return longer - same - after === 1 ? Math.min(same, beats.length - 1) : undefined;
  }

  private put(beats: readonly Beat[]): void {
    this.past.push(this.beats);
    this.future = [];
    this.beats = beats;
    this.changed();
  }
}

function joined(beats: readonly number[], downbeats: readonly number[]): Beat[] {
  return beats.map((time) => ({ time, down: downbeats.some((down) => Math.abs(down - time) < SAME) }));
}

function alike(one: readonly Beat[], other: readonly Beat[]): boolean {
  return one.length === other.length && one.every(({ time, down }, i) => down === other[i].down && Math.abs(time - other[i].time) < SAME);
}
