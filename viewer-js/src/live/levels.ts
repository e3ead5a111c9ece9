// How loud it was: the loudest sample of each hundredth of a second, for as long as the lane is.

const RATE = 100; // ticks a second
const SIZE = 4096;
const [QUIETEST, FORGET] = [0.08, 0.998]; // what fills the lane at least, and how the loudest fades, a tick

export class Levels {
  private readonly values = new Float32Array(SIZE);
  private readonly ticks = new Int32Array(SIZE).fill(-1);
  private loudest = QUIETEST;

  /** Levels of the ticks up to a time. */
  add(levels: readonly number[], until: number): void {
    const end = Math.round(until * RATE);
    levels.forEach((level, i) => {
      const tick = end - levels.length + i;
      if (tick < 0) return;
      this.values[tick % SIZE] = level;
      this.ticks[tick % SIZE] = tick;
      this.loudest = Math.max(this.loudest * FORGET, level, QUIETEST);
    });
  }

  clear(): void {
    this.ticks.fill(-1);
    this.loudest = QUIETEST;
  }

  /** The loudest between two times, 1 being the loudest of late; undefined where nothing was told. */
  between(from: number, to: number): number | undefined {
    let found: number | undefined;
    for (let tick = Math.max(Math.floor(from * RATE), 0); tick < to * RATE; tick++) {
      if (this.ticks[tick % SIZE] === tick) found = Math.max(found ?? 0, this.values[tick % SIZE]);
    }
    return found === undefined ? undefined : Math.min(found / this.loudest, 1);
  }
}
