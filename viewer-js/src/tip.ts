// A few words beside the pointer about what is under it.

const AWAY = 14; // [px]

export class Tip {
  constructor(private readonly box: HTMLElement) {}

  /** Asks for lines of words wherever the pointer is over a canvas; nothing is shown where there are none. */
  watch(canvas: HTMLElement, words: (x: number, y: number) => string[]): void {
    const show = (event: PointerEvent): void => this.show(event, words(event.offsetX, event.offsetY));
    canvas.addEventListener("pointermove", show);
    canvas.addEventListener("pointerdown", show);
    for (const end of ["pointerleave", "pointercancel"] as const) canvas.addEventListener(end, () => this.hide());
    canvas.addEventListener("pointerup", (event) => event.pointerType === "touch" && this.hide());
  }

  hide(): void {
    this.box.hidden = true;
  }

  private show(event: PointerEvent, lines: string[]): void {
    if (!lines.length) return this.hide();
    this.box.replaceChildren(
      ...lines.map((line, i) => {
        const row = document.createElement(i ? "span" : "b");
        row.textContent = line;
        return row;
      }),
    );
    this.box.hidden = false;
    const { offsetWidth: width, offsetHeight: height } = this.box;
    const right = event.clientX + AWAY + width < innerWidth - 4;
    const left = right ? event.clientX + AWAY : Math.max(event.clientX - AWAY - width, 4);
    const above = event.clientY - AWAY - height;
    this.box.style.left = `${left}px`;
    this.box.style.top = `${above > 4 ? above : event.clientY + AWAY}px`;
  }
}
