// A dark or a light room: the page's style, what is painted, and the stage.

import { Theme } from "./live/theme";
import { dim } from "./palette";
import type { Panel } from "./panel";
import type { Stage } from "./stage";

export class Room {
  changed: () => void = () => {};
  private readonly theme: Theme;

  constructor(
    private readonly stage: Stage,
    private readonly panel: Panel,
  ) {
    this.theme = new Theme(() => this.repaint());
  }

  get dark(): boolean {
    return document.documentElement.dataset.theme === "dark";
  }

  toggle(): void {
    this.theme.toggle();
  }

  private repaint(): void {
    dim(this.dark);
    this.stage.dark = this.dark;
    this.panel.repaint();
    this.changed();
  }
}
