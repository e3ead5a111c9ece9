// A motion file: it plays, over its stops, keyposes and intensity.

import { ask, words } from "./api";
import type { MotionItem, MotionView as Seen } from "./contract";
import { button, h, say } from "./elements";
import { newLibrary } from "./library_dialog";
import { notice } from "./notices";
import { palette } from "./palette";
import { pending } from "./pending";
import { isGuessed, otherRate, rateForm, rateInWords } from "./rate_form";
import { Score } from "./score";
import { StageTools } from "./stage_tools";
import { Transport } from "./transport";
import type { Studio, View } from "./view";
import { exactly, isSkeleton, plainName, plural } from "./words";

export class MotionView implements View {
  readonly root = h("article", { class: "view motion" });
  title = "Motion";
  private score?: Score;
  private transport?: Transport;
  private stage?: StageTools;
  private asked = false;
  private found = ""; // what is seen in it, in words
  private readonly facts = h("p", { class: "facts" });
  private readonly rate = h("div", {});
  private readonly other = button("Another rate", () => this.item && otherRate(this.studio.store, this.item), {
    title: "Another frame rate than the file's",
  });

  constructor(
    private readonly studio: Studio,
    private readonly id: string,
  ) {
    this.update();
  }

  private get item(): MotionItem | undefined {
    return this.studio.store.project?.motions.find(({ id }) => id === this.id);
  }

  update(): void {
    const { item } = this;
    if (!item)
      return void this.root.replaceChildren(h("p", { class: "empty" }, "This motion is not in the project any more."));
    this.title = plainName(item.name);
    if (item.lacks) return this.wait(item);
    if (item.state !== "ready") {
      this.asked = false; // it is read again
      const rate = item.state === "failed" ? rateForm(this.studio.store, item) : undefined;
      return pending(this.root, this.studio.store, item, "This motion", "motions", rate);
    }
    if (!this.asked) void this.open();
    else this.tell(item);
  }

  frame(time: number, seconds: number): void {
    this.transport?.update(time);
    this.studio.looks[0].draw(time, seconds, this.studio.player.playing);
    this.score?.track.draw(time, this.studio.player.playing);
  }

  key(event: KeyboardEvent): boolean {
    return (this.stage?.key(event) || this.score?.track.key(event) || this.transport?.key(event)) ?? false;
  }

  dim(): void {
    this.score?.track.stale();
  }

  /** One half of a motion waits for the other. */
  private wait(item: MotionItem): void {
    const all = (this.studio.store.project?.motions ?? []).filter(({ name }) => isSkeleton(name));
    const skeletons = [...new Map(all.map((one) => [one.name, one])).values()]; // of each name the newest
    const told = JSON.stringify([item.lacks, skeletons]);
    if (this.root.dataset.told === told) return;
    this.root.dataset.told = told;
    const use = (skeleton: MotionItem) => button(`Read it with ${skeleton.name}`, () => void this.choose(skeleton.id));
    const more = isSkeleton(item.name)
      ? "Drop them whenever you like: they are read with it then. For a motion of another name it can be chosen on that motion's page."
      : "It is read as soon as its .asf file is dropped, called as the motion is or as its name begins.";
    this.root.replaceChildren(
      h(
        "div",
        { class: "pending" },
        h("h2", {}, item.name),
        h("p", { role: "status" }, `${item.lacks[0].toUpperCase()}${item.lacks.slice(1)}.`),
        h("p", {}, more),
        !isSkeleton(item.name) && skeletons.length > 0 && h("div", { class: "row" }, ...skeletons.map(use)),
      ),
    );
  }

  private async choose(skeleton: string): Promise<void> {
    try {
      await ask("PUT", `motions/${this.id}/skeleton`, { skeleton });
      await this.studio.store.refresh();
    } catch (error) {
      notice(words(error), true);
    }
  }

  private async open(): Promise<void> {
    this.asked = true;
    delete this.root.dataset.told;
    try {
      this.show(await ask<Seen>("GET", `motions/${this.id}`));
    } catch (error) {
      this.asked = false;
      this.root.replaceChildren(h("p", { class: "problem", role: "alert" }, words(error)));
    }
  }

  private show(seen: Seen): void {
    const { player, looks } = this.studio;
    const [look] = looks;
    player.load({ url: null, start: 0, speed: 1, duration: seen.seconds });
    this.score = new Score(withFindings(seen), player, undefined, () => palette(this.studio.dark()));
    this.transport = new Transport(player, { looks: [look] });
    this.stage = new StageTools([look]);
    const facts = [seen.body, plural(seen.stops.length, "stop"), plural(seen.keyposes.length, "keypose")];
    this.found = facts.filter(Boolean).join(" · ");
    this.root.replaceChildren(
      h(
        "header",
        { class: "head" },
        h(
          "div",
          {},
          h("h2", {}, plainName(seen.name)),
          this.facts,
          seen.note && h("details", { class: "note" }, h("summary", {}, "What was guessed of the file"), seen.note),
        ),
        h(
          "div",
          { class: "row" },
          this.other,
          button("Make a library with it", () => newLibrary(this.studio.store, [this.id]), { class: "text strong" }),
        ),
      ),
      this.rate,
      h("div", { class: "looks" }, look.root, this.stage.root),
      this.transport.root,
      this.score.root,
    );
    look.show(seen.scene, "", `${seen.name}, moving`);
    this.stage.tell();
    const item = this.item;
    if (item) this.tell(item);
  }

  /** Its rate, which may have to be asked for. */
  private tell(item: MotionItem): void {
    if (!this.found) return;
    const { store } = this.studio;
    say(this.facts, [exactly(item.seconds), rateInWords(item), this.found].join(" · "));
    this.other.hidden = !item.rate_stored || item.rate !== null;
    const guessed = (store.project?.motions ?? []).filter(isGuessed).length;
    const shown = JSON.stringify([item.fps, item.rate, item.rate_stored, guessed]);
    if (this.rate.dataset.told === shown) return;
    this.rate.dataset.told = shown;
    const form = rateForm(store, item);
    this.rate.replaceChildren(...(form ? [form] : []));
    this.rate.hidden = !form;
  }
}

/** The scene with what was found in the motion, whatever the scene itself says. */
function withFindings(seen: Seen): Seen["scene"] {
  const keyposes = seen.keyposes.map((time, i) => ({ time, number: i + 1, beat: 0, source: "global", facing: 0 }));
  return {
    ...seen.scene,
    stops: seen.stops,
    keyposes: seen.scene.keyposes.length ? seen.scene.keyposes : keyposes,
    motion_intensity: seen.intensity,
  };
}
