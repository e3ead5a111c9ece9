// What is read: title, time, the clip danced now, figures. All text of the dance goes in as text, never as HTML.

import type { Clock } from "./clock";
import type { ClipColours } from "./colours";
import type { ComparedData, PageData } from "./contract";
import { lastBefore } from "./data";
import { at, text } from "./elements";
import { type Paint, paint } from "./palette";
import type { Stage } from "./stage";
import { seconds } from "./words";

type Legend = [sign: string, colour: keyof Paint, short: string, words: string];

const LEGEND: Legend[] = [
  ["┃", "soft", "beat", "beat; tall and with its number where a bar begins"],
  ["◆", "ink", "stop", "stop of the hands"],
  ["┊", "ink", "join", "join of two clips"],
  ["∿", "global", "global", "energy in the world; hollow where it is a candidate"],
  ["∿", "local", "local", "energy in the body's own frame"],
  ["●", "global", "keypose", "keypose; square where only the body's own frame rests"],
  ["▆", "music", "music", "intensity of the music"],
  ["∿", "dance", "dance", "intensity of the dance"],
  ["▬", "left", "left", "the left foot stands"],
  ["▬", "right", "right", "the right foot stands"],
];

export class Panel {
  private readonly starts: number[];
  private moveShown = -2;

  constructor(
    private readonly page: PageData,
    private readonly clock: Clock,
    private readonly stage: Stage,
    private readonly colours: ClipColours,
  ) {
    this.starts = page.moves.map((move) => move.at_s);
    document.title = page.title;
    text("title", page.title);
    text("subtitle", this.subtitle());
    this.fillFigures();
    this.showCompared();
    at("overview").setAttribute("aria-valuemax", page.duration.toFixed(1));
  }

  update(time: number, sinceBeat: number): void {
    document.body.classList.toggle("playing", this.clock.playing);
    at("start").hidden = this.clock.playing || time > 0;
    const clockText = `${seconds(time)} / ${seconds(this.page.duration)}`;
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

  /** Colours of the legend, and of the clip that is danced, are those of the room. */
  repaint(): void {
    for (const mark of at("legend").querySelectorAll("b")) mark.style.color = paint[mark.dataset.colour as "ink"];
    this.moveShown = -2;
  }

  /** Where the other one stands, on its button. */
  tellPlace(): void {
    const { who } = this.page.compared as ComparedData;
    text("master", `${who.charAt(0).toUpperCase()}${who.slice(1)}: ${this.stage.master?.place}`);
  }

  private subtitle(): string {
    const parts = [seconds(this.page.duration)];
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
    const there = [page.beats, page.stops, page.joins, energy, energy, page.keyposes, ...curves, page.steps, page.steps];
    for (const [sign, colour, , words] of legend(page).filter((_, i) => there[i].length > 0)) {
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
    at("master").title = `The ${compared.who} beside, over as a ghost, or hidden (m)`;
    this.tellPlace();
  }
}

/** Where two are compared joins are of segments, keyposes are of the other, and a curve of heat is no intensity. */
function legend(page: PageData): Legend[] {
  if (!page.compared) return LEGEND;
  const others: Record<string, [short: string, words: string]> = {
    join: ["segment", "where a segment begins"],
    keypose: ["keypose", `keypose of the ${page.compared.who}; grey where it cannot be kept`],
  };
  if (page.compared.heat) others.dance = ["distance", `mean distance from the ${page.compared.who}`];
  return LEGEND.map(([sign, colour, short, words]) => [sign, colour, ...(others[short] ?? [short, words])]);
}

function entry(sign: string, colour: keyof Paint, words: string): HTMLElement {
  const row = document.createElement("li");
  const mark = document.createElement("b");
  mark.textContent = sign;
  mark.dataset.colour = colour;
  mark.setAttribute("aria-hidden", "true");
  row.append(mark, words);
  return row;
}
