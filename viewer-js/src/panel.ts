// What is read and pressed: title, time, buttons, figures, keys. All text of the dance goes in as text, never as HTML.

import type { Clicks } from "./clicks";
import type { Clock } from "./clock";
import type { ClipColours } from "./colours";
import type { ComparedData, PageData } from "./contract";
import { lastBefore } from "./data";
import type { Keyposes } from "./keyposes";
import type { Stage } from "./stage";

const SPEEDS = [1, 0.5, 0.25];
const JUMP = 2; // [s]

const LEGEND: [sign: string, colour: string, short: string, words: string][] = [
  ["┃", "#8d93a5", "beat", "beat; strong where a bar begins"],
  ["◆", "#262b3d", "stop", "stop of the hands"],
  ["┊", "#262b3d", "join", "join of two clips"],
  ["∿", "#1f3f77", "global", "energy in the world; hollow where it is a candidate"],
  ["∿", "#c2611a", "local", "energy in the body's own frame"],
  ["●", "#1f3f77", "keypose", "keypose; square where only the body's own frame rests"],
  ["▆", "#d5dae4", "music", "intensity of the music"],
  ["∿", "#2f9c95", "dance", "intensity of the dance"],
];

export class Panel {
  private readonly starts: number[];
  private speed = 0;
  private moveShown = -2;

  constructor(
    private readonly page: PageData,
    private readonly clock: Clock,
    private readonly stage: Stage,
    private readonly colours: ClipColours,
    private readonly clicks: Clicks,
    private readonly keyposes: Keyposes,
    private readonly seek: (time: number) => void,
  ) {
    this.starts = page.moves.map((move) => move.at_s);
    document.title = page.title;
    text("title", page.title);
    text("subtitle", this.subtitle());
    this.fillFigures();
    on("play", () => this.toggle());
    on("start", () => this.toggle());
    on("follow", () => this.toggleFollow());
    on("speed", () => this.nextSpeed());
    on("clicks", () => this.toggleClicks());
    on("previous", () => this.keyposes.step(-1));
    on("next", () => this.keyposes.step(1));
    at("clicks").hidden = !this.clicks.possible;
    this.showCompared();
    text("speed", "1×");
    at("overview").setAttribute("aria-valuemax", page.duration.toFixed(1));
    addEventListener("keydown", (event) => this.key(event));
  }

  update(time: number, sinceBeat: number): void {
    document.body.classList.toggle("playing", this.clock.playing);
    at("start").hidden = this.clock.playing || time > 0;
    const clockText = `${minutes(time)} / ${minutes(this.page.duration)}`;
    if (at("time").textContent !== clockText) {
      text("time", clockText);
      at("overview").setAttribute("aria-valuenow", time.toFixed(1));
      at("overview").setAttribute("aria-valuetext", clockText);
    }
    at("pulse").style.opacity = String(0.12 + 0.88 * Math.exp(-7 * sinceBeat));
    this.showMove(lastBefore(this.starts, time));
  }

  say(message: string): void {
    text("message", message);
    at("message").hidden = false;
    setTimeout(() => (at("message").hidden = true), 6000);
  }

  private subtitle(): string {
    const parts = [minutes(this.page.duration)];
    if (this.page.tempo > 0) parts.push(`${Math.round(this.page.tempo)} beats a minute`);
    if (this.page.method) parts.push(this.page.method);
    return parts.join(" · ");
  }

  private showMove(index: number): void {
    if (index === this.moveShown) return;
    this.moveShown = index;
    const move = this.page.moves[index];
    const box = at("now");
    box.hidden = move === undefined;
    if (!move) return;
    (box.querySelector("i") as HTMLElement).style.color = this.colours.strong(move.clip);
    (box.querySelector("span") as HTMLElement).textContent = move.clip;
  }

