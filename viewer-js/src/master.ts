// Whom the dancer is held against: beside, over as a ghost, or hidden.

import * as THREE from "three";
import type { ComparedData, PageData } from "./contract";
import { Dancer } from "./dancer";

const PLACES = ["beside", "over", "hidden"] as const;
const APART = 0.85; // of the dancer's height
const GHOST = 0.42; // opacity

export type Place = (typeof PLACES)[number];

export class Master {
  place: Place = "beside";
  readonly dancer: Dancer;
  readonly shift = new THREE.Vector3(); // [m] from the dancer
  private readonly aside: THREE.Vector3;
  private readonly body: THREE.MeshStandardMaterial;

  constructor(compared: ComparedData, page: PageData, height: number) {
    this.body = new THREE.MeshStandardMaterial({ color: compared.body.capsules[0]?.colour, roughness: 0.7 });
    this.dancer = new Dancer({ ...page, ...compared.body }, undefined, this.body);
    // To the left of who looks at the dancer's front.
    this.aside = new THREE.Vector3(Math.cos(page.facing), Math.sin(page.facing), 0).multiplyScalar(APART * height);
    this.addDepth();
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
    this.dancer.group.position.copy(this.shift);
    this.dancer.group.visible = place !== "hidden";
    this.body.transparent = over;
    this.body.opacity = over ? GHOST : 1;
    this.body.needsUpdate = true;
    this.dancer.group.traverse((part) => {
      if (part instanceof THREE.Mesh && part.material === this.body) part.castShadow = !over;
      if (part.userData.depth) part.visible = over;
    });
  }

  /** A ghost's parts must not be seen through each other: all of them go to the depth buffer before they are drawn. */
  private addDepth(): void {
    const depth = new THREE.MeshBasicMaterial({ colorWrite: false, transparent: true });
    const parts: THREE.Mesh[] = [];
    this.dancer.group.traverse((part) => {
      if (part instanceof THREE.Mesh && part.visible) parts.push(part);
    });
    for (const part of parts) {
      const first = new THREE.Mesh(part.geometry, depth);
      first.renderOrder = 2; // after the ground
      first.frustumCulled = part.frustumCulled;
      first.userData.depth = true;
      part.renderOrder = 3;
      part.add(first);
    }
  }
}
