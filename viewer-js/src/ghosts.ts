// The body at other times over the one of now: some beats before and after, or as it was before the time warp.

import * as THREE from "three";
import type { PageData, WarpData } from "./contract";
import { lastBefore } from "./data";
import { Dancer } from "./dancer";
import type { Places } from "./path";
import { Veil } from "./veil";

const BEATS = [1, 2, 4];
const OPACITY = 0.42;
const [BEFORE, AFTER, UNWARPED] = ["#3d76d8", "#e09a1f", "#7a6ad0"];
const BEAT = 0.5; // [s] where no beats are known

/** Which ghosts there are: none, those of so many beats, or that without the warp. */
export type Haunting = "off" | "warp" | number;

interface Ghost {
  dancer: Dancer;
  when: (time: number) => number;
}

export class Ghosts {
  readonly group = new THREE.Group();
  readonly choices: Haunting[];
  chosen: Haunting = "off";
  private shown: Ghost[] = [];
  private readonly bodies = new Map<string, Dancer>();

  constructor(
    private readonly page: PageData,
    private readonly places: Places,
  ) {
    this.choices = ["off", ...BEATS, ...(page.warp ? ["warp" as const] : [])];
  }

  choose(haunting: Haunting): void {
    this.chosen = haunting;
    const dressed = (colour: string, when: Ghost["when"]): Ghost => ({ dancer: this.body(colour), when });
    if (haunting === "off") this.shown = [];
    else if (haunting === "warp") this.shown = [dressed(UNWARPED, (time) => unwarped(this.page.warp as WarpData, time))];
    else {
      this.shown = [
        dressed(BEFORE, (time) => this.beatsFrom(time, -haunting)),
        dressed(AFTER, (time) => this.beatsFrom(time, haunting)),
      ];
    }
    this.group.clear();
    for (const { dancer } of this.shown) this.group.add(dancer.group);
  }

  next(): void {
    this.choose(this.choices[(this.choices.indexOf(this.chosen) + 1) % this.choices.length]);
  }

  pose(time: number): void {
    for (const { dancer, when } of this.shown) {
      const at = when(time);
      dancer.group.visible = at >= 0 && at <= this.page.duration;
      if (dancer.group.visible) dancer.pose(at);
    }
  }

  /** What the ghosts are, for the page's words. */
  static tell(haunting: Haunting): string {
    if (haunting === "off") return "off";
    return haunting === "warp" ? "without the warp" : `± ${haunting} beat${haunting > 1 ? "s" : ""}`;
  }

  private body(colour: string): Dancer {
    let dancer = this.bodies.get(colour);
    if (!dancer) {
      const capsules = this.page.capsules.map((capsule) => ({ ...capsule, colour }));
      dancer = new Dancer({ ...this.page, capsules }, this.places);
      new Veil(dancer).put(OPACITY);
      this.bodies.set(colour, dancer);
    }
    return dancer;
  }

  /** The time some beats away, between beats as far along as a time is between its own. */
  private beatsFrom(time: number, count: number): number {
    const { beats } = this.page;
    if (beats.length < 2) return time + count * BEAT;
    const low = Math.min(Math.max(lastBefore(beats, time), 0), beats.length - 2);
    const at = low + (time - beats[low]) / (beats[low + 1] - beats[low]) + count;
    const there = Math.min(Math.max(Math.floor(at), 0), beats.length - 2);
    return beats[there] + (at - there) * (beats[there + 1] - beats[there]);
  }
}

/** When the dance shows what it would show at a time had it not been warped. */
function unwarped({ times, before }: WarpData, time: number): number {
  const low = Math.min(Math.max(lastBefore(before, time), 0), before.length - 2);
  const part = (time - before[low]) / Math.max(before[low + 1] - before[low], 1e-9);
  return times[low] + Math.min(Math.max(part, 0), 1) * (times[low + 1] - times[low]);
}
