// What can be done with a dance: retimed, put on a robot, taken away as a file, held against another.

import { ask, words } from "./api";
import type { DanceItem, DanceView, ExportItem, FormatItem, JobItem } from "./contract";
import { confirmed, renamed } from "./dialogs";
import { button, choice, h, keyed, offer, say } from "./elements";
import { Entries } from "./entries";
import { FilmForm } from "./film_form";
import { notice } from "./notices";
import { jobBar, showJob } from "./pending";
import type { Store } from "./store";
import { go } from "./view";

const [SLOWEST, FASTEST] = [0.6, 1.6];
const FILM = "mp4";
const NONE = [["", "nothing"]] as const;

/** Exports that this page asked for: they are saved as soon as they are ready, whatever is looked at then. */
const wanted = new Set<string>();

export function saveWanted(store: Store): void {
  for (const made of store.project?.exports ?? []) {
    if (!wanted.has(made.id) || made.state === "waiting") continue;
    wanted.delete(made.id);
    if (made.state === "ready") save(made);
    else if (made.state === "failed") notice(made.error ?? `${made.file} could not be written.`, true);
  }
}

function save(made: ExportItem): void {
  const link = h("a", { href: `/api/exports/${made.id}`, download: made.file });
  document.body.append(link);
  link.click();
  link.remove();
  notice(`${made.file} is being saved.`);
}

export class DanceTools {
  readonly root: HTMLElement;
  readonly beside = choice(NONE, "");
  private readonly speed = h("input", { type: "range", name: "speed", step: 0.01 });
  private readonly speedTold = h("output", {});
  private readonly robot = choice([], "");
  private readonly format = choice([], "");
  private readonly film = new FilmForm();
  private readonly formatTold = h("small", {});
  private readonly files = h("ul", { class: "files" });
  private readonly exporting: HTMLButtonElement;
  private readonly putting = button("Put it on", () => void this.act(() => this.onRobot()));
  private readonly retiming = button("Retime", () => void this.act(() => this.retime()));

  constructor(
    private readonly store: Store,
    private item: DanceItem,
    view: DanceView,
    besideAtFirst: string,
  ) {
    for (const [words, control] of Object.entries({
      "Side by side with": this.beside,
      "Speed of the music": this.speed,
      Robot: this.robot,
      Format: this.format,
    })) {
      control.setAttribute("aria-label", words); // seen is the title of its part
    }
    this.speed.min = String(Math.min(SLOWEST, item.speed));
    this.speed.max = String(Math.max(FASTEST, item.speed));
    this.speed.value = String(item.speed);
    this.speed.addEventListener("input", () => this.tell());
    for (const select of [this.format, this.robot]) select.addEventListener("change", () => this.tell());
    this.exporting = button("Export", () => void this.act(() => this.export()), { class: "text strong" });
    this.root = h(
      "aside",
      { class: "side", "aria-label": "What to do with this dance" },
      section("Side by side with", this.beside),
      section("Speed of the music", this.speed, h("div", { class: "row" }, this.speedTold, this.retiming)),
      section("On a robot", h("div", { class: "beside" }, this.robot, this.putting)),
      section("Export", this.format, this.film.root, this.formatTold, h("div", { class: "row end" }, this.exporting), this.files),
      this.figures(view),
      h(
        "div",
        { class: "row" },
        button("Rename", () => this.rename()),
        button("Delete", () => this.remove()),
      ),
    );
    this.update(item);
    if (besideAtFirst) this.beside.value = besideAtFirst;
    const { beside, speed, robot, format } = this;
    const entries = new Entries(store, `dance/${item.id}`);
    entries.watch({ beside, speed, robot, format, ...this.film.controls });
    entries.restore();
    this.tell();
  }

  update(item: DanceItem): void {
    this.item = item;
    const { project } = this.store;
    if (!project) return;
    const others = project.dances.filter(({ id, state }) => id !== item.id && state === "ready");
    offer(this.beside, [...NONE, ...others.map(({ id, name }) => [id, name] as const)]);
    offer(
      this.robot,
      project.robots.map(({ name, title }) => [name, title || name]),
    );
    offer(
      this.format,
      project.formats.filter((format) => writes(format, item)).map(({ name, title }) => [name, title || name]),
    );
    const made = project.exports.filter(({ dance }) => dance === item.id).reverse();
    keyed(
      this.files,
      made,
      ({ id }) => id,
      () => h("li"),
      (row, one) => this.showFile(row, one),
    );
    this.tell();
  }

