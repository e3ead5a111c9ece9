// A library's clips: which ones the user wants to see danced, and which never.

import { ask, words } from "./api";
import type { ClipItem, LibraryView as Library } from "./contract";
import { button, h, keyed, say } from "./elements";
import { notice } from "./notices";
import { pending } from "./pending";
import { go, type Studio, type View } from "./view";
import { exactly, plural } from "./words";

type Mark = ClipItem["mark"];

export class LibraryView implements View {
  readonly root = h("article", { class: "view library" });
  title = "Library";
  private clips: ClipItem[] = [];
  private asked = false;
  private readonly facts = h("p", { class: "facts", role: "status" });
  private readonly rows = h("ul", { class: "clips" });
  private readonly sieve = h("input", { type: "search", placeholder: "Find a clip", "aria-label": "Find a clip" });
  private readonly none = h("p", { class: "empty", hidden: true }, "No clip has this name.");

  constructor(
    private readonly studio: Studio,
    private readonly id: string,
  ) {
    this.sieve.addEventListener("input", () => this.fill());
    this.update();
  }

  update(): void {
    const item = this.studio.store.project?.libraries.find(({ id }) => id === this.id);
    if (!item)
      return void this.root.replaceChildren(h("p", { class: "empty" }, "This library is not in the project any more."));
    this.title = item.name;
    if (item.state !== "ready") return pending(this.root, this.studio.store, item, "This library", "libraries");
    if (!this.asked) void this.open();
  }

  private async open(): Promise<void> {
    this.asked = true;
    this.studio.player.load({ url: null, start: 0, speed: 1, duration: 0 });
    try {
      this.show(await ask<Library>("GET", `libraries/${this.id}`));
    } catch (error) {
      this.asked = false;
      this.root.replaceChildren(h("p", { class: "problem", role: "alert" }, words(error)));
    }
  }

  private show({ item, clips, problems }: Library): void {
    this.clips = clips;
    const told =
      "Favourites are danced more gladly; what is forbidden is never danced. Both hold for dances that are made from now on.";
    this.root.replaceChildren(
      h(
        "header",
        { class: "head" },
        h("div", {}, h("h2", {}, item.name), this.facts, item.note && h("p", { class: "note" }, item.note)),
        h(
          "div",
          { class: "row" },
          button("Dance with it", () => go("order", `/${this.id}`), { class: "text strong" }),
        ),
      ),
      (problems.length > 0 &&
        h(
          "details",
          { class: "problems" },
          h("summary", {}, `${plural(problems.length, "file")} left out`),
          h("ul", {}, ...problems.map((line) => h("li", {}, line))),
        )) ||
        "",
      h("div", { class: "row" }, this.sieve, h("span", { class: "soft" }, told)),
      this.rows,
      this.none,
    );
    this.fill();
  }

  private fill(): void {
    const sought = this.sieve.value.trim().toLowerCase();
    const shown = this.clips.filter(({ name }) => name.toLowerCase().includes(sought));
    keyed(
      this.rows,
      shown,
      ({ name }) => name,
      (clip) => this.row(clip),
      (row, clip) => this.mark(row, clip),
    );
    this.none.hidden = shown.length > 0;
    const of = (mark: Mark) => this.clips.filter((clip) => clip.mark === mark).length;
    const seconds = this.clips.reduce((sum, clip) => sum + clip.seconds, 0);
    say(
      this.facts,
      `${plural(this.clips.length, "clip")} · ${exactly(seconds)} · ${plural(of("favourite"), "favourite")} · ${of("forbidden")} forbidden`,
    );
  }

  private row({ name, seconds }: ClipItem): HTMLElement {
    const press = (mark: Mark) => () => void this.toggle(name, mark);
    return h(
      "li",
      {},
      h("span", { class: "name" }, name),
      h("span", { class: "soft" }, exactly(seconds)),
      button("★ Favourite", press("favourite"), { "aria-label": `Favourite: ${name}` }),
      button("⊘ Forbid", press("forbidden"), { "aria-label": `Forbidden: ${name}` }),
    );
  }

  private mark(row: HTMLElement, { mark }: ClipItem): void {
    const [favourite, forbidden] = Array.from(row.querySelectorAll("button"));
    favourite.setAttribute("aria-pressed", String(mark === "favourite"));
    forbidden.setAttribute("aria-pressed", String(mark === "forbidden"));
    row.className = mark ?? "";
  }

  private async toggle(name: string, mark: Mark): Promise<void> {
    const before = this.clips;
    const now = before.find((clip) => clip.name === name)?.mark === mark ? null : mark;
    this.clips = before.map((clip) => (clip.name === name ? { ...clip, mark: now } : clip));
    this.fill();
    try {
      await ask("PUT", `libraries/${this.id}/marks`, { [name]: now });
    } catch (error) {
      this.clips = before;
      this.fill();
      notice(words(error), true);
    }
  }
}
