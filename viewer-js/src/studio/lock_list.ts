// The locked stretches in words, and dancing the rest again.

import { button, h } from "./elements";
import type { Locks } from "./locks";
import { exactly } from "./words";

export class LockList {
  readonly root: HTMLElement;
  private readonly list = h("ul", { class: "chips" });
  private readonly told = h("span", { class: "soft" });
  private readonly again: HTMLButtonElement;

  constructor(
    private readonly locks: Locks,
    again: () => void,
  ) {
    this.again = button("Dance the rest again", again, { class: "text strong" });
    this.root = h(
      "section",
      { class: "locks", "aria-label": "Locked stretches" },
      this.list,
      this.told,
      h("i", { class: "fill" }),
      this.again,
    );
    this.show();
  }

  show(): void {
    const { stretches } = this.locks;
    this.list.replaceChildren(
      ...stretches.map(({ from, to }, i) => {
        const words = `${exactly(from)}–${exactly(to)}`;
        return h(
          "li",
          {},
          `locked ${words}`,
          button("×", () => this.locks.remove(i), { "aria-label": `Unlock ${words}`, class: "" }),
        );
      }),
    );
    this.told.textContent = stretches.length
      ? ""
      : "Drag over the timeline, or press [ and ], to lock a stretch that you like.";
    this.again.hidden = !stretches.length;
  }
}
