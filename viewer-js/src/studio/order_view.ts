// What is to be danced: song, moves, how long, how, and by whom.

import { ask } from "./api";
import type { DanceItem, DanceOrder } from "./contract";
import { complain } from "./dialogs";
import { button, choice, field, h, offer, say } from "./elements";
import { Entries } from "./entries";
import { type Part, StretchChooser } from "./stretch";
import { go, type Studio, type View } from "./view";
import { exactly, plainName } from "./words";

const USUAL = 60; // [s] of a song that are danced, if it is longer
export const LIKE = "like";
const SHORTEST = 1; // [s] of a dance
const MOST_WEIGHT = 2; // of the usual weight of the intensity

export class OrderView implements View {
  readonly root = h("article", { class: "view order" });
  readonly title = "A new dance";
  private readonly song = choice([], "");
  private readonly library = choice([], "");
  private readonly method = choice([], "");
  private readonly robot = choice([], "");
  private readonly start = number("start", 0, 0, 36000);
  private readonly seconds = number("seconds", USUAL, 1, 36000);
  private readonly weight = h("input", {
    type: "range",
    name: "intensity_weight",
    min: 0,
    max: MOST_WEIGHT,
    step: 0.1,
    value: 1,
  });
  private readonly weightTold = h("output", {});
  private readonly speed = number("speed", 1, 0.5, 2);
  private readonly seed = number("seed", 0, 0, 2 ** 31, 1);
  private readonly name = h("input", {
    type: "text",
    name: "name",
    maxlength: 120,
    placeholder: "Named after song and moves",
  });
  private readonly problem = h("p", { class: "problem", role: "alert", hidden: true });
  private readonly methodTold = h("small", {});
  private readonly lengthTold = h("small", {});
  private readonly go = h("button", { type: "submit", class: "text strong big", form: "order" }, "Dance");
  private readonly form: HTMLFormElement;
  private readonly stretch: StretchChooser;
  private readonly entries: Entries;
  private readonly kept: Entries; // of each song the stretch
  private beside = ""; // the dance that was like it

  /** `given` is SONG or SONG/LIBRARY, ids of what is chosen already, or like/DANCE. */
  constructor(
    private readonly studio: Studio,
    given: string,
  ) {
    const { song: which, library: moves, method, robot, weight, speed, seed, name } = this;
    for (const [words, select] of Object.entries({ song: which, library: moves, method, robot })) {
      select.setAttribute("name", words);
    }
    this.form = this.made();
    this.entries = new Entries(studio.store, `order/${given}`);
    this.entries.watch({ song: which, library: moves, method, robot, weight, speed, seed, name });
    this.kept = new Entries(studio.store, `stretch/${given}`);
    this.form.addEventListener("submit", (event) => {
      event.preventDefault();
      void this.send();
    });
    this.weight.addEventListener("input", () => this.tell());
    for (const select of [this.method, this.song])
      select.addEventListener("change", () => this.chosen(select === this.song));
    for (const entry of [this.start, this.seconds])
      entry.addEventListener("input", () => {
        this.keepStretch();
        this.tell();
      });
    for (const entry of [this.speed, this.library]) entry.addEventListener("input", () => this.tell());
    this.stretch = new StretchChooser(
      studio,
      () => this.part(),
      ({ from, to }) => this.take(from, to),
    );
    studio.player.load({ url: null, start: 0, speed: 1, duration: 0 });
    this.root.append(h("header", { class: "head" }, h("h2", {}, this.title), this.go), this.form, this.stretch.root);
    this.update();
    const [song, library] = given.split("/");
    const before = song === LIKE ? studio.store.dance(library ?? "") : undefined;
    if (before) this.like(before);
    else if (song) this.song.value = song;
    if (library && !before) this.library.value = library;
    this.entries.restore();
    this.chosen(before === undefined || this.song.value !== before.order.song);
  }

  /** The order of an earlier dance, to be changed; both are shown side by side then. */
  private like({ id, order }: DanceItem): void {
    this.beside = id;
    this.song.value = order.song;
    this.library.value = order.library;
    this.start.value = String(order.start);
    this.seconds.value = String(order.seconds ?? this.longest());
    this.weight.value = String(order.intensity_weight);
    this.method.value = order.method;
    this.speed.value = String(order.speed);
    this.seed.value = String(order.seed);
    this.robot.value = order.robot ?? "";
  }

  update(): void {
    const { project } = this.studio.store;
    if (!project) return;
    const before = this.song.value;
    const ready = <T extends { state: string }>(items: readonly T[]): T[] =>
      items.filter(({ state }) => state === "ready");
    offer(
      this.song,
      ready(project.songs).map(({ id, name, duration }) => [id, `${plainName(name)} · ${exactly(duration)}`]),
      this.song.value || newest(ready(project.songs)),
    );
    offer(
      this.library,
      ready(project.libraries).map(({ id, name, clips }) => [id, `${name}${clips ? ` · ${clips} clips` : ""}`]),
      this.library.value || newest(ready(project.libraries)),
    );
    offer(
      this.method,
      project.methods.map(({ name }) => [name, name]),
      this.method.value || "optimal",
    );
    offer(this.robot, [
      ["", "a character, as the moves are"],
      ...project.robots.map(({ name, title }) => [name, title || name] as const),
    ]);
    this.go.disabled = !this.song.value || !this.library.value;
    if (this.song.value !== before) this.chosen(true); // one is ready now
    else this.tellLength();
  }

  frame(time: number): void {
    this.stretch.frame(time);
  }

  key(event: KeyboardEvent): boolean {
    return this.stretch.key(event);
  }

  dim(): void {
    this.stretch.dim();
  }

