// The motion graph of a dance below its timeline: drawn while it is open.

import { Chords } from "../chords";
import { ClipColours } from "../colours";
import type { PageData } from "../contract";
import { Graph } from "../graph";
import { Tip } from "../tip";
import { h, say } from "./elements";
import type { Player } from "./player";
import { plural } from "./words";

export class GraphView {
  readonly root: HTMLDetailsElement;
  private readonly graph: Graph;
  private readonly chords: Chords;
  private readonly canvas = h("canvas", { class: "chords", role: "img" });
  private named = -1; // the move that its words tell
  private readonly here = h("p", { class: "soft" });

  constructor(
    private readonly scene: PageData,
    player: Player,
  ) {
    const box = h("div", { class: "tip", hidden: true });
    const colours = new ClipColours(scene.moves.map(({ clip }) => clip));
    const now = (): number => player.now(performance.now());
    this.graph = new Graph(scene);
    this.chords = new Chords(this.canvas, this.graph, scene, colours, (time) => player.seek(time), now, new Tip(box));
    if (this.graph.possible) this.name(0);
    this.root = h(
      "details",
      { class: "graph", hidden: !this.graph.possible },
      h("summary", { title: "Open or close it (G)" }, "Motion graph: the clips, their joins, and the way that is danced"),
      this.here,
      this.canvas,
      box,
    );
  }

  draw(time: number): void {
    if (!this.root.open || !this.graph.possible) return;
    this.chords.draw(time);
    const { move } = this.graph.here(time);
    const { moves } = this.scene;
    this.name(move);
    say(this.here, `Move ${move + 1} of ${moves.length}: ${moves[move].clip}. A click on a clip goes to where it is danced.`);
  }

  /** The picture in words, which change with the move that is danced. */
  private name(move: number): void {
    if (move === this.named) return;
    this.named = move;
    const { moves } = this.scene;
    const { arcs, total } = this.graph;
    const joins = total.joins.toLocaleString("en");
    const words = [
      `The motion graph of ${plural(total.clips, "clip")} and ${joins} joins, of which ${arcs.length} clips are drawn`,
      `the dance goes through ${plural(new Set(moves.map(({ clip }) => clip)).size, "clip")} in ${plural(moves.length, "move")}`,
      `now move ${move + 1}, ${moves[move].clip}${moves[move + 1] ? `, then ${moves[move + 1].clip}` : ", the last"}`,
    ];
    this.canvas.setAttribute("aria-label", `${words.join("; ")}.`);
  }

  toggle(): void {
    this.root.open = !this.root.open;
    if (this.root.open) requestAnimationFrame(() => this.root.scrollIntoView({ block: "nearest" }));
  }
}
