// Beats heard in the music, and those that are danced: foretold, then passed. The two differ where fast or slow music is
// danced at half or double its tempo, and in a break, when the dance goes on and nothing is heard.

import type { BeatSaid, Status } from "./contract";

const KEPT = 60; // [s]
const SAME = 0.3; // of a beat: nearer than that are two words for one beat
const SOON = 0.05; // [s] a beat foretold for so soon is not taken back
const STALE = 0.5; // [s] a beat that late lights nothing
const [SHORTEST, USUAL] = [0.2, 0.5]; // [s]
const STRIKES = 32;

export interface Beat {
  time: number;
  position: number; // in the bar, from 1
  confidence: number;
}

/** A beat that lit the ring, and the second of the music that was shown then. */
export interface Strike extends Beat {
  shown: number;
}

export class Beats {
  heard: Beat[] = [];
  danced: Beat[] = [];
  strikes: Strike[] = [];
  private period = USUAL; // [s] of what is danced

  clear(): void {
    [this.heard, this.danced, this.strikes] = [[], [], []];
  }

  get struck(): Strike | undefined {
    return this.strikes[this.strikes.length - 1];
  }

  /** Beats to come, as the session foretold them. */
  coming(now: number): Beat[] {
    return this.danced.filter(({ time }) => time > now);
  }

  /** Danced beats of which nothing was heard, or not yet. */
  unheard(): Beat[] {
    return this.danced.filter(({ time }) => !this.heard.some((other) => this.same(time, other.time)));
  }

  say({ time, position, confidence }: BeatSaid): void {
    const others = this.heard.filter((old) => Math.abs(old.time - time) > SHORTEST / 2 && old.time > time - KEPT);
    this.heard = [...others, { time, position, confidence }].sort((a, b) => a.time - b.time);
  }

  foretell(status: Status): void {
    const { next_beats: times, next_position: first, meter, confidence, tempo } = status;
    this.period = tempo > 0 ? Math.max(60 / tempo, SHORTEST) : USUAL;
    const position = (i: number): number => ((((Math.round(first) - 1 + i) % meter) + meter) % meter) + 1;
    const told = times.map((time, i) => ({ time, position: position(i), confidence }));
    const next = times[0] ?? Infinity;
    const over = this.danced.filter(
      ({ time }) => time > status.time - KEPT && time <= status.time + SOON && time < next && !this.same(time, next),
    );
    this.danced = [...over, ...told];
  }

  /** Strikes what has come due by `now`; called with every picture. */
  update(now: number): void {
    const last = this.struck;
    if (last && last.time > now + 1) this.strikes = []; // another session
    const due = (this.danced.length ? this.danced : this.heard)
      .filter(({ time }) => time <= now && time > now - STALE && (!last || time > last.time + SAME * this.period))
      .pop();
    if (due) this.strikes = [...this.strikes.slice(1 - STRIKES), { ...due, shown: now }];
  }

  private same(a: number, b: number): boolean {
    return Math.abs(a - b) < SAME * this.period;
  }
}