  private made(): HTMLFormElement {
    const whole = button("Whole song", () => this.take(0, this.duration));
    return h(
      "form",
      { class: "form", id: "order" },
      h(
        "fieldset",
        {},
        h("legend", {}, "Music and moves"),
        field("Song", this.song),
        field("Library of moves", this.library),
        h("div", { class: "pair" }, field("From second", this.start), field("Seconds", this.seconds)),
        h("div", { class: "row" }, this.lengthTold, whole),
      ),
      h(
        "fieldset",
        {},
        h("legend", {}, "How it is danced"),
        field("λ: follows the rhythm, or the intensity", this.weight),
        h(
          "div",
          { class: "ends", "aria-hidden": "true" },
          h("span", {}, "rhythm"),
          this.weightTold,
          h("span", {}, "intensity"),
        ),
        field("Method", this.method),
        this.methodTold,
        h("div", { class: "pair" }, field("Speed of the music", this.speed), field("Seed", this.seed)),
      ),
      h("fieldset", {}, h("legend", {}, "Who dances"), field("Danced by", this.robot), field("Name", this.name)),
      this.problem,
    );
  }

  private get duration(): number {
    return this.studio.store.project?.songs.find(({ id }) => id === this.song.value)?.duration ?? 0;
  }

  private longest(): number {
    return Math.max(Math.round((this.duration - Number(this.start.value)) * 10) / 10, 1);
  }

  /** Another song, whose stretch is that which was entered for it before, or the usual. */
  private chosen(song: boolean): void {
    if (song) {
      this.start.value = "0";
      this.seconds.value = String(Math.min(this.longest(), USUAL));
    }
    const kept = this.kept.get(this.song.value);
    if (kept) [this.start.value, this.seconds.value] = JSON.parse(kept) as [string, string];
    void this.stretch.open(this.song.value);
    this.tell();
  }

  private keepStretch(): void {
    this.kept.set(this.song.value, JSON.stringify([this.start.value, this.seconds.value]));
  }

  private part(): Part {
    const from = Number(this.start.value);
    return { from, to: Math.min(from + Number(this.seconds.value), this.duration) };
  }

  private take(from: number, to: number): void {
    this.start.value = from.toFixed(1);
    this.seconds.value = (to - from).toFixed(1);
    this.keepStretch();
    this.tell();
  }

  private tell(): void {
    const method = this.studio.store.project?.methods.find(({ name }) => name === this.method.value);
    say(this.methodTold, method?.title ?? "");
    const weight = Number(this.weight.value);
    this.stretch.dim();
    say(this.weightTold, weight === 0 ? "0: rhythm only" : weight === 1 ? "1: as usual" : weight.toFixed(1));
    this.weight.setAttribute(
      "aria-valuetext",
      `${weight.toFixed(1)}, from 0, the rhythm only, to ${MOST_WEIGHT}, mostly the intensity`,
    );
    this.tellLength();
  }

  private tellLength(): void {
    const lacking = [this.song.value ? "" : "song", this.library.value ? "" : "library"].filter(Boolean).join(" and no ");
    const waits = lacking && `No ${lacking} is ready yet: wait until the jobs are done.`;
    const { words, bad } = this.song.value
      ? danced(Number(this.start.value), Number(this.seconds.value), this.duration, Number(this.speed.value))
      : { words: "", bad: false };
    say(this.lengthTold, [words, waits].filter(Boolean).join(" "));
    this.lengthTold.className = bad || waits ? "note" : "";
  }

  private order(): DanceOrder {
    const whole = Math.abs(Number(this.seconds.value) - this.longest()) < 0.05;
    return {
      song: this.song.value,
      library: this.library.value,
      start: Number(this.start.value),
      seconds: whole ? null : Number(this.seconds.value),
      method: this.method.value,
      seed: Number(this.seed.value),
      intensity_weight: Number(this.weight.value),
      robot: this.robot.value || null,
      speed: Number(this.speed.value),
      keep: [],
      name: this.name.value.trim(),
    };
  }

  private async send(): Promise<void> {
    this.go.disabled = true;
    this.problem.hidden = true;
    try {
      const dance = await ask<DanceItem>("POST", "dances", this.order());
      this.entries.forget("name"); // no two dances by one name
      await this.studio.store.refresh();
      go("dance", this.beside ? `${dance.id}/${this.beside}` : dance.id);
    } catch (error) {
      complain(this.form, this.problem, error);
    }
    this.go.disabled = false;
  }
}

/** What will be danced of a song, in words; `bad` where that is not what was asked for. */
function danced(from: number, seconds: number, duration: number, speed: number): { words: string; bad: boolean } {
  if (from > duration - SHORTEST)
    return { words: `The song has ${exactly(duration)}: begin at second ${Math.max(duration - SHORTEST, 0).toFixed(1)} or before.`, bad: true };
  const left = duration - from;
  const short = seconds > left + 0.05;
  const span = `Danced: ${exactly(from)} to ${exactly(from + Math.min(seconds, left))} of ${exactly(duration)}`;
  const lasts = speed > 0 && speed !== 1 ? `, in ${exactly(Math.min(seconds, left) / speed)}` : "";
  return { words: `${span}${lasts}${short ? `: only ${left.toFixed(1)} seconds are left from there` : ""}.`, bad: short };
}

function number(name: string, value: number, min: number, max: number, step: number | "any" = "any"): HTMLInputElement {
  return h("input", { type: "number", name, value, min, max, step, required: true });
}

/** What was added last is what somebody wants to dance with. */
function newest(items: readonly { id: string }[]): string {
  return items[items.length - 1]?.id ?? "";
}
