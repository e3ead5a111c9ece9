// Where the camera looks from: the whole floor from the front, the side or above, or the dancer as it goes.

import * as THREE from "three";
import type { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Places } from "./path";

export const VIEWS = ["front", "side", "top", "follow", "orbit"] as const;
export type ViewName = (typeof VIEWS)[number];

const QUICK = 6; // [1/s] how fast the camera comes to where it is wanted
const THERE = 0.002; // [rad], and parts of the distance
const ROUND = 0.32; // [rad/s] of an orbit
const ASIDE = 0.42; // [rad] off the front, when the camera goes with the dancer
const [LEVEL, UP] = [1.37, 0.02]; // [rad] off the vertical, from the side and from above

/** Where the dancer is over the whole dance. */
export interface Reach {
  middle: THREE.Vector3; // on the ground
  radius: number; // [m]
}

/** Where the camera is, about what it looks at: `yaw` as a body's, 0 along +Y. */
interface Spot {
  yaw: number;
  polar: number;
  away: number;
}

/** The reach of a path's point over a dance of so many seconds. */
export function reachOf(places: Places, points: number, point: number, duration: number, floor: number): Reach {
  const [box, here, all] = [new THREE.Box3(), new THREE.Vector3(), new Float32Array(3 * points)];
  const looks = 200;
  for (let i = 0; i <= looks; i++) {
    places.read((duration * i) / looks, all);
    box.expandByPoint(here.fromArray(all, 3 * point));
  }
  const size = box.getSize(new THREE.Vector3());
  return { middle: box.getCenter(new THREE.Vector3()).setZ(floor), radius: Math.hypot(size.x, size.y) / 2 };
}

export class Presets {
  private current: ViewName = "follow";
  reach?: Reach;
  private goal?: Spot;
  private moved = false; // by hand
  private readonly still = matchMedia("(prefers-reduced-motion: reduce)");

  constructor(
    private readonly camera: THREE.PerspectiveCamera,
    private readonly controls: OrbitControls,
    private readonly facing: number,
  ) {
    controls.addEventListener("start", () => this.grabbed());
  }

  /** Where the camera looks from; undefined where somebody turned it to look from elsewhere. */
  get view(): ViewName | undefined {
    return this.moved && !this.goes ? undefined : this.current;
  }

  /** Whether the camera goes with the dancer. */
  get goes(): boolean {
    return this.current === "follow" || this.current === "orbit";
  }

  /** Looks from another place; `room` is how far away the dancer alone fills the picture. */
  choose(view: ViewName, room: number): void {
    this.current = view;
    this.moved = false;
    const away = this.goes ? room : room + this.spread();
    const yaw = { front: this.facing, side: this.facing - Math.PI / 2, top: this.facing, follow: this.facing + ASIDE, orbit: this.spot().yaw };
    const polar = { front: LEVEL, side: LEVEL, top: UP, follow: LEVEL, orbit: LEVEL };
    this.goal = { yaw: yaw[view], polar: polar[view], away };
    this.controls.maxPolarAngle = Math.PI / 2 - 0.02;
  }

  /** What the camera looks at from the front, side and top; undefined where it goes with the dancer. */
  get fixed(): THREE.Vector3 | undefined {
    return this.goes ? undefined : this.reach?.middle;
  }

  /** Moves the camera on; true while it is on its way. */
  update(seconds: number): boolean {
    const round = this.current === "orbit" && !this.still.matches ? ROUND * seconds : 0;
    if (!this.goal && !round) return false;
    const here = this.spot();
    if (this.goal) {
      const part = this.still.matches ? 1 : 1 - Math.exp(-QUICK * seconds);
      const turn = Math.atan2(Math.sin(this.goal.yaw - here.yaw), Math.cos(this.goal.yaw - here.yaw));
      const [tilt, away] = [this.goal.polar - here.polar, this.goal.away / here.away];
      if (Math.abs(turn) + Math.abs(tilt) + Math.abs(away - 1) < THERE) this.goal = undefined;
      this.put({ yaw: here.yaw + part * turn, polar: here.polar + part * tilt, away: here.away * away ** part });
    } else this.put({ ...here, yaw: here.yaw + round });
    return true;
  }

  /** Goes at once to where it is on its way to. */
  arrive(): void {
    if (this.goal) this.put(this.goal);
    this.goal = undefined;
  }

  private spread(): number {
    const half = Math.tan(((this.camera.fov / 2) * Math.PI) / 180);
    return (0.8 * (this.reach?.radius ?? 0)) / half / Math.min(this.camera.aspect, 1.4);
  }

  /** Who takes hold of the camera has it for themselves. */
  private grabbed(): void {
    this.goal = undefined;
    this.moved = true;
    if (this.current === "orbit") this.current = "follow";
  }

  private spot(): Spot {
    const out = this.camera.position.clone().sub(this.controls.target);
    const away = Math.max(out.length(), 1e-6);
    return { yaw: Math.atan2(-out.x, out.y), polar: Math.acos(Math.min(Math.max(out.z / away, -1), 1)), away };
  }

  private put({ yaw, polar, away }: Spot): void {
    const flat = Math.sin(polar) * away;
    const out = new THREE.Vector3(-Math.sin(yaw) * flat, Math.cos(yaw) * flat, Math.cos(polar) * away);
    this.camera.position.copy(this.controls.target).add(out);
    this.camera.lookAt(this.controls.target);
  }
}
