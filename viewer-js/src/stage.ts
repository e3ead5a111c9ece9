// The scene: light, ground, dancer, and a camera that orbits and follows.

import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Caption } from "./caption";
import type { PageData } from "./contract";
import type { Dancer } from "./dancer";
import { Ground } from "./ground";
import type { Master } from "./master";
import { Presets, type Reach, type ViewName } from "./presets";

const FOLLOW = 1.6; // [1/s] how fast the camera goes after a dancer that it looks at
const OFF = 0.25; // of the height: twice as fast after one that is so far aside
const LEAP = 0.05; // of the height: the camera rises with feet that are farther off the floor
const FULL = 0.88; // of what is free, that the dancer takes at most
const FIELD_OF_VIEW = 30; // [degrees]

/** Where the ground is, whither the dancer faces at first, and how much more room than it stands in it gets. */
export interface Place extends Pick<PageData, "floor" | "facing"> {
  room?: number;
}

/** Who else is on the stage, and the names under both. */
export interface Company {
  master: Master;
  captions: Caption[];
}

/** Pixels at the edges of the picture that words and buttons lie on. */
export interface Covered {
  top: number;
  bottom: number;
}

/** What else is drawn, and has to know the time. */
export interface Extra {
  group: THREE.Object3D;
  pose(time: number): void;
}

