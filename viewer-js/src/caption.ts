// A name under a dancer's feet, as large as the dancer makes it.

import * as THREE from "three";

const TALL = 0.075; // of the dancer's height
const [PIXELS, ROOM] = [64, 16]; // [px] height of the letters, and around them
const FONT = `600 ${PIXELS}px system-ui, -apple-system, "Segoe UI", Roboto, sans-serif`;

export class Caption {
  readonly sprite: THREE.Sprite;
  private readonly canvas = document.createElement("canvas");
  private readonly map: THREE.CanvasTexture;

  constructor(
    private readonly words: string,
    private readonly floor: number,
    private readonly height: number,
  ) {
    const pen = this.canvas.getContext("2d") as CanvasRenderingContext2D;
    pen.font = FONT;
    this.canvas.width = Math.ceil(pen.measureText(words).width) + 2 * ROOM;
    this.canvas.height = PIXELS + 2 * ROOM;
    this.map = new THREE.CanvasTexture(this.canvas);
    this.map.colorSpace = THREE.SRGBColorSpace;
    this.sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map: this.map, depthTest: false, transparent: true }));
    this.sprite.renderOrder = 4;
    const tall = TALL * height;
    this.sprite.scale.set((tall * this.canvas.width) / this.canvas.height, tall, 1);
    this.dark = false;
  }

  /** Readable in a dark or a light room. */
  set dark(dark: boolean) {
    const pen = this.canvas.getContext("2d") as CanvasRenderingContext2D;
    const { width, height } = this.canvas;
    pen.clearRect(0, 0, width, height);
    pen.font = FONT; // a canvas that was sized has forgotten it
    pen.fillStyle = dark ? "#aab2c6" : "#5b6472";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillText(this.words, width / 2, height / 2);
    this.map.needsUpdate = true;
  }

  /** Under who stands at `centre`. */
  put(centre: THREE.Vector3): void {
    this.sprite.position.set(centre.x, centre.y, this.floor - 0.09 * this.height);
  }
}
