// A canvas to draw on in CSS pixels, and to drag on.

/** A canvas that is as sharp as its screen. */
export class Strip {
  readonly pen: CanvasRenderingContext2D;
  width = 0;
  height = 0;

  constructor(readonly canvas: HTMLCanvasElement) {
    this.pen = canvas.getContext("2d") as CanvasRenderingContext2D;
  }

  /** Sizes the canvas as it is laid out; true where that changed. */
  fit(): boolean {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const scale = Math.min(devicePixelRatio || 1, 3);
    const changed = this.canvas.width !== Math.round(width * scale) || this.canvas.height !== Math.round(height * scale);
    if (changed) {
      this.canvas.width = Math.round(width * scale);
      this.canvas.height = Math.round(height * scale);
    }
    [this.width, this.height] = [width, height];
    this.pen.setTransform(scale, 0, 0, scale, 0, 0);
    return changed;
  }
}

/** Calls `down` where a pointer goes down, `move` while it is held, `up` when it lets go. */
export function drag(
  canvas: HTMLCanvasElement,
  down: (event: PointerEvent) => void,
  move: (event: PointerEvent) => void,
  up?: () => void,
): void {
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    down(event);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (canvas.hasPointerCapture(event.pointerId)) move(event);
  });
  canvas.addEventListener("pointerup", () => up?.());
}