  private tell(): void {
    const speed = Number(this.speed.value);
    const tempo = `×${speed.toFixed(2)}`;
    this.retiming.disabled = Math.abs(speed - this.item.speed) < 0.005;
    this.putting.disabled = !this.robot.value || this.robot.value === this.item.robot; // it is on it already
    say(this.speedTold, `${tempo}, ${pace(speed, this.item.speed)}`);
    this.speed.setAttribute("aria-valuetext", tempo);
    const format = this.store.project?.formats.find(({ name }) => name === this.format.value);
    this.film.root.hidden = this.format.value !== FILM;
    say(this.formatTold, format?.missing ? `Needs a package: pip install 'onbeat[${format.missing}]'` : "");
    this.exporting.disabled = !format || format.missing !== "";
  }

  private showFile(row: HTMLElement, made: ExportItem): void {
    const job = this.store.job(made.job);
    if (made.state === "waiting" && job) return showWork(row, job);
    if (row.dataset.state === made.state) return;
    row.dataset.state = made.state;
    if (made.state === "ready")
      row.replaceChildren(
        h(
          "a",
          { href: `/api/exports/${made.id}`, download: made.file, title: made.file },
          h("span", {}, made.file.slice(0, made.file.lastIndexOf("."))),
          made.file.slice(made.file.lastIndexOf(".")),
        ),
        h("span", { class: "soft" }, size(made.bytes)),
        this.away(made),
      );
    else
      row.replaceChildren(
        h("span", { class: made.state === "failed" ? "problem" : "soft" }, made.error ?? `${made.file}: ${made.state}`),
        this.away(made),
      );
  }

  private away({ id, file }: ExportItem): HTMLElement {
    const remove = async (): Promise<void> => {
      await ask("DELETE", `exports/${id}`);
      await this.store.refresh();
    };
    return button("×", () => void this.act(remove), { class: "away", "aria-label": `Take away: ${file}`, title: "Take away" });
  }

  private figures({ metrics }: DanceView): HTMLElement {
    const rows = metrics.flatMap(({ name, value }) => [h("dt", {}, name), h("dd", {}, value)]);
    return h(
      "details",
      { class: "figures", open: innerHeight > 900 },
      h("summary", {}, "Figures of this dance"),
      h("dl", {}, ...rows),
    );
  }

  private async retime(): Promise<void> {
    await this.newDance(`dances/${this.item.id}/retimed`, { speed: Number(this.speed.value) });
  }

  private async onRobot(): Promise<void> {
    await this.newDance(`dances/${this.item.id}/robot`, { robot: this.robot.value });
  }

  private async newDance(path: string, order: unknown): Promise<void> {
    const dance = await ask<DanceItem>("POST", path, order);
    await this.store.refresh();
    go("dance", dance.id);
  }

  private async export(): Promise<void> {
    const [format, film] = [this.format.value, this.format.value === FILM ? this.film.order : null];
    const made = await ask<ExportItem>("POST", `dances/${this.item.id}/exports`, { format, film });
    if (made.state === "ready") save(made);
    else wanted.add(made.id);
    await this.store.refresh();
    saveWanted(this.store);
  }

  private rename(): void {
    renamed(this.item.name, async (name) => {
      await ask("PATCH", `dances/${this.item.id}`, { name });
      await this.store.refresh();
    });
  }

  private remove(): void {
    confirmed("Delete this dance?", `“${this.item.name}” and its exports go for good.`, "Delete", async () => {
      await ask("DELETE", `dances/${this.item.id}`);
      await this.store.refresh();
      go("start");
    });
  }

  private async act(does: () => Promise<void>): Promise<void> {
    try {
      await does();
    } catch (error) {
      notice(words(error), true);
    }
  }
}

/** A speed of the music in words, beside the one that is danced now. */
function pace(speed: number, now: number): string {
  if (Math.abs(speed - now) < 0.005) return "as it is";
  if (speed === 1) return "the song's own";
  return speed > now ? "faster" : "slower";
}

function section(title: string, ...parts: readonly HTMLElement[]): HTMLElement {
  return h("section", {}, h("h3", {}, title), ...parts);
}

function showWork(row: HTMLElement, job: JobItem): void {
  const shown = row.querySelector<HTMLElement>(".job");
  if (shown) showJob(shown, job);
  else row.replaceChildren(jobBar(job));
}

function writes({ who }: FormatItem, { robot }: DanceItem): boolean {
  if (who === "g1") return robot?.includes("g1") ?? false;
  return who === "all" || (who === "robots") === (robot !== null);
}

function size(bytes: number): string {
  return bytes < 1e6 ? `${Math.max(Math.round(bytes / 1e3), 1)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
}
