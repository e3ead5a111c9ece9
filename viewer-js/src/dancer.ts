// The body: tapering capsules between joints, posed as it is at a time.

import * as THREE from "three";
import type { CapsuleData, PageData } from "./contract";
import type { Heat } from "./heat";
import type { Places } from "./path";
import { Trunk, type Tube } from "./trunk";

const UP = new THREE.Vector3(0, 1, 0);
const TINT = new THREE.Color();
const AROUND = 28; // faces around a capsule
const [LOOKS, MOSTLY] = [60, 0.75]; // how often a dance is looked at for its dancer's height, and the part that is lower

/** What a body is made of. */
export type Body = Pick<PageData, "joints" | "capsules" | "spine" | "floor">;

interface Limb {
  data: CapsuleData;
  mesh: THREE.Mesh;
  length: number;
  tube: Tube;
}

export class Dancer {
  readonly group = new THREE.Group();
  readonly joints: Float32Array; // joints x 3 at the time last posed
  readonly ends: THREE.Vector4[] = []; // both ends of each capsule and its radius there
  readonly centre = new THREE.Vector3();
  private readonly limbs: Limb[];
  private readonly trunk?: Trunk;
  private readonly spine: THREE.Vector3[];

  /** With `heat` the body is coloured by it, else in the colours of its clothes. */
  constructor(
    private readonly page: Body,
    private readonly places: Places,
    readonly heat?: Heat,
  ) {
    this.joints = new Float32Array(page.joints.length * 3);
    places.read(0, this.joints);
    this.limbs = page.capsules.map((data) => this.limb(data));
    this.spine = page.spine.map(() => new THREE.Vector3());
    if (page.spine.length > 1) {
      this.trunk = new Trunk(this.material(page.capsules.find(({ group }) => group === "torso")?.colour));
      this.group.add(this.trunk.mesh);
      for (const { data, mesh } of this.limbs) mesh.visible = data.group !== "torso";
    }
    this.pose(0);
  }

  pose(time: number): void {
    this.places.read(time, this.joints);
    this.heat?.read(time);
    const along = new THREE.Vector3();
    this.limbs.forEach(({ data, mesh, length, tube }, i) => {
      const { a, b } = tube;
      this.span(data, a, b);
      along.subVectors(b, a);
      const now = along.length();
      mesh.position.copy(a);
      if (now > 1e-6) mesh.quaternion.setFromUnitVectors(UP, along.divideScalar(now));
      mesh.scale.y = length > 0.01 ? now / length : 1;
      this.ends[2 * i].set(a.x, a.y, a.z, data.radius_a);
      this.ends[2 * i + 1].set(b.x, b.y, b.z, data.radius_b);
      if (this.heat && mesh.visible) this.warm(this.heat, data, mesh);
    });
    this.page.spine.forEach((joint, i) => this.spine[i].fromArray(this.joints, 3 * joint));
    this.centre.copy(this.spine[0]);
    this.wrapTrunk();
  }

  /** Metres from the floor to the highest point of the body at the time last posed. */
  get height(): number {
    return Math.max(...this.ends.map((end) => end.z + end.w)) - this.page.floor;
  }

  /** Metres from the floor to the lowest point of the body at the time last posed. */
  get clearance(): number {
    return Math.min(...this.ends.map((end) => end.z - end.w)) - this.page.floor;
  }

  /** Metres from the body's lowest point to the top of its head, as it mostly is or less, over so many seconds. */
  standing(duration: number): number {
    const tall = Array.from({ length: LOOKS }, (_, look) => this.stature((duration * look) / LOOKS)).sort((p, q) => p - q);
    this.places.read(0, this.joints);
    return tall[Math.floor(MOSTLY * LOOKS)];
  }

  private stature(time: number): number {
    this.places.read(time, this.joints);
    const [a, b] = [new THREE.Vector3(), new THREE.Vector3()];
    let [low, high, head] = [Infinity, -Infinity, -Infinity];
    for (const { data } of this.limbs) {
      this.span(data, a, b);
      low = Math.min(low, a.z - data.radius_a, b.z - data.radius_b);
      high = Math.max(high, a.z + data.radius_a, b.z + data.radius_b);
      if (data.group === "head") head = Math.max(head, a.z + data.radius_a, b.z + data.radius_b);
    }
    return (head > -Infinity ? head : high) - low;
  }

