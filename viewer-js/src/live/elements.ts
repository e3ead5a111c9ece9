// Parts of the page by their names. All words of a session go in as text, never as HTML.

export function at(id: string): HTMLElement {
  return document.getElementById(id) as HTMLElement;
}

/** Writes words where they are others than before: sixty times a second costs nothing. */
export function text(id: string, words: string): void {
  const element = at(id);
  if (element.textContent !== words) element.textContent = words;
}

export function on(id: string, press: () => void): void {
  at(id).addEventListener("click", press);
}

export function press(id: string, pressed: boolean): void {
  at(id).setAttribute("aria-pressed", String(pressed));
}

/** A new element with words in it. */
export function made<K extends keyof HTMLElementTagNameMap>(tag: K, words = ""): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  element.textContent = words;
  return element;
}

export function minutes(seconds: number): string {
  const whole = Math.max(Math.floor(seconds), 0);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
}
