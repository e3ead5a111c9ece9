// Stretches of a dance that are to stay as they are when it is danced again.

export interface Stretch {
  from: number; // [s]
  to: number; // [s]
}

const SHORTEST = 0.3; // [s]

export class Locks {
  stretches: readonly Stretch[] = [];

  constructor(
    private readonly duration: number,
    private readonly changed: () => void,
  ) {}

  /** Adds a stretch; those that touch become one. */
  add(one: number, other: number): void {
    const [from, to] = [Math.max(Math.min(one, other), 0), Math.min(Math.max(one, other), this.duration)];
    if (to - from < SHORTEST) return;
    const apart = this.stretches.filter((old) => old.to < from || old.from > to);
    const met = this.stretches.filter((old) => old.to >= from && old.from <= to);
    const whole = {
      from: Math.min(from, ...met.map((old) => old.from)),
      to: Math.max(to, ...met.map((old) => old.to)),
    };
    this.put([...apart, whole]);
  }

  remove(index: number): void {
    this.put(this.stretches.filter((_, i) => i !== index));
  }

  clear(): void {
    this.put([]);
  }

  private put(stretches: readonly Stretch[]): void {
    this.stretches = [...stretches].sort((a, b) => a.from - b.from);
    this.changed();
  }
}