export class Stage {
  follow = true;
  readonly master?: Master;
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, 0.1, 200);
  private readonly controls: OrbitControls;
  private readonly ground: Ground;
  private readonly sun = new THREE.DirectionalLight("#fff4e6", 2.1);
  private readonly target = new THREE.Vector3();
  private readonly captions: Caption[];
  private readonly extras: Extra[] = [];
  private readonly views: Presets;
  private drawn = -1; // [s] the time last drawn
  private tall: number; // [m]
  private jumped = false;
  private filled = 1; // [m] from which the dancer filled the picture when last looked at
  private covered = (): Covered => ({ top: 0, bottom: 0 });

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly page: Place,
    public dancer: Dancer,
    company?: Company,
  ) {
    this.renderer = rendererOn(canvas);
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.master = company?.master;
    this.captions = company?.captions ?? [];
    if (this.master) this.scene.add(this.master.dancer.group);
    for (const { sprite } of this.captions) this.scene.add(sprite);
    this.ground = new Ground(page.floor);
    this.scene.add(this.dancer.group, this.ground.group);
    this.addLights();
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.enablePan = false;
    this.controls.maxPolarAngle = Math.PI / 2 - 0.02;
    this.views = new Presets(this.camera, this.controls, page.facing);
    this.tall = this.tallest();
    this.fit();
    this.placeCamera();
    new ResizeObserver(() => {
      this.fit();
      this.comeAsNear();
      this.renderer.render(this.scene, this.camera); // at once, else there is nothing to see until the next frame
    }).observe(canvas);
  }

  draw(time: number, seconds: number, sinceBeat: number, strength: number): void {
    this.dancer.pose(time);
    this.master?.pose(time);
    if (this.jumped) this.catchUp();
    this.jumped = false;
    for (const extra of this.extras) extra.pose(time);
    this.caption();
    const centre = this.middle();
    const to = this.views.fixed ?? centre;
    if (this.follow || this.views.fixed) this.goAfter(to, 1 - Math.exp(-this.pace(to) * seconds));
    this.sun.target.position.set(centre.x, centre.y, this.page.floor + 0.8);
    this.sun.position.copy(this.sun.target.position).add(new THREE.Vector3(...this.lightFrom()));
    const ends = [...this.dancer.ends, ...(this.master?.ends() ?? [])];
    this.ground.update(this.dancer.centre, ends, sinceBeat, strength);
    const moved = this.views.update(seconds);
    const turned = this.controls.update(seconds || undefined);
    if (!turned && !moved && time === this.drawn) return; // a paused page must not heat a phone
    this.drawn = time;
    this.renderer.render(this.scene, this.camera);
  }

  /** Names under both; one is enough where they are in the same place. */
  private caption(): void {
    const apart = this.master?.place === "beside";
    this.captions.forEach((caption, i) => {
      caption.sprite.visible = i === 0 || apart;
      caption.put(i === 0 || !this.master ? this.dancer.centre : this.master.dancer.centre.clone().add(this.master.shift));
    });
  }

  /** Bring the camera to the dancer at once, as after a seek. */
  catchUp(): void {
    if (this.follow && !this.views.fixed) this.goAfter(this.middle(), 1);
  }

  /** The dancer will be elsewhere when next drawn, and the camera with it. */
  jump(): void {
    this.jumped = true;
  }

  /** Second of the dance that was last drawn. */
  get posed(): number {
    return this.drawn;
  }

  /** Where the camera is [m]. */
  get eye(): number[] {
    return this.camera.position.toArray();
  }

  /** Something else to draw from now on. */
  add(extra: Extra): void {
    this.extras.push(extra);
    this.scene.add(extra.group);
  }

  /** All that was added goes. */
  bare(): void {
    for (const { group } of this.extras) {
      this.scene.remove(group);
      group.traverse((part) => {
        if (!(part instanceof THREE.Mesh)) return;
        part.geometry.dispose();
        (part.material as THREE.Material).dispose();
      });
    }
    this.extras.length = 0;
  }

  /** Where the dancer is over the whole dance, which is seen from the front, the side and above; how tall who is there stands. */
  survey(reach: Reach, tall?: number): void {
    this.views.reach = reach;
    if (tall === undefined) return;
    this.tall = tall;
    this.placeCamera();
  }

  /** Where the camera looks from; undefined where somebody moved it. */
  get view(): ViewName | undefined {
    return this.views.view;
  }

  /** Looks from another place, gently or at once. */
  look(view: ViewName, atOnce = false): void {
    this.views.choose(view, this.away());
    this.follow = this.views.goes;
    if (!atOnce) return;
    this.goAfter(this.views.fixed ?? this.middle(), 1);
    this.views.arrive();
  }

  /** The camera goes with the dancer, or is left where it is. */
  toggleFollow(): void {
    if (this.views.goes) this.follow = !this.follow;
    else this.look("follow");
  }

  /** To be drawn again though no time has passed. */
  renew(): void {
    this.drawn = -1;
  }

  /** Keeps the dancer clear of what lies on the picture's edges; they are looked at again when the picture has another size. */
  keepClear(covered: () => Covered): void {
    this.covered = covered;
    this.fit();
    this.placeCamera();
  }

  /** Calmly after small steps, but nobody walks out of the picture. */
  private pace(to: THREE.Vector3): number {
    if (this.views.fixed) return 3 * FOLLOW;
    const off = Math.hypot(to.x - this.target.x, to.y - this.target.y) / (OFF * this.tall);
    return FOLLOW * (1 + off * off);
  }

  /** Another dancer comes in place of the one that was there. */
  replace(dancer: Dancer): void {
    this.scene.remove(this.dancer.group);
    this.dancer.dispose();
    this.dancer = dancer;
    this.scene.add(dancer.group);
    this.tall = this.tallest();
    this.placeCamera();
    this.drawn = -1;
  }

  /** A dark or a light room. */
  set dark(dark: boolean) {
    this.ground.dark = dark;
    for (const caption of this.captions) caption.dark = dark;
    this.drawn = -1;
  }

  /** Puts the master beside the dancer, over it, or away. */
  nextMaster(): void {
    this.master?.next();
    this.drawn = -1;
    this.catchUp();
  }

  /** What the camera looks at: the dancer, or half-way to who stands beside. */
  private middle(): THREE.Vector3 {
    const here = this.dancer.centre.clone();
    if (this.master?.place !== "beside") return here;
    return here.lerp(this.master.dancer.centre.clone().add(this.master.shift), 0.5);
  }

  private goAfter(centre: THREE.Vector3, part: number): void {
    const height = this.page.floor + 0.5 * this.tall + this.lift();
    const move = new THREE.Vector3(centre.x, centre.y, height).sub(this.target).multiplyScalar(part);
    this.target.add(move);
    this.controls.target.copy(this.target);
    this.camera.position.add(move);
  }

  /** Metres by which the camera is higher, after who leaps or climbs. */
  private lift(): number {
    return this.views.fixed ? 0 : Math.max(this.dancer.clearance - LEAP * this.tall, 0);
  }

  private addLights(): void {
    this.scene.add(new THREE.HemisphereLight("#ffffff", "#d8cfc6", 2.1));
    const rim = new THREE.DirectionalLight("#dfe8ff", 0.8);
    rim.position.set(...this.aside(2.5, 3.0));
    const sun = this.sun;
    const wide = this.master ? 2.8 : 1.8;
    sun.castShadow = true;
    sun.shadow.mapSize.set(2048, 2048);
    Object.assign(sun.shadow.camera, { left: -wide, right: wide, top: wide, bottom: -wide, near: 0.5, far: 12 });
    sun.shadow.radius = 5;
    sun.shadow.bias = -0.0005;
    sun.shadow.normalBias = 0.02;
    this.scene.add(rim, sun, sun.target);
  }

  /** A light from above, before and beside the dancer as first seen. */
  private lightFrom(): [number, number, number] {
    const yaw = this.page.facing - 0.75;
    return [-Math.sin(yaw) * 2.6, Math.cos(yaw) * 2.6, 4.6];
  }

  private aside(turn: number, height: number): [number, number, number] {
    const yaw = this.page.facing + turn;
    return [-Math.sin(yaw) * 4, Math.cos(yaw) * 4, height];
  }

  /** How tall the taller one stood when the stage was set. */
  private tallest(): number {
    return Math.max(this.dancer.height, this.master?.dancer.height ?? 0);
  }

  /** Metres from which who is on the stage fills the picture. */
  private away(height = this.tall): number {
    const wide = this.master ? 0.55 + this.master.shift.length() / height : 0.74; // of the height
    const narrow = Math.min(this.camera.aspect / wide, 1);
    const half = Math.max(0.78 * (this.page.room ?? 1), 0.5 / (FULL * this.free)); // of the height
    return (half * height) / Math.tan((FIELD_OF_VIEW / 2) * (Math.PI / 180)) / narrow;
  }

  /** How much of the picture's height nothing lies on. */
  private get free(): number {
    const { top, bottom } = this.covered();
    return Math.max(1 - (top + bottom) / Math.max(this.canvas.clientHeight, 1), 0.3);
  }

  private placeCamera(): void {
    const height = this.tall;
    const yaw = this.page.facing + 0.42;
    const middle = this.middle();
    this.target.set(middle.x, middle.y, this.page.floor + 0.5 * height);
    const away = (this.filled = this.away());
    const out = new THREE.Vector3(-Math.sin(yaw), Math.cos(yaw), 0.2).normalize();
    this.camera.position.copy(this.target).addScaledVector(out, away);
    this.controls.target.copy(this.target);
    this.controls.minDistance = 0.5 * height;
    this.controls.maxDistance = 12 * height;
    this.controls.update();
  }

  /** In a picture of another shape the dancer fills as much of it as before. */
  private comeAsNear(): void {
    const away = this.away();
    this.camera.position.sub(this.target).multiplyScalar(away / this.filled).add(this.target);
    this.filled = away;
  }

  private fit(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.drawn = -1;
    this.camera.aspect = width / height;
    const { top, bottom } = this.covered();
    this.camera.setViewOffset(width, height, 0, (bottom - top) / 2, width, height);
  }
}

function rendererOn(canvas: HTMLCanvasElement): THREE.WebGLRenderer {
  try {
    return new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
  } catch {
    throw new Error("The dancer is drawn with WebGL, which this browser has not or has switched off. Try another browser.");
  }
}
