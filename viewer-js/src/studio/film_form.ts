// How a video is to be: its size, how many pictures a second, and whether the floor flashes on the beats.

import type { FilmOrder } from "./contract";
import { choice, field, h } from "./elements";

const SIZES = [
  ["1280x720", "1280 × 720"],
  ["1920x1080", "1920 × 1080"],
  ["3840x2160", "3840 × 2160, slow to write"],
  ["1080x1920", "1080 × 1920, upright"],
  ["1080x1080", "1080 × 1080, square"],
] as const;
const RATES = ["24", "25", "30", "50", "60"].map((rate) => [rate, rate] as const);

export class FilmForm {
  readonly root: HTMLElement;
  private readonly size = choice(SIZES, "1280x720");
  private readonly rate = choice(RATES, "30");
  private readonly flash = h("input", { type: "checkbox" });

  constructor() {
    const tick = h("label", { class: "tick" }, this.flash, h("span", {}, "Flashes on the beats"));
    this.root = h(
      "div",
      { class: "film", role: "group", "aria-label": "The video" },
      field("Size", this.size),
      field("Pictures / s", this.rate),
      tick,
    );
  }

  get controls(): Record<string, HTMLInputElement | HTMLSelectElement> {
    return { size: this.size, rate: this.rate, flash: this.flash };
  }

  get order(): FilmOrder {
    const [width, height] = this.size.value.split("x").map(Number);
    return { width, height, fps: Number(this.rate.value), flash: this.flash.checked };
  }
}
