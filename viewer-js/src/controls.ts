// What is pressed: the buttons, and the keys that do the same.

import type { Clicks } from "./clicks";
import type { Clock } from "./clock";
import type { PageData } from "./contract";
import { lastBefore } from "./data";
import { at, on, press } from "./elements";
import { Ghosts, type Haunting } from "./ghosts";
import type { GraphPanel } from "./graph_panel";
import { Help } from "./help";
import { type Key, type KeyGroup, listen, shutting } from "./keys";
import type { Keyposes } from "./keyposes";
import type { Loop } from "./loop";
import type { Marks } from "./marks";
import type { Panel } from "./panel";
import { type ViewName, VIEWS } from "./presets";
import { Speed } from "./speed";
import type { Stage } from "./stage";
import type { Timeline } from "./timeline";

const JUMP = 2; // [s]

/** What there is to press buttons for. */
export interface Parts {
  page: PageData;
  clock: Clock;
  stage: Stage;
  clicks: Clicks;
  keyposes: Keyposes;
  panel: Panel;
  timeline: Timeline;
  loop: Loop;
  marks: Marks;
  ghosts: Ghosts;
  graph: GraphPanel;
  theme: { dark: boolean; toggle(): void };
  seek(time: number): void;
  now(): number;
}

export class Controls {
  private readonly speed: Speed;
  private readonly help: Help;

  constructor(private readonly parts: Parts) {
    this.speed = new Speed(parts.clock, at<HTMLInputElement>("speed"), at("even"));
    this.wire();
    this.wireStage();
    this.fillLanes();
    for (const id of ["figures", "lanes"]) shutting(at<HTMLDetailsElement>(id));
    const groups = this.groups();
    this.help = new Help(at<HTMLDialogElement>("keyboard"), groups);
    listen(groups);
    this.tell();
  }

  /** Buttons say what is on. */
  tell(): void {
    const { stage, clicks, loop, marks, ghosts, graph, theme } = this.parts;
    for (const view of VIEWS) press(viewButton(view), stage.view === view && (view !== "follow" || stage.follow));
    press(at("clicks"), clicks.on);
    press(at("loop"), loop.on);
    press(at("feet"), marks.shown);
    press(at("roads"), graph.shown);
    press(at("dark"), theme.dark);
    at<HTMLSelectElement>("ghosts").value = String(ghosts.chosen);
  }

  toggle(): void {
    const { clock, loop, now, seek } = this.parts;
    if (clock.playing) return clock.pause();
    if (loop.on && loop.chosen && (now() < loop.from || now() >= loop.to)) seek(loop.from);
    clock.play();
  }

  private wire(): void {
    const { keyposes, clicks, timeline, loop, now, page } = this.parts;
    for (const id of ["play", "start"]) on(id, () => this.toggle());
    on("previous", () => keyposes.step(-1));
    on("next", () => keyposes.step(1));
    on("clicks", () => this.toggleClicks());
    on("master", () => this.nextMaster());
    on("from", () => loop.begin(now()));
    on("to", () => loop.end(now()));
    on("loop", () => loop.toggle(now()));
    on("nearer", () => timeline.view.nearer(now()));
    on("farther", () => timeline.view.farther(now()));
    on("earlier", () => this.stepMove(-1));
    on("later", () => this.stepMove(1));
    on("help", () => this.help.open());
    on("dark", () => this.parts.theme.toggle());
    at("clicks").hidden = !clicks.possible;
    at("looping").hidden = page.duration <= 0;
  }

  private wireStage(): void {
    const { marks, graph, ghosts, stage } = this.parts;
    for (const view of VIEWS) viewButton(view).addEventListener("click", () => (view === "follow" ? this.follow() : this.look(view)));
    at("scene").addEventListener("pointerup", () => this.tell());
    at("feet").hidden = !marks.possible;
    at("roads").hidden = !graph.possible;
    on("feet", () => this.toggleFeet());
    on("roads", () => this.toggleGraph());
    const select = at<HTMLSelectElement>("ghosts");
    select.append(...ghosts.choices.map((choice) => new Option(Ghosts.tell(choice), String(choice))));
    select.addEventListener("change", () => {
      const chosen = ghosts.choices.find((choice) => String(choice) === select.value) as Haunting;
      ghosts.choose(chosen);
      stage.renew();
      select.blur(); // so that keys are the page's again
    });
  }

  private fillLanes(): void {
    const { timeline } = this.parts;
    const list = at("lanes").querySelector("div") as HTMLElement;
    for (const track of timeline.tracks.filter(({ there, name }) => there && name !== "ruler")) {
      const [label, box] = [document.createElement("label"), document.createElement("input")];
      Object.assign(box, { type: "checkbox", checked: track.shown });
      box.addEventListener("change", () => {
        track.shown = box.checked;
        this.sizeLanes();
      });
      label.append(box, track.title);
      list.append(label);
    }
    at("lanes").hidden = !list.children.length;
    this.sizeLanes();
  }

  /** The detail strip is as tall as its lanes, of which the style may make less. */
  private sizeLanes(): void {
    const { timeline } = this.parts;
    const [only] = timeline.tracks.filter(({ there, shown }) => there && shown);
    at("detail").hidden = timeline.tracks.every(({ there, name }) => !there || name === "ruler" || name === "intensity") && only?.name === "ruler";
    document.body.style.setProperty("--lanes", `${timeline.tall}px`);
  }

