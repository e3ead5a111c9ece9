// What else is drawn on the stage beside the dancer: where feet stand, and the body at other times.

import { Ghosts } from "../ghosts";
import { button, choice, h, offer } from "./elements";
import type { Look } from "./look";

export class StageTools {
  readonly root: HTMLElement;
  private readonly feet = button("Feet", () => this.toggleFeet(), { title: "Marks where feet stand (S)" });
  private readonly ghosts = choice([], "");

  constructor(private readonly looks: readonly Look[]) {
    this.ghosts.setAttribute("aria-label", "Ghosts");
    this.ghosts.title = "The body some beats before and after, or without the time warp (O)";
    this.ghosts.addEventListener("change", () => this.haunt());
    this.root = h("div", { class: "stage-tools", role: "group", "aria-label": "Drawn with the dancer" }, this.feet, this.ghosts);
    this.tell();
  }

  /** After another dancer came. */
  tell(): void {
    const [look] = this.looks;
    offer(
      this.ghosts,
      look.hauntings.map((one) => [String(one), one === "off" ? "no ghosts" : `ghosts: ${Ghosts.tell(one)}`]),
      String(look.haunting),
    );
    this.feet.hidden = !look.steps;
    this.feet.setAttribute("aria-pressed", String(look.feet));
  }

  key(event: KeyboardEvent): boolean {
    if (event.ctrlKey || event.metaKey || event.altKey) return false;
    const key = event.key.toLowerCase();
    if (key === "s") this.toggleFeet();
    else if (key === "o") {
      this.ghosts.selectedIndex = (this.ghosts.selectedIndex + 1) % this.ghosts.options.length;
      this.haunt();
    } else return false;
    return true;
  }

  private toggleFeet(): void {
    const shown = !this.looks[0].feet;
    for (const look of this.looks) look.feet = shown;
    this.feet.setAttribute("aria-pressed", String(shown));
  }

  private haunt(): void {
    const chosen = this.looks[0].hauntings.find((one) => String(one) === this.ghosts.value) ?? "off";
    for (const look of this.looks) look.haunt(chosen);
  }
}
