// Marks on the floor under feet that stand; they fade when the foot has left.

import * as THREE from "three";
import type { StepData } from "./contract";
import { lastBefore } from "./data";
import { paint } from "./palette";

const KEPT = 3; // [s] that a mark is seen after its foot has left
const MOST = 24; // marks at one time
const WIDE = 0.36; // of a sole's length
const RIM = 1.14; // of the sole, how large its edge is
const [STANDS, LEFT] = [0.55, 0.2]; // opacity of a sole
const [EDGE, EDGE_LEFT] = [1, 0.6];
const ROUND = 12; // corners of each end

interface Mark {
  sole: THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>;
  edge: THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>;
}

export class Marks {
  readonly group = new THREE.Group();
  private readonly starts: number[];
  private readonly longest: number; // [s] that a foot stands
  private readonly pool: Mark[];

  constructor(
    private readonly steps: readonly StepData[],
    floor: number,
  ) {
    this.starts = steps.map((step) => step.from_s);
    this.longest = Math.max(0, ...steps.map((step) => step.to_s - step.from_s));
    this.pool = Array.from({ length: Math.min(MOST, steps.length) }, mark);
    for (const { sole, edge } of this.pool) this.group.add(sole, edge);
    this.group.position.z = floor + 0.003;
  }

  get possible(): boolean {
    return this.steps.length > 0;
  }

  get shown(): boolean {
    return this.group.visible;
  }

  set shown(shown: boolean) {
    this.group.visible = shown;
  }

  /** Which feet stand at a time. */
  standing(time: number): StepData[] {
    return this.since(time - this.longest, time).filter((step) => time < step.to_s);
  }

  pose(time: number): void {
    if (!this.shown) return;
    const now = this.since(time - KEPT - this.longest, time).filter((step) => time < step.to_s + KEPT).slice(-MOST);
    this.pool.forEach((mark, i) => this.put(mark, now[i], time));
  }

  private since(from: number, to: number): StepData[] {
    return this.steps.slice(lastBefore(this.starts, from) + 1, lastBefore(this.starts, to) + 1);
  }

  private put({ sole, edge }: Mark, step: StepData | undefined, time: number): void {
    for (const part of [sole, edge]) part.visible = step !== undefined;
    if (!step) return;
    const stands = time < step.to_s;
    const fresh = stands ? 1 : 1 - (time - step.to_s) / KEPT;
    for (const part of [sole, edge]) {
      part.position.set(step.x, step.y, 0);
      part.rotation.z = step.yaw;
      part.scale.set(Math.max(step.length, 0.1), step.length, 1);
      part.material.color.set(step.foot === "left" ? paint.left : paint.right);
    }
    sole.material.opacity = (stands ? STANDS : LEFT) * fresh;
    edge.material.opacity = (stands ? EDGE : EDGE_LEFT) * fresh;
  }
}

/** A sole of length 1 along y: rounder and wider before than behind. */
function mark(): Mark {
  const points: THREE.Vector2[] = [];
  const [front, back] = [WIDE / 2, WIDE * 0.38];
  for (let i = 0; i <= ROUND; i++) {
    const turn = (Math.PI * i) / ROUND;
    points.push(new THREE.Vector2(front * Math.cos(turn), 0.5 - front + front * Math.sin(turn)));
  }
  for (let i = 0; i <= ROUND; i++) {
    const turn = Math.PI + (Math.PI * i) / ROUND;
    points.push(new THREE.Vector2(back * Math.cos(turn), back - 0.5 + back * Math.sin(turn)));
  }
  const ring = new THREE.Shape(points.map((point) => point.clone().multiplyScalar(RIM)));
  ring.holes.push(new THREE.Path(points));
  const shapes = [new THREE.Shape(points), ring].map((shape) => new THREE.ShapeGeometry(shape));
  const [sole, edge] = shapes.map((shape) => {
    const material = new THREE.MeshBasicMaterial({ transparent: true, depthWrite: false, side: THREE.DoubleSide });
    return new THREE.Mesh(shape, material);
  });
  sole.renderOrder = edge.renderOrder = 2; // after the ground
  return { sole, edge };
}