  /** Gives back what the graphics card holds of it. */
  dispose(): void {
    this.group.traverse((part) => {
      if (!(part instanceof THREE.Mesh)) return;
      part.geometry.dispose();
      (part.material as THREE.Material).dispose();
    });
  }

  private wrapTrunk(): void {
    if (!this.trunk) return;
    const tubes = this.limbs.filter(({ data }) => data.group === "torso").map(({ tube }) => tube);
    const hips = this.limbs.find(({ data }) => data.group === "hips")?.tube ?? tubes[0];
    this.trunk.wrap(tubes, this.spine, hips);
    if (this.heat) this.trunk.warm(this.heat, this.page.spine);
  }

  /** Colours a capsule from one joint's level to the other's. */
  private warm(heat: Heat, data: CapsuleData, mesh: THREE.Mesh): void {
    const colours = mesh.geometry.attributes.color as THREE.BufferAttribute;
    const row = AROUND + 1;
    for (let first = 0; first < colours.count; first += row) {
      const part = data.start + (data.end - data.start) * (first < colours.count / 2 ? 0 : 1);
      heat.colour(heat.between(data.a, data.b, part), TINT);
      for (let i = 0; i < row; i++) colours.setXYZ(first + i, TINT.r, TINT.g, TINT.b);
    }
    colours.needsUpdate = true;
  }

  private material(colour = "#ee5c42"): THREE.Material {
    if (this.heat) return new THREE.MeshStandardMaterial({ vertexColors: true, roughness: 0.7 });
    return new THREE.MeshStandardMaterial({ color: colour, roughness: 0.7 });
  }

  private limb(data: CapsuleData): Limb {
    const tube = { a: new THREE.Vector3(), b: new THREE.Vector3(), radiusA: data.radius_a, radiusB: data.radius_b };
    this.span(data, tube.a, tube.b);
    const length = tube.a.distanceTo(tube.b);
    const mesh = new THREE.Mesh(capsule(length, data.radius_a, data.radius_b), this.material(data.colour));
    mesh.castShadow = mesh.receiveShadow = true;
    this.group.add(mesh);
    this.ends.push(new THREE.Vector4(), new THREE.Vector4());
    return { data, mesh, length, tube };
  }

  private span(data: CapsuleData, a: THREE.Vector3, b: THREE.Vector3): void {
    const from = new THREE.Vector3().fromArray(this.joints, 3 * data.a);
    const to = new THREE.Vector3().fromArray(this.joints, 3 * data.b);
    a.lerpVectors(from, to, data.start);
    b.lerpVectors(from, to, data.end);
  }
}

/** A surface of revolution about y: two spheres at 0 and `length` and the cone that touches both. */
function capsule(length: number, radiusA: number, radiusB: number): THREE.BufferGeometry {
  const [arc, around] = [10, AROUND];
  const tilt = Math.asin(Math.min(Math.max((radiusA - radiusB) / Math.max(length, 1e-6), -0.98), 0.98));
  const profile: [radius: number, y: number, angle: number][] = [];
  for (let i = 0; i <= arc; i++) {
    const angle = -Math.PI / 2 + (tilt + Math.PI / 2) * (i / arc);
    profile.push([radiusA * Math.cos(angle), radiusA * Math.sin(angle), angle]);
  }
  for (let i = 0; i <= arc; i++) {
    const angle = tilt + (Math.PI / 2 - tilt) * (i / arc);
    profile.push([radiusB * Math.cos(angle), length + radiusB * Math.sin(angle), angle]);
  }
  const [points, normals, faces]: [number[], number[], number[]] = [[], [], []];
  profile.forEach(([radius, y, angle], row) => {
    for (let i = 0; i <= around; i++) {
      const turn = (2 * Math.PI * i) / around;
      const [c, s] = [Math.cos(turn), Math.sin(turn)];
      points.push(radius * c, y, radius * s);
      normals.push(Math.cos(angle) * c, Math.sin(angle), Math.cos(angle) * s);
      if (row === 0 || i === 0) continue;
      const here = row * (around + 1) + i;
      const below = here - around - 1;
      faces.push(below - 1, here - 1, here, below - 1, here, below);
    }
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
  geometry.setAttribute("normal", new THREE.Float32BufferAttribute(normals, 3));
  geometry.setAttribute("color", new THREE.Float32BufferAttribute(new Float32Array(points.length).fill(1), 3));
  geometry.setIndex(faces);
  return geometry;
}
