// Whom the dancer is held against: beside, over as a ghost, or hidden.

import * as THREE from "three";
import type { ComparedData, PageData } from "./contract";
import { Dancer } from "./dancer";
import { StoredPath } from "./path";
import { Veil } from "./veil";

const PLACES = ["beside", "over", "hidden"] as const;
const APART = 0.85; // of the dancer's height
const GHOST = 0.42; // opacity

export type Place = (typeof PLACES)[number];

export class Master {
  place: Place = "beside";
  readonly dancer: Dancer;
  readonly shift = new THREE.Vector3(); // [m] from the dancer
  readonly tall: number; // [m]
  private readonly aside: THREE.Vector3;
  private readonly veil: Veil;
  private readonly size: number; // of a ghost
  private readonly began: THREE.Vector3; // [m] about which it has that size

  constructor(compared: ComparedData, page: PageData, height: number) {
    this.dancer = new Dancer({ ...compared.body, floor: page.floor }, new StoredPath({ ...page, ...compared.body }));
    // To the left of who looks at the dancer's front.
    const apart = compared.apart || APART * height;
    this.aside = new THREE.Vector3(Math.cos(page.facing), Math.sin(page.facing), 0).multiplyScalar(apart);
    this.veil = new Veil(this.dancer);
    // What is compared joint by joint has its own size; another body shows its pose best as large as the dancer.
    this.tall = this.dancer.standing(page.duration);
    this.size = compared.heat ? 1 : height / this.tall;
    this.began = this.dancer.centre.clone().setZ(page.floor);
    this.put("beside");
  }

  next(): void {
    this.put(PLACES[(PLACES.indexOf(this.place) + 1) % PLACES.length]);
  }

  pose(time: number): void {
    if (this.place !== "hidden") this.dancer.pose(time);
  }

  /** Where its capsules end on the stage, for its shade on the ground; none of a ghost. */
  ends(): THREE.Vector4[] {
    if (this.place !== "beside") return [];
    const { x, y } = this.shift;
    return this.dancer.ends.map((end) => new THREE.Vector4(end.x + x, end.y + y, end.z, end.w));
  }

  private put(place: Place): void {
    this.place = place;
    const over = place === "over";
    this.shift.copy(this.aside).multiplyScalar(place === "beside" ? 1 : 0);
    const size = over ? this.size : 1;
    this.dancer.group.scale.setScalar(size);
    this.dancer.group.position.copy(this.began).multiplyScalar(1 - size).add(this.shift);
    this.dancer.group.visible = place !== "hidden";
    this.veil.put(over ? GHOST : 1);
  }
}
