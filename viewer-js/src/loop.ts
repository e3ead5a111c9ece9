// A stretch of the dance that is played over and over.

import { lastBefore } from "./data";

const SHORTEST = 0.3; // [s]

export class Loop {
  on = false;
  changed: () => void = () => {};
  from = 0; // [s]
  to = 0; // [s]; where it is not after `from` no stretch is chosen yet

  constructor(
    private readonly duration: number,
    private readonly moves: readonly number[], // [s] at which they begin
  ) {}

  get chosen(): boolean {
    return this.to > this.from;
  }

  /** Chooses the stretch between two times, in any order, and plays it over and over. */
  choose(one: number, other: number): void {
    const inside = (time: number): number => Math.min(Math.max(time, 0), this.duration);
    [this.from, this.to] = [inside(Math.min(one, other)), inside(Math.max(one, other))];
    if (this.to - this.from < SHORTEST) this.to = Math.min(this.from + SHORTEST, this.duration);
    this.from = Math.max(Math.min(this.from, this.to - SHORTEST), 0);
    this.on = true;
    this.changed();
  }

  begin(time: number): void {
    this.choose(time, this.chosen && this.to > time + SHORTEST ? this.to : this.duration);
  }

  end(time: number): void {
    this.choose(this.chosen && this.from < time - SHORTEST ? this.from : 0, time);
  }

  /** On or off; where nothing is chosen yet, the move that is danced at a time. */
  toggle(time: number): void {
    if (this.on) this.on = false;
    else if (this.chosen) this.on = true;
    else return this.chooseMove(time);
    this.changed();
  }

  /** Where to go on from a time that was played to: back to the beginning past the end; undefined to play on. */
  next(time: number): number | undefined {
    return this.on && this.chosen && time >= this.to ? this.from : undefined;
  }

  private chooseMove(time: number): void {
    const index = Math.max(lastBefore(this.moves, time), 0);
    this.choose(this.moves[index] ?? 0, this.moves[index + 1] ?? this.duration);
  }
}
