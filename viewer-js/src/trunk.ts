// The trunk as one skin around its capsules: rays from the spine end where the capsules, softly merged, begin.

import * as THREE from "three";
import type { Heat } from "./heat";

const AROUND = 40;
const ALONG = 20; // rows from the hem to the neck
const CAP = 8; // rows that close the skin at the neck; one point closes it inside the trousers
const ROWS = 1 + ALONG + CAP;
const HEM = 0.37; // the shirt ends so far above the line through both hips, in radii of the hips
const SOFT = 0.17; // how softly capsules merge, in radii of the hips
const NEAR = 0.0015; // [m]
const MARGIN = 0.04; // [m] a ray starts so far outside of where it last ended

export interface Tube {
  a: THREE.Vector3;
  b: THREE.Vector3;
  radiusA: number;
  radiusB: number;
}

export class Trunk {
  readonly mesh: THREE.Mesh;
  private readonly points: Float32Array;
  private readonly normals: Float32Array;
  private readonly colours = new Float32Array(ROWS * AROUND * 3).fill(1);
  private readonly tint = new THREE.Color();
  private readonly reach: Float32Array; // [m] where each ray last ended
  private soft = 1; // [m]
  private readonly gradient = new THREE.Vector3();
  private readonly apart = new THREE.Vector3();
  private readonly along = new THREE.Vector3();

  constructor(material: THREE.Material) {
    this.points = new Float32Array(ROWS * AROUND * 3);
    this.normals = new Float32Array(ROWS * AROUND * 3);
    this.reach = new Float32Array(ROWS * AROUND).fill(1);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(this.points, 3).setUsage(THREE.DynamicDrawUsage));
    geometry.setAttribute("normal", new THREE.BufferAttribute(this.normals, 3).setUsage(THREE.DynamicDrawUsage));
    geometry.setAttribute("color", new THREE.BufferAttribute(this.colours, 3).setUsage(THREE.DynamicDrawUsage));
    const faces: number[] = [];
    for (let row = 0; row + 1 < ROWS; row++) {
      for (let i = 0; i < AROUND; i++) {
        const [here, next] = [row * AROUND + i, row * AROUND + ((i + 1) % AROUND)];
        faces.push(here, next, next + AROUND, here, next + AROUND, here + AROUND);
      }
    }
    geometry.setIndex(faces);
    this.mesh = new THREE.Mesh(geometry, material);
    this.mesh.castShadow = this.mesh.receiveShadow = true;
    this.mesh.frustumCulled = false;
  }

  /** Wraps the skin around `tubes`; `joints` go up the spine inside of them, `hips` lies across below. */
  wrap(tubes: readonly Tube[], joints: readonly THREE.Vector3[], hips: Tube): void {
    const [foot, top] = [joints[0], joints[joints.length - 1]];
    const up = new THREE.Vector3().subVectors(top, foot).normalize();
    const across = new THREE.Vector3().subVectors(hips.b, hips.a);
    const middle = hips.a.clone().lerp(hips.b, 0.5);
    const rise = middle.sub(foot).dot(up) + HEM * hips.radiusA;
    this.soft = SOFT * hips.radiusA;
    const spine = [foot.clone().addScaledVector(up, rise), ...joints.slice(1)];
    const side = across.addScaledVector(up, -across.dot(up)).normalize();
    const front = new THREE.Vector3().crossVectors(up, side);
    const [origin, ray] = [new THREE.Vector3(), new THREE.Vector3()];
    for (let i = 0; i < AROUND; i++) {
      spine[0].toArray(this.points, 3 * i);
      up.clone().negate().toArray(this.normals, 3 * i);
    }
    for (let row = 1; row < ROWS; row++) {
      const steep = this.ray(row, spine, origin);
      for (let i = 0; i < AROUND; i++) {
        const turn = (2 * Math.PI * i) / AROUND;
        ray.copy(side).multiplyScalar(Math.cos(turn)).addScaledVector(front, Math.sin(turn));
        ray.multiplyScalar(Math.cos(steep)).addScaledVector(up, Math.sin(steep));
        this.place(row * AROUND + i, origin, ray, tubes);
      }
    }
    this.mesh.geometry.attributes.position.needsUpdate = true;
    this.mesh.geometry.attributes.normal.needsUpdate = true;
  }

  /** Colours the skin row by row, from level to level of the joints up the spine. */
  warm(heat: Heat, joints: readonly number[]): void {
    for (let row = 0; row < ROWS; row++) {
      const at = Math.min(Math.max(row - 1, 0) / (ALONG - 1), 1) * (joints.length - 1);
      const joint = Math.min(Math.floor(at), joints.length - 2);
      heat.colour(heat.between(joints[joint], joints[joint + 1], at - joint), this.tint);
      for (let i = 0; i < AROUND; i++) this.tint.toArray(this.colours, 3 * (row * AROUND + i));
    }
    this.mesh.geometry.attributes.color.needsUpdate = true;
  }

  /** Where the rays of a row begin, and how steeply they rise. */
  private ray(row: number, spine: readonly THREE.Vector3[], origin: THREE.Vector3): number {
    const part = 0.96 * Math.min((row - 1) / (ALONG - 1), 1);
    const at = part * (spine.length - 1);
    const joint = Math.min(Math.floor(at), spine.length - 2);
    origin.lerpVectors(spine[joint], spine[joint + 1], at - joint);
    return (Math.PI / 2) * (Math.max(row - ALONG, 0) / CAP);
  }

  /** Goes in along a ray until the skin, and sets the point and the normal there. */
  private place(index: number, origin: THREE.Vector3, ray: THREE.Vector3, tubes: readonly Tube[]): void {
    const point = new THREE.Vector3();
    let reach = this.reach[index] + MARGIN;
    let gap = this.distance(point.copy(origin).addScaledVector(ray, reach), tubes);
    if (gap < 0) {
      reach = 1;
      gap = this.distance(point.copy(origin).addScaledVector(ray, reach), tubes);
    }
    for (let step = 0; step < 28 && Math.abs(gap) > NEAR; step++) {
      reach = Math.max(reach - gap, 0);
      gap = this.distance(point.copy(origin).addScaledVector(ray, reach), tubes);
    }
    this.reach[index] = reach;
    point.toArray(this.points, 3 * index);
    this.gradient.normalize().toArray(this.normals, 3 * index);
  }

  /** Metres from a point to the merged capsules, `-s log Σ exp(-d / s)`; leaves its gradient. */
  private distance(point: THREE.Vector3, tubes: readonly Tube[]): number {
    const { gradient, apart, along, soft } = this;
    let [sum, nearest] = [0, Infinity];
    gradient.set(0, 0, 0);
    for (const { a, b, radiusA, radiusB } of tubes) {
      along.subVectors(b, a);
      apart.subVectors(point, a);
      const t = Math.min(Math.max(apart.dot(along) / Math.max(along.lengthSq(), 1e-9), 0), 1);
      apart.addScaledVector(along, -t);
      const length = apart.length();
      const gap = length - (radiusA + t * (radiusB - radiusA));
      if (gap < nearest) {
        // Keep the sum in range: it is always relative to the nearest so far.
        const shrink = nearest === Infinity ? 0 : Math.exp((gap - nearest) / soft);
        sum *= shrink;
        gradient.multiplyScalar(shrink);
        nearest = gap;
      }
      const weight = Math.exp((nearest - gap) / soft);
      sum += weight;
      gradient.addScaledVector(apart, weight / Math.max(length, 1e-6));
    }
    return nearest - soft * Math.log(sum);
  }
}
