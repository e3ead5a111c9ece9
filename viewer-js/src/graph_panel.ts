// The panel of the motion graph beside the dancer: its picture, where the dance is in it, and how much of it is drawn.

import { Chords } from "./chords";
import type { ClipColours } from "./colours";
import type { PageData } from "./contract";
import { at, text } from "./elements";
import { Graph } from "./graph";
import type { Tip } from "./tip";
import * as words from "./words";

export class GraphPanel {
  private readonly graph: Graph;
  private readonly chords: Chords;
  private told = "";

  constructor(
    private readonly page: PageData,
    colours: ClipColours,
    seek: (time: number) => void,
    now: () => number,
    tip: Tip,
  ) {
    this.graph = new Graph(page);
    this.chords = new Chords(at<HTMLCanvasElement>("chords"), this.graph, page, colours, seek, now, tip);
    text("drawn", this.drawn());
  }

  /** Bands under two that are compared are no clips. */
  get possible(): boolean {
    return this.graph.possible && !this.page.compared;
  }

  get shown(): boolean {
    return !at("graph").hidden;
  }

  set shown(shown: boolean) {
    at("graph").hidden = !shown;
    document.body.classList.toggle("graphed", shown);
  }

  draw(time: number): void {
    if (!this.shown) return;
    this.chords.draw(time);
    const { move } = this.graph.here(time);
    const said = `Move ${move + 1} of ${this.page.moves.length}: ${words.clip(this.page, move)}`;
    if (said === this.told) return;
    this.told = said;
    text("road", said);
  }

  private drawn(): string {
    const { arcs, sample, path, total } = this.graph;
    const count = (part: number, whole: number, what: string): string =>
      part < whole ? `${part.toLocaleString("en")} of ${whole.toLocaleString("en")} ${what}` : `${whole.toLocaleString("en")} ${what}`;
    const joins = this.page.graph ? `, ${count(sample.length, total.joins, "joins")}` : "";
    return `Drawn: ${count(arcs.length, total.clips, "clips")}${joins}; ${path.length} danced.`;
  }
}