  private look(view: ViewName): void {
    this.parts.stage.look(view);
    this.tell();
  }

  private follow(): void {
    this.parts.stage.toggleFollow();
    this.tell();
  }

  private toggleClicks(): void {
    if (this.parts.clicks.possible) this.parts.clicks.toggle();
    this.tell();
  }

  private toggleFeet(): void {
    const { marks, stage } = this.parts;
    marks.shown = !marks.shown;
    stage.renew();
    this.tell();
  }

  private toggleGraph(): void {
    const { graph } = this.parts;
    if (graph.possible) graph.shown = !graph.shown;
    this.tell();
  }

  private nextGhosts(): void {
    this.parts.ghosts.next();
    this.parts.stage.renew();
    this.tell();
  }

  private nextMaster(): void {
    const { stage, panel } = this.parts;
    if (!stage.master) return;
    stage.nextMaster();
    panel.tellPlace();
  }

  /** To the beginning of the next move, or of the one before; while it plays a move just begun counts as passed. */
  private stepMove(by: 1 | -1): void {
    const { page, clock, now, seek } = this.parts;
    const starts = page.moves.map((move) => move.at_s);
    const here = lastBefore(starts, now() + 0.001);
    const again = by < 0 && now() - starts[here] > (clock.playing ? 0.5 : 0.002) ? 1 : 0;
    const to = starts[Math.min(Math.max(here + by + again, 0), starts.length - 1)];
    if (to !== undefined) seek(to);
  }

  private groups(): KeyGroup[] {
    const { page, keyposes, clicks, marks, graph, stage } = this.parts;
    const only = (there: boolean, ...keys: Key[]): Key[] => (there ? keys : []);
    return [
      { title: "Time", keys: this.timeKeys() },
      { title: "Stretch and lanes", keys: this.stretchKeys() },
      {
        title: "Keyposes and moves",
        keys: [
          ...only(keyposes.possible,
            key(["[", "p"], "[ or p", "keypose before", () => keyposes.step(-1)),
            key(["]", "n"], "] or n", "next keypose", () => keyposes.step(1))),
          ...only(page.moves.length > 0,
            key(["{", "j"], "j", "move before", () => this.stepMove(-1)),
            key(["}", "k"], "k", "next move", () => this.stepMove(1))),
        ],
      },
      { title: "Camera", keys: this.viewKeys() },
      {
        title: "What is shown",
        keys: [
          ...only(marks.possible, key(["s"], "s", "feet that stand", () => this.toggleFeet())),
          key(["o"], "o", "ghosts", () => this.nextGhosts()),
          ...only(graph.possible, key(["g"], "g", "motion graph", () => this.toggleGraph())),
          ...only(stage.master !== undefined, key(["m"], "m", `the ${page.compared?.who}`, () => this.nextMaster())),
          ...only(clicks.possible, key(["c"], "c", "clicks on beats", () => this.toggleClicks())),
          key(["d"], "d", "dark or light", () => this.parts.theme.toggle()),
          key(["?"], "?", "these keys", () => this.help.open()),
        ],
      },
    ];
  }

  private timeKeys(): Key[] {
    const { page, seek, now } = this.parts;
    const frame = 1 / page.fps;
    return [
      key([" "], "space", "play or pause", () => this.toggle()),
      key(["ArrowLeft"], "←", `${JUMP} s back`, () => seek(now() - JUMP)),
      key(["ArrowRight"], "→", `${JUMP} s on`, () => seek(now() + JUMP)),
      key([","], ",", "one frame back", () => seek(now() - frame)),
      key(["."], ".", "one frame on", () => seek(now() + frame)),
      key(["Home"], "Home", "to the beginning", () => seek(0)),
      key(["End"], "End", "to the end", () => seek(page.duration)),
      key(["-"], "-", "slower", () => this.speed.step(-1)),
      key(["+", "="], "+", "faster", () => this.speed.step(1)),
      key(["0"], "0", "the song's own speed", () => this.speed.set(1)),
    ];
  }

  private stretchKeys(): Key[] {
    const { loop, timeline, now } = this.parts;
    return [
      key(["a"], "a", "loop begins here", () => loop.begin(now())),
      key(["b"], "b", "loop ends here", () => loop.end(now())),
      key(["l"], "l", "loop on or off", () => loop.toggle(now())),
      key(["ArrowUp"], "↑", "fewer seconds", () => timeline.view.nearer(now())),
      key(["ArrowDown"], "↓", "more seconds", () => timeline.view.farther(now())),
      key(["w"], "w", "the whole dance, or not", () => timeline.view.whole()),
    ];
  }

  private viewKeys(): Key[] {
    const words = ["from the front", "from the side", "from above", "with the dancer", "around the dancer"];
    const keys = VIEWS.map((view, i) => key([String(i + 1)], String(i + 1), words[i], () => this.look(view)));
    return [...keys, key(["f"], "f", "follow or stand still", () => this.follow())];
  }
}

function key(keys: string[], told: string, words: string, action: () => void): Key {
  return { keys, told, words, press: action };
}

function viewButton(view: ViewName): HTMLElement {
  return document.querySelector(`[data-view=${view}]`) as HTMLElement;
}
