// Playing: a button, the time, a slider to seek with, speed, loop, clicks and the camera.

import { button, choice, h, say } from "./elements";
import { VIEWS, type ViewName } from "../presets";
import type { Clicks } from "./clicks";
import type { Look } from "./look";
import type { Player } from "./player";
import { exactly } from "./words";

const SPEEDS = [
  ["1", "1×"],
  ["0.75", "¾×"],
  ["0.5", "½×"],
  ["0.25", "¼×"],
] as const;
const JUMP = 2; // [s]

export interface Extra {
  clicks?: Clicks;
  looks?: readonly Look[];
}

export class Transport {
  readonly root: HTMLElement;
  private readonly play = h("button", {
    type: "button",
    class: "play",
    title: "Play or pause (space)",
    onclick: () => this.player.toggle(),
  });
  private readonly time = h("output", { class: "time", "aria-label": "Time", "aria-live": "off" });
  private readonly slide: HTMLInputElement;
  private readonly loop = button("Loop", () => this.toggleLoop(), {
    "aria-pressed": "false",
    title: "Begin again at the end (L)",
  });
  private readonly clicking?: HTMLButtonElement;
  private readonly camera?: HTMLSelectElement;

  constructor(
    private readonly player: Player,
    private readonly extra: Extra = {},
  ) {
    this.slide = h("input", {
      type: "range",
      min: 0,
      max: 1,
      step: 0.01,
      value: 0,
      "aria-label": "Seek",
      class: "seek",
    });
    this.slide.addEventListener("input", () => player.seek(Number(this.slide.value)));
    const speed = choice(SPEEDS, String(player.rate));
    speed.setAttribute("aria-label", "Playing speed");
    speed.title = "Playing speed; the pitch stays";
    speed.addEventListener("change", () => player.setRate(Number(speed.value)));
    const { clicks, looks } = extra;
    if (clicks)
      this.clicking = button("Clicks", () => this.toggleClicks(), {
        "aria-pressed": "false",
        title: "A click on every beat (K)",
      });
    if (looks) this.camera = this.cameras(looks);
    this.root = h(
      "div",
      { class: "transport", role: "group", "aria-label": "Playing" },
      this.play,
      this.time,
      this.slide,
      speed,
      this.loop,
      this.clicking,
      this.camera,
    );
    this.loop.setAttribute("aria-pressed", String(player.loop));
    this.update(player.now(performance.now()));
  }

  update(time: number): void {
    const { player, play } = this;
    const does = player.playing ? "Pause" : "Play";
    if (play.getAttribute("aria-label") !== does) {
      play.setAttribute("aria-label", does);
      play.replaceChildren(sign(player.playing));
    }
    const words = `${exactly(time)} / ${exactly(player.duration)}`;
    if (this.time.textContent === words) return;
    say(this.time, words);
    this.slide.max = String(Math.max(player.duration, 0.01));
    this.slide.value = String(time);
    this.slide.setAttribute("aria-valuetext", words);
  }

  key(event: KeyboardEvent): boolean {
    if (event.ctrlKey || event.metaKey || event.altKey) return false;
    const time = this.player.now(performance.now());
    const does: Record<string, () => void> = {
      " ": () => this.player.toggle(),
      arrowleft: () => this.player.seek(time - (event.shiftKey ? JUMP / 10 : JUMP)),
      arrowright: () => this.player.seek(time + (event.shiftKey ? JUMP / 10 : JUMP)),
      home: () => this.player.seek(0),
      end: () => this.player.seek(this.player.duration),
      l: () => this.toggleLoop(),
      k: () => this.toggleClicks(),
      v: () => this.nextCamera(),
    };
    const act = does[event.key.toLowerCase()];
    act?.();
    return act !== undefined;
  }

  private toggleLoop(): void {
    this.player.loop = !this.player.loop;
    this.loop.setAttribute("aria-pressed", String(this.player.loop));
  }

  private toggleClicks(): void {
    this.extra.clicks?.toggle();
    this.clicking?.setAttribute("aria-pressed", String(this.extra.clicks?.on));
  }

  private cameras(looks: readonly Look[]): HTMLSelectElement {
    const select = choice(
      VIEWS.map((view) => [view, view]),
      looks[0].view,
    );
    select.setAttribute("aria-label", "Camera");
    select.title = "Where the camera looks from (V)";
    select.addEventListener("change", () => looks.forEach((look) => look.look(select.value as ViewName)));
    return select;
  }

  private nextCamera(): void {
    const { camera } = this;
    if (!camera) return;
    camera.selectedIndex = (camera.selectedIndex + 1) % camera.options.length;
    camera.dispatchEvent(new Event("change"));
  }
}

function sign(playing: boolean): SVGElement {
  const space = "http://www.w3.org/2000/svg";
  const picture = document.createElementNS(space, "svg");
  picture.setAttribute("viewBox", "0 0 24 24");
  picture.setAttribute("aria-hidden", "true");
  const path = document.createElementNS(space, "path");
  path.setAttribute("d", playing ? "M7 5h3.6v14H7zM13.4 5H17v14h-3.6z" : "M8 5.2v13.6L19 12z");
  picture.append(path);
  return picture;
}
