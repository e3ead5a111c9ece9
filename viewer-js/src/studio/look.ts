// A stage with one dancer. Browsers give few of them to a page, so that each is kept and other dancers come onto it.

import type { PageData } from "../contract";
import { lastBefore } from "../data";
import { Dancer } from "../dancer";
import { Ghosts, type Haunting } from "../ghosts";
import { Marks } from "../marks";
import { type Places, StoredPath } from "../path";
import { reachOf, type ViewName } from "../presets";
import { Stage } from "../stage";
import { words } from "./api";
import { h, say } from "./elements";

const TURNED = 0.15; // a change of the picture's shape after which the camera is placed anew

/** A body's places as all stages have them: the ground at height 0, and at first it faces +Y. */
class Turned implements Places {
  private readonly places: StoredPath;
  private readonly cos: number;
  private readonly sin: number;

  constructor(private readonly scene: PageData) {
    this.places = new StoredPath(scene);
    [this.cos, this.sin] = [Math.cos(scene.facing), Math.sin(scene.facing)];
  }

  read(time: number, into: Float32Array): void {
    this.places.read(time, into);
    for (let i = 0; i < into.length; i += 3) {
      const [x, y] = [into[i], into[i + 1]];
      into[i] = this.cos * x + this.sin * y;
      into[i + 1] = this.cos * y - this.sin * x;
      into[i + 2] -= this.scene.floor;
    }
  }
}

const LEAP = 0.5; // [s] from one picture to the next, from which on somebody sought

export class Look {
  readonly root: HTMLElement;
  private readonly canvas = h("canvas", { class: "scene", role: "img" });
  private readonly caption = h("figcaption", { hidden: true });
  private readonly problem = h("p", { class: "problem", role: "alert", hidden: true });
  private stage?: Stage;
  private scene?: PageData;
  private shape = 0; // of the picture when the camera was placed
  private placed = true; // whether the camera was placed by the picture's shape of now
  private night = false;
  private marks?: Marks;
  private ghosts?: Ghosts;
  private standing = true;
  private told = ""; // who is seen
  private drawn = 0; // [s] what was drawn last
  view: ViewName = "follow";

  constructor() {
    this.root = h("figure", { class: "look" }, this.canvas, this.caption, this.problem);
  }

  /** The joints as last drawn [m], for scripts and tests. */
  get joints(): number[] {
    return Array.from(this.stage?.dancer.joints ?? []);
  }

  set dark(dark: boolean) {
    this.night = dark;
    if (this.stage) this.stage.dark = dark;
  }

  /** Whether marks are drawn where feet stand. */
  get feet(): boolean {
    return this.standing;
  }

  set feet(shown: boolean) {
    this.standing = shown;
    if (this.marks) this.marks.shown = shown;
    this.stage?.renew();
  }

  /** Whether it is known where feet stand. */
  get steps(): boolean {
    return (this.scene?.steps.length ?? 0) > 0;
  }

  get hauntings(): readonly Haunting[] {
    return this.ghosts?.choices ?? ["off"];
  }

  get haunting(): Haunting {
    return this.ghosts?.chosen ?? "off";
  }

  /** The body at other times, over the one of now. */
  haunt(haunting: Haunting): void {
    const { ghosts } = this;
    ghosts?.choose(ghosts.choices.includes(haunting) ? haunting : "off");
    this.stage?.renew();
  }

  /** Where the camera looks from. */
  look(view: ViewName): void {
    this.view = view;
    this.stage?.look(view);
    this.tell();
  }

  private tell(): void {
    const words = `${this.told}, seen by the camera “${this.view}”. Drag to look around, scroll to come closer; V changes the camera.`;
    this.canvas.setAttribute("aria-label", words);
  }

  /** Another dancer comes; `name` stands under it where there are two. */
  show(scene: PageData, name: string, told: string): void {
    this.scene = scene;
    this.ghosts = undefined;
    say(this.caption, name);
    this.caption.hidden = name === "";
    this.told = told;
    this.tell();
    this.dress();
  }

  clear(): void {
    this.scene = undefined;
  }

  draw(time: number, seconds: number, playing: boolean): void {
    const { scene } = this;
    if (!scene || !this.canvas.clientWidth || !this.canvas.isConnected) return;
    const shape = this.canvas.clientWidth / this.canvas.clientHeight;
    if (Math.abs(Math.log(shape / (this.shape || shape))) > TURNED || !this.shape) this.dress();
    if (!this.placed) requestAnimationFrame(() => this.stage?.look(this.view, true)); // the picture has its new shape then
    this.placed = true;
    const at = Math.min(Math.max(time, 0), scene.duration);
    const beat = lastBefore(scene.beats, at);
    const since = beat < 0 ? 9 : at - scene.beats[beat];
    const down = beat >= 0 && scene.downbeats.some((start) => Math.abs(start - scene.beats[beat]) < 0.01);
    if (Math.abs(at - this.drawn) > LEAP) this.stage?.jump(); // the camera does not glide after a dancer who was elsewhere
    this.drawn = at;
    this.stage?.draw(at, seconds, since, playing ? (down ? 1 : 0.55) : 0);
  }

  private dress(): void {
    const { scene, canvas } = this;
    if (!scene || !canvas.isConnected || !canvas.clientHeight) return;
    this.shape = canvas.clientWidth / canvas.clientHeight;
    try {
      const places = new Turned(scene);
      const dancer = new Dancer({ ...scene, floor: 0 }, places);
      const tall = this.stage ? undefined : dancer.standing(scene.duration); // a camera that was moved stays there
      if (this.stage) this.stage.replace(dancer);
      else this.stage = new Stage(canvas, { floor: 0, facing: 0 }, dancer);
      this.stage.survey(reachOf(places, scene.joints.length, scene.spine[0], scene.duration, 0), tall);
      this.stage.look(this.view, true);
      this.placed = false;
      this.furnish(scene, places);
      this.stage.dark = this.night;
      this.problem.hidden = true;
    } catch (error) {
      this.problem.textContent = words(error);
      this.problem.hidden = false;
      this.scene = undefined;
    }
  }

  /** What is drawn beside the dancer, as it was before where it is the same scene. */
  private furnish(scene: PageData, places: Places): void {
    const before = this.haunting;
    this.marks = new Marks(scene.steps, 0);
    this.marks.group.rotation.z = -scene.facing;
    this.marks.shown = this.standing;
    this.ghosts = new Ghosts({ ...scene, floor: 0 }, places);
    this.stage?.bare();
    this.stage?.add(this.marks);
    this.stage?.add(this.ghosts);
    this.haunt(before);
  }
}
