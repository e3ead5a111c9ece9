// A motion file: it plays, over its stops, keyposes and intensity.

import { ask, words } from "./api";
import type { MotionView as Seen } from "./contract";
import { button, h } from "./elements";
import { newLibrary } from "./library_dialog";
import { palette } from "./palette";
import { pending } from "./pending";
import { Score } from "./score";
import { StageTools } from "./stage_tools";
import { Transport } from "./transport";
import type { Studio, View } from "./view";
import { exactly, plainName, plural } from "./words";

export class MotionView implements View {
  readonly root = h("article", { class: "view motion" });
  title = "Motion";
  private score?: Score;
  private transport?: Transport;
  private stage?: StageTools;
  private asked = false;

  constructor(
    private readonly studio: Studio,
    private readonly id: string,
  ) {
    this.update();
  }

  update(): void {
    const item = this.studio.store.project?.motions.find(({ id }) => id === this.id);
    if (!item)
      return void this.root.replaceChildren(h("p", { class: "empty" }, "This motion is not in the project any more."));
    this.title = plainName(item.name);
    if (item.state !== "ready") return pending(this.root, this.studio.store, item, "This motion", "motions");
    if (!this.asked) void this.open();
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

  private async open(): Promise<void> {
    this.asked = true;
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
    const facts = [
      exactly(seen.seconds),
      `${Math.round(seen.fps)} frames a second`,
      seen.body,
      plural(seen.stops.length, "stop"),
      plural(seen.keyposes.length, "keypose"),
    ];
    this.root.replaceChildren(
      h(
        "header",
        { class: "head" },
        h(
          "div",
          {},
          h("h2", {}, plainName(seen.name)),
          h("p", { class: "facts" }, facts.filter(Boolean).join(" · ")),
          seen.note && h("details", { class: "note" }, h("summary", {}, "What was guessed of the file"), seen.note),
        ),
        h(
          "div",
          { class: "row" },
          button("Make a library with it", () => newLibrary(this.studio.store, [this.id]), { class: "text strong" }),
        ),
      ),
      h("div", { class: "looks" }, look.root, this.stage.root),
      this.transport.root,
      this.score.root,
    );
    look.show(seen.scene, "", `${seen.name}, moving`);
    this.stage.tell();
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
