// All that is in the project, as cards: songs, motions, libraries, dances.

import { ask } from "./api";
import { card, type CardData, showCard } from "./card";
import type { Project } from "./contract";
import { confirmed } from "./dialogs";
import type { Dropping } from "./dropping";
import { button, h, keyed, say } from "./elements";
import { newLibrary } from "./library_dialog";
import { isGuessed } from "./rate_form";
import type { Store } from "./store";
import { go } from "./view";
import { exactly, isSkeleton, pace, plainName, plural } from "./words";

interface Section {
  root: HTMLElement;
  count: HTMLElement;
  cards: HTMLElement;
  empty: HTMLElement;
  sieve: HTMLInputElement;
  more: HTMLButtonElement;
}

const KINDS = ["song", "motion", "library", "dance"] as const;
type Kind = (typeof KINDS)[number];
const FEW = 8; // cards of a kind, beyond which the others are shown when they are wanted
const KEPT = new Set(["song", "troupe"]); // what is always there

export class Shelf {
  private readonly sections: Record<Kind, Section>;
  private readonly making: HTMLButtonElement;
  private readonly whole = new Set<Kind>(); // kinds of which all are shown
  private here = "";

  constructor(
    root: HTMLElement,
    private readonly store: Store,
    private readonly dropping: Dropping,
  ) {
    const add = (what: string): HTMLButtonElement =>
      button("Add", () => dropping.choose(), { "aria-label": `Add ${what}` });
    this.making = button("Make", () => newLibrary(store), { "aria-label": "Make a library" });
    const dance = button("New", () => go("order"), { "aria-label": "A new dance", class: "text strong" });
    this.sections = {
      dance: section("Dances", dance, "None yet: choose a song and press New."),
      song: section("Songs", add("songs"), ""),
      motion: section("Motions", add("motions"), "Drop motion files here: BVH, C3D, AMC, npz …, or a zip of them."),
      library: section("Libraries", this.making, ""),
    };
    for (const kind of KINDS) {
      const { sieve, more } = this.sections[kind];
      sieve.addEventListener("input", () => this.update(this.here));
      more.addEventListener("click", () => this.turn(kind));
    }
    root.append(...Object.values(this.sections).map(({ root: part }) => part));
  }

  update(here: string): void {
    this.here = here;
    const { project } = this.store;
    if (!project) return;
    const all = {
      song: this.songs(project),
      motion: this.motions(project),
      library: this.libraries(project),
      dance: this.dances(project),
    };
    this.making.disabled = !project.motions.some(({ state }) => state === "ready");
    for (const kind of KINDS) {
      const { cards, count, empty, sieve, more } = this.sections[kind];
      const sending = this.dropping.sending
        .filter((one) => one.kind === kind)
        .map(({ key, name, share }): CardData => ({
          kind,
          id: key,
          name: plainName(name),
          line: "",
          state: "waiting",
          error: null,
          sending: share,
        }));
      const items = [...all[kind].reverse(), ...sending];
      say(count, items.length ? String(items.length) : "");
      empty.hidden = items.length > 0;
      sieve.hidden = more.hidden = items.length <= FEW;
      say(more, this.whole.has(kind) ? "Show fewer" : `Show all ${items.length}`);
      keyed(
        cards,
        this.shown(kind, items, here),
        ({ id }) => id,
        (one) => card(one, () => this.remove(one)),
        (element, one) => showCard(element, one, here === `${kind}/${one.id}`),
      );
    }
  }

  private turn(kind: Kind): void {
    if (!this.whole.delete(kind)) this.whole.add(kind);
    this.update(this.here);
  }

  /** Those that are sought; else the newest, what is looked at and what is being worked on, or all. */
  private shown(kind: Kind, items: readonly CardData[], here: string): readonly CardData[] {
    const sought = this.sections[kind].sieve.value.trim().toLowerCase();
    if (sought) return items.filter(({ name }) => name.toLowerCase().includes(sought));
    if (this.whole.has(kind) || items.length <= FEW) return items;
    let room = FEW;
    return items.filter(
      ({ id, job, sending }) => room-- > 0 || here === `${kind}/${id}` || job?.state === "running" || (sending ?? 0) > 0,
    );
  }

  private songs({ songs }: Project): CardData[] {
    return songs.map(({ id, name, state, job, error, duration, tempo, edited }) => {
      const line = [exactly(duration), pace(tempo, "bpm"), edited ? "beats corrected" : ""]
        .filter(Boolean)
        .join(" · ");
      return {
        kind: "song",
        id,
        name: plainName(name),
        line,
        state,
        error,
        job: this.store.job(job),
        kept: KEPT.has(id),
      };
    });
  }

  private motions({ motions }: Project): CardData[] {
    return motions.map((item) => {
      const { id, name, state, job, error, seconds, body, lacks } = item;
      return {
        kind: "motion",
        id,
        name: isSkeleton(name) ? name : plainName(name),
        line: [exactly(seconds), isGuessed(item) ? `${Math.round(item.fps)} fps assumed` : "", body].filter(Boolean).join(" · "),
        state,
        error,
        lacks,
        job: this.store.job(job),
      };
    });
  }

  private libraries({ libraries }: Project): CardData[] {
    return libraries.map(({ id, name, state, job, error, clips, seconds }) => {
      const line = clips ? `${plural(clips, "clip")} · ${exactly(seconds)}` : "";
      return { kind: "library", id, name, line, state, error, job: this.store.job(job), kept: KEPT.has(id) };
    });
  }

  private dances({ dances }: Project): CardData[] {
    return dances.map(({ id, name, state, job, error, seconds, robot, speed, f50 }) => {
      const line = [
        exactly(seconds),
        robot ?? "",
        speed === 1 ? "" : `×${speed.toFixed(2)}`,
        f50 === null ? "" : `F50 ${f50.toFixed(2)}`,
      ];
      return {
        kind: "dance",
        id,
        name: name.replace(/ ×/g, "\u00a0×"), // it stays with its number
        line: line.filter(Boolean).join(" · "),
        state,
        error,
        job: this.store.job(job),
      };
    });
  }

  private remove({ kind, id, name }: CardData): void {
    const where = { song: "songs", motion: "motions", library: "libraries", dance: "dances" }[kind];
    confirmed(`Take this ${kind} away?`, `“${name}” goes out of the project for good.`, "Take away", async () => {
      await ask("DELETE", `${where}/${id}`);
      await this.store.refresh();
      if (location.hash.startsWith(`#${kind}/${id}`)) go("start");
    });
  }
}

function section(title: string, add: HTMLElement, empty: string): Section {
  const [count, cards, none] = [
    h("span", { class: "soft" }),
    h("ul", { class: "cards" }),
    h("p", { class: "soft none" }, empty),
  ];
  const words = `Find among the ${title.toLowerCase()}`;
  const sieve = h("input", { type: "search", placeholder: words, "aria-label": words, hidden: true });
  const more = button("", () => undefined, { class: "more", hidden: true });
  const root = h(
    "section",
    { "aria-label": title },
    h("div", { class: "row" }, h("h2", {}, title), count, h("i", { class: "fill" }), add),
    sieve,
    cards,
    more,
    none,
  );
  return { root, count, cards, empty: none, sieve, more };
}
