// What is seen first: what to do, and a dance at once for who has nothing at hand.

import { ask, words } from "./api";
import type { DanceItem, DanceOrder } from "./contract";
import { button, h } from "./elements";
import { notice } from "./notices";
import { go, type Studio, type View } from "./view";

const FIRST: DanceOrder = {
  song: "song",
  library: "troupe",
  start: 0,
  seconds: 20,
  method: "optimal",
  seed: 0,
  intensity_weight: 1,
  robot: null,
  speed: 1,
  keep: [],
  name: "",
};

export class StartView implements View {
  readonly title = "Start";
  readonly root: HTMLElement;

  constructor(
    private readonly studio: Studio,
    choose: () => void,
  ) {
    const steps = [
      [
        "Drop a song and motion files anywhere on this page.",
        "wav, mp3, flac, ogg · BVH, AMC, C3D, npz, CSV, or a zip of them",
      ],
      ["Look at what was heard and seen.", "Put beats right where they are wrong; make a library of your motions"],
      [
        "Press New, and see it danced.",
        "Lock what you like, dance the rest again, put it on a robot, take it away as a file",
      ],
    ];
    this.root = h(
      "article",
      { class: "view start" },
      h("h2", {}, "A song and some moves in, a dance on the music out"),
      h("ol", {}, ...steps.map(([what, more]) => h("li", {}, h("b", {}, what), h("span", { class: "soft" }, more)))),
      h(
        "div",
        { class: "row" },
        button("Choose files", choose, { class: "text strong big" }),
        button("Nothing at hand? Dance with what is here", () => void this.dance(), { class: "text big" }),
      ),
    );
    studio.player.load({ url: null, start: 0, speed: 1, duration: 0 });
  }

  update(): void {
    // it says the same whatever is in the project
  }

  private async dance(): Promise<void> {
    try {
      const made = await ask<DanceItem>("POST", "dances", FIRST);
      await this.studio.store.refresh();
      go("dance", made.id);
    } catch (error) {
      notice(words(error), true);
    }
  }
}
