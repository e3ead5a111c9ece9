// Wheel and pinch over a strip of time: zoom about where the pointer is, scroll sideways.

export interface Turned {
  zoom(by: number, x: number): void;
  scroll(pixels: number): void;
}

const PER_PIXEL = 0.0022; // of zoom, in exponents of e
const LINE = 30; // [px] of a wheel that counts lines

export function wheel(canvas: HTMLCanvasElement, turned: Turned): void {
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const unit = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? 1 : LINE;
      const [across, down] = [event.deltaX * unit, event.deltaY * unit];
      if (event.shiftKey) turned.scroll(across || down);
      else if (Math.abs(across) > Math.abs(down)) turned.scroll(across);
      else turned.zoom(Math.exp(-down * PER_PIXEL * (event.ctrlKey ? 4 : 1)), event.offsetX); // a pinch on a touchpad has ctrl
    },
    { passive: false },
  );
}

/** Two fingers on a canvas; `busy` says whether they are down, so that one of them does not drag too. */
export class Pinch {
  private readonly fingers = new Map<number, PointerEvent>();

  constructor(canvas: HTMLCanvasElement, turned: Turned) {
    canvas.addEventListener("pointerdown", (event) => {
      if (event.pointerType === "touch") this.fingers.set(event.pointerId, event);
    });
    canvas.addEventListener("pointermove", (event) => this.move(event, turned));
    for (const end of ["pointerup", "pointercancel"] as const) {
      canvas.addEventListener(end, (event) => this.fingers.delete(event.pointerId));
    }
  }

  get busy(): boolean {
    return this.fingers.size > 1;
  }

  private move(event: PointerEvent, turned: Turned): void {
    const before = this.fingers.get(event.pointerId);
    if (!before) return;
    const other = [...this.fingers.values()].find(({ pointerId }) => pointerId !== event.pointerId);
    this.fingers.set(event.pointerId, event);
    if (!other) return;
    const [was, is] = [before, event].map((finger) => Math.max(Math.abs(finger.offsetX - other.offsetX), 8));
    turned.scroll(-(event.offsetX - before.offsetX) / 2);
    turned.zoom(is / was, (event.offsetX + other.offsetX) / 2);
  }
}
