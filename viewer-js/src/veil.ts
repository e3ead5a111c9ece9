// A body that is seen through: as a ghost over or beside another one.

import * as THREE from "three";
import type { Dancer } from "./dancer";

type Part = THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial>;

export class Veil {
  private readonly parts: Part[] = [];

  constructor(dancer: Dancer) {
    dancer.group.traverse((part) => {
      if (part instanceof THREE.Mesh && part.visible) this.parts.push(part as Part);
    });
    this.addDepth();
    this.put(1);
  }

  /** How much of the body is seen: 1 for one that is there. */
  put(opacity: number): void {
    const veiled = opacity < 1;
    for (const part of this.parts) {
      Object.assign(part.material, { transparent: veiled, opacity, needsUpdate: true });
      part.castShadow = !veiled;
      for (const depth of part.children) depth.visible = veiled;
    }
  }

  /** A ghost's parts must not be seen through each other: all of them go to the depth buffer before they are drawn. */
  private addDepth(): void {
    const depth = new THREE.MeshBasicMaterial({ colorWrite: false, transparent: true });
    for (const part of this.parts) {
      const first = new THREE.Mesh(part.geometry, depth);
      first.renderOrder = 2; // after the ground
      first.frustumCulled = part.frustumCulled;
      part.renderOrder = 3;
      part.add(first);
    }
  }
}
