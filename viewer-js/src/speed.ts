// How fast the dance plays: a slider, a button that goes back to 1, and keys that step.

import type { Clock } from "./clock";

export const SPEEDS = [0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2];

export class Speed {
  constructor(
    private readonly clock: Clock,
    private readonly slider: HTMLInputElement,
    private readonly button: HTMLElement,
  ) {
    slider.addEventListener("input", () => this.set(Number(slider.value)));
    for (const near of ["pointerenter", "focus"]) slider.addEventListener(near, () => clock.prepare());
    button.addEventListener("click", () => this.set(1));
    this.tell();
  }

  /** The next faster or slower of the steps. */
  step(by: 1 | -1): void {
    const next = by > 0 ? SPEEDS.find((speed) => speed > this.clock.rate + 0.01) : [...SPEEDS].reverse().find((speed) => speed < this.clock.rate - 0.01);
    if (next !== undefined) this.set(next);
  }

  set(speed: number): void {
    const kept = Math.min(Math.max(speed, SPEEDS[0]), SPEEDS[SPEEDS.length - 1]);
    if (kept !== this.clock.rate) this.clock.setRate(kept);
    this.tell();
  }

  private tell(): void {
    const words = `${Number(this.clock.rate.toFixed(2))}×`;
    this.slider.value = String(this.clock.rate);
    this.slider.setAttribute("aria-valuetext", words);
    this.button.textContent = words;
    this.button.setAttribute("aria-label", `Speed ${words}: play at the song's own speed`);
  }
}
