// The studio: the shelf with all that is in the project, and in the middle what is being looked at.

import { Theme } from "../live/theme";
import { dim as repaint } from "../palette";
import { AWAY } from "./api";
import { DanceView } from "./dance_view";
import { saveWanted } from "./dance_tools";
import { Dropping } from "./dropping";
import { at, h, say } from "./elements";
import { help } from "./help";
import { JobsPanel } from "./jobs_panel";
import { LibraryView } from "./library_view";
import { Look } from "./look";
import { MotionView } from "./motion_view";
import { notice, unsay } from "./notices";
import { OrderView } from "./order_view";
import { Player } from "./player";
import { Shelf } from "./shelf";
import { SongView } from "./song_view";
import { StartView } from "./start_view";
import { Store } from "./store";
import type { Studio, View } from "./view";

const WRITTEN_IN = "input:not([type=range]):not([type=checkbox]), select, textarea, dialog";
const LONGEST_STEP = 0.1; // [s]

class Page implements Studio {
  readonly store = new Store();
  readonly player: Player = new Player(
    () => document.body.classList.toggle("playing", this.player.playing),
    (words) => notice(words, true),
  );
  readonly looks: [Look, Look] = [new Look(), new Look()];
  private readonly theme: Theme;
  private readonly dropping = new Dropping(this.store, () => this.update());
  private readonly shelf = new Shelf(at("shelf"), this.store, this.dropping);
  private readonly jobs = new JobsPanel(this.store);
  private view?: View;
  private where = "";
  private known = false;
  private drawnAt = performance.now();

  constructor() {
    this.theme = new Theme(() => this.dim());
    at("dark").addEventListener("click", () => this.theme.toggle());
    at("help").addEventListener("click", () => help());
    at("skip").addEventListener("click", (event) => {
      event.preventDefault(); // the address names what is looked at
      at("work").focus();
    });
    at("shelf-button").addEventListener("click", () => this.fold(!document.body.classList.contains("shelved")));
    at("shelf").addEventListener("click", (event) => {
      if ((event.target as Element).closest("a[href]")) this.fold(false);
    });
    this.store.listen(() => this.update());
    addEventListener("hashchange", () => this.turn());
    addEventListener("keydown", (event) => this.key(event));
    addEventListener("mousedown", (event) => unfocused(event));
    addEventListener("click", (event) => released(event));
    this.store.open();
    requestAnimationFrame((now) => this.frame(now));
  }

  readonly dark = (): boolean => document.documentElement.dataset.theme === "dark";

  /** For scripts and tests. */
  state(): Record<string, unknown> {
    const { player, looks } = this;
    const now = performance.now();
    return {
      where: this.where,
      connected: this.store.connected,
      revision: this.store.project?.revision ?? -1,
      time: player.now(now),
      heard: player.heard,
      leads: player.leads,
      playing: player.playing,
      duration: player.duration,
      joints: looks[0].joints,
      other: looks[1].joints,
      dark: this.dark(),
      ...this.view?.state?.(),
    };
  }

  private update(): void {
    const { project, connected, problem } = this.store;
    document.body.classList.toggle("away", !connected);
    if (connected) unsay(AWAY);
    say(at("link").lastElementChild as Element, connected ? "connected" : "no server; trying again");
    at("away").hidden = connected || !project;
    say(at("away"), `${problem || "The server is away."} What is shown stays; as soon as it is back, everything goes on.`);
    say(at("project"), project?.name ?? "");
    if (!project)
      return void (problem && at("work").replaceChildren(h("p", { class: "problem", role: "alert" }, problem)));
    if (!this.known) this.turn();
    else this.view?.update();
    this.known = true;
    this.name();
    this.shelf.update(this.where.split("/").slice(0, 2).join("/"));
    this.jobs.update();
    saveWanted(this.store);
  }

  /** Shows what the address names. */
  private turn(): void {
    const where = decoded(location.hash.slice(1)) || "start";
    if (!this.store.project || where === this.where) return;
    this.view?.close?.();
    this.player.pause();
    this.where = where;
    this.view = this.made(where);
    at("work").replaceChildren(this.view.root);
    at("work").scrollTop = 0;
    this.fold(false);
    this.name();
    this.shelf.update(where.split("/").slice(0, 2).join("/"));
  }

  private made(where: string): View {
    const [kind, id = "", more = ""] = where.split("/");
    if (kind === "song") return new SongView(this, id);
    if (kind === "motion") return new MotionView(this, id);
    if (kind === "library") return new LibraryView(this, id);
    if (kind === "dance") return new DanceView(this, id, more);
    if (kind === "order") return new OrderView(this, `${id}/${more}`);
    return new StartView(this, () => this.dropping.choose());
  }

  private name(): void {
    document.title = `${this.view?.title ?? ""} · ${this.store.project?.name ?? ""} · onbeat studio`;
  }

  private frame(now: number): void {
    const seconds = Math.min((now - this.drawnAt) / 1000, LONGEST_STEP);
    this.drawnAt = now;
    this.view?.frame?.(this.player.now(now), seconds);
    requestAnimationFrame((next) => this.frame(next));
  }

  private key(event: KeyboardEvent): void {
    const target = event.target as HTMLElement;
    if (event.defaultPrevented || target.closest(WRITTEN_IN)) return;
    const own =
      event.key === " " || event.key === "Enter"
        ? target.closest("button, a, summary, [type=checkbox]")
        : target.closest("[type=range]");
    if (own) return; // the control's own key
    if (this.view?.key?.(event)) event.preventDefault();
  }

  private fold(open: boolean): void {
    document.body.classList.toggle("shelved", open);
    at("shelf-button").setAttribute("aria-expanded", String(open));
  }

  private dim(): void {
    // Called once before all parts are there.
    const dark = this.dark();
    repaint(dark);
    at("dark").setAttribute("aria-pressed", String(dark));
    for (const look of this.looks) look.dark = dark;
    this.view?.dim?.();
  }
}

/** What an address names; one that somebody spoiled names nothing. */
function decoded(words: string): string {
  try {
    return decodeURIComponent(words);
  } catch {
    return "";
  }
}

/** A button that is pressed with a pointer does not take the focus: space plays. */
function unfocused(event: MouseEvent): void {
  if (!(event.target as Element).closest(".view button")) return;
  event.preventDefault();
  (document.activeElement as HTMLElement | null)?.blur();
}

/** Nor does a slider keep it: arrows seek. */
function released(event: MouseEvent): void {
  const slider = (event.target as Element).closest<HTMLElement>(".view input[type=range]");
  if (event.detail > 0 && slider === document.activeElement) slider?.blur();
}

const page = new Page();
Object.assign(window, {
  onbeatStudio: {
    state: () => page.state(),
    play: () => page.player.play(),
    pause: () => page.player.pause(),
    seek: (t: number) => page.player.seek(t),
  },
});
