// The motion graph of a dance below its timeline: drawn while it is open.

import { Chords } from "../chords";
import { ClipColours } from "../colours";
import type { PageData } from "../contract";
import { Graph } from "../graph";
import { Tip } from "../tip";
import { h, say } from "./elements";
import type { Player } from "./player";

export class GraphView {
  readonly root: HTMLDetailsElement;
  private readonly graph: Graph;
  private readonly chords: Chords;
  private readonly here = h("p", { class: "soft" });

  constructor(
    private readonly scene: PageData,
    player: Player,
  ) {
    const canvas = h("canvas", { class: "chords", role: "img" });
    const box = h("div", { class: "tip", hidden: true });
    const colours = new ClipColours(scene.moves.map(({ clip }) => clip));
    const now = (): number => player.now(performance.now());
    this.graph = new Graph(scene);
    this.chords = new Chords(canvas, this.graph, scene, colours, (time) => player.seek(time), now, new Tip(box));
    this.root = h(
      "details",
      { class: "graph", hidden: !this.graph.possible },
      h("summary", { title: "Open or close it (G)" }, "Motion graph: the clips, their joins, and the way that is danced"),
      this.here,
      canvas,
      box,
    );
  }

  draw(time: number): void {
    if (!this.root.open || !this.graph.possible) return;
    this.chords.draw(time);
    const { move } = this.graph.here(time);
    const { moves } = this.scene;
    say(this.here, `Move ${move + 1} of ${moves.length}: ${moves[move].clip}. A click on a clip goes to where it is danced.`);
  }

  toggle(): void {
    this.root.open = !this.root.open;
    if (this.root.open) requestAnimationFrame(() => this.root.scrollIntoView({ block: "nearest" }));
  }
}
