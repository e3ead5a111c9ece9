// A name under a dancer's feet, as large as the dancer makes it.

import * as THREE from "three";

const TALL = 0.075; // of the dancer's height
const [PIXELS, ROOM] = [64, 16]; // [px] height of the letters, and around them

export class Caption {
  readonly sprite: THREE.Sprite;

  constructor(
    words: string,
    private readonly floor: number,
    private readonly height: number,
  ) {
    const canvas = document.createElement("canvas");
    const pen = canvas.getContext("2d") as CanvasRenderingContext2D;
    const font = `600 ${PIXELS}px system-ui, -apple-system, "Segoe UI", Roboto, sans-serif`;
    pen.font = font;
    canvas.width = Math.ceil(pen.measureText(words).width) + 2 * ROOM;
    canvas.height = PIXELS + 2 * ROOM;
    pen.font = font; // a canvas that is sized anew has forgotten it
    pen.fillStyle = "#5b6472";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillText(words, canvas.width / 2, canvas.height / 2);
    const map = new THREE.CanvasTexture(canvas);
    map.colorSpace = THREE.SRGBColorSpace;
    this.sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map, depthTest: false, transparent: true }));
    this.sprite.renderOrder = 4;
    const tall = TALL * height;
    this.sprite.scale.set((tall * canvas.width) / canvas.height, tall, 1);
  }

  /** Under who stands at `centre`. */
  put(centre: THREE.Vector3): void {
    this.sprite.position.set(centre.x, centre.y, this.floor - 0.09 * this.height);
  }
}