  private fillFigures(): void {
    const page = this.page;
    const curves = [page.music_intensity.base64, page.motion_intensity.base64];
    const energy = page.energy ? "there" : "";
    const there = [page.beats, page.stops, page.joins, energy, energy, page.keyposes, ...curves];
    for (const [sign, colour, short, words] of legend(page).filter((_, i) => there[i].length > 0)) {
      at("key").append(entry(sign, colour, short));
      at("legend").append(entry(sign, colour, words));
    }
    for (const metric of this.page.metrics) {
      const [name, value] = [document.createElement("dt"), document.createElement("dd")];
      name.textContent = metric.name;
      value.textContent = metric.value;
      at("metrics").append(name, value);
    }
    at("figures").hidden = false;
  }

  private showCompared(): void {
    const compared = this.page.compared;
    document.body.classList.toggle("compared", compared !== null);
    if (!compared) return;
    this.stage.dancer.heat?.legend(at("heat"), compared.name, compared.who);
    on("master", () => this.nextMaster());
    at("master").title = `The ${compared.who} beside, over as a ghost, or hidden (m)`;
    text("who", compared.who);
    this.tellPlace(compared);
  }

  private nextMaster(): void {
    if (!this.stage.master) return;
    this.stage.nextMaster();
    this.tellPlace(this.page.compared as ComparedData);
  }

  private tellPlace({ who }: ComparedData): void {
    text("master", `${who.charAt(0).toUpperCase()}${who.slice(1)}: ${this.stage.master?.place}`);
  }

  private toggle(): void {
    if (this.clock.playing) this.clock.pause();
    else this.clock.play();
  }

  private toggleFollow(): void {
    this.stage.follow = !this.stage.follow;
    at("follow").setAttribute("aria-pressed", String(this.stage.follow));
  }

  private toggleClicks(): void {
    if (!this.clicks.possible) return;
    this.clicks.toggle();
    at("clicks").setAttribute("aria-pressed", String(this.clicks.on));
  }

  private nextSpeed(): void {
    this.speed = (this.speed + 1) % SPEEDS.length;
    this.clock.setRate(SPEEDS[this.speed]);
    text("speed", `${["1", "½", "¼"][this.speed]}×`);
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const time = this.clock.now(performance.now());
    const frame = 1 / this.page.fps;
    const actions: Record<string, () => void> = {
      " ": () => this.toggle(),
      ArrowLeft: () => this.seek(time - JUMP),
      ArrowRight: () => this.seek(time + JUMP),
      ",": () => this.seek(time - frame),
      ".": () => this.seek(time + frame),
      Home: () => this.seek(0),
      End: () => this.seek(this.page.duration),
      f: () => this.toggleFollow(),
      c: () => this.toggleClicks(),
      m: () => this.nextMaster(),
      "[": () => this.keyposes.step(-1),
      "]": () => this.keyposes.step(1),
      p: () => this.keyposes.step(-1), // where brackets are hard to type
      n: () => this.keyposes.step(1),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault(); // else space would press the button last clicked, too
    action();
  }
}

/** Where two are compared joins are of segments, keyposes are of the other, and a curve of heat is no intensity. */
function legend(page: PageData): typeof LEGEND {
  if (!page.compared) return LEGEND;
  const others: Record<string, [short: string, words: string]> = {
    join: ["segment", "where a segment begins"],
    keypose: ["keypose", `keypose of the ${page.compared.who}; grey where it cannot be kept`],
  };
  if (page.compared.heat) others.dance = ["distance", `mean distance from the ${page.compared.who}`];
  return LEGEND.map(([sign, colour, short, words]) => [sign, colour, ...(others[short] ?? [short, words])]);
}

function entry(sign: string, colour: string, words: string): HTMLElement {
  const row = document.createElement("li");
  const mark = document.createElement("b");
  mark.textContent = sign;
  mark.style.color = colour;
  row.append(mark, words);
  return row;
}

function minutes(seconds: number): string {
  const whole = Math.floor(seconds);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
}

function at(id: string): HTMLElement {
  return document.getElementById(id) as HTMLElement;
}

function text(id: string, words: string): void {
  at(id).textContent = words;
}

function on(id: string, press: () => void): void {
  at(id).addEventListener("click", press);
}
