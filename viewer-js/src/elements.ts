// The page's elements by their ids, and what is done with them everywhere.

export function at<E extends HTMLElement = HTMLElement>(id: string): E {
  return document.getElementById(id) as E;
}

export function text(id: string, words: string): void {
  at(id).textContent = words;
}

export function on(id: string, press: () => void): void {
  at(id).addEventListener("click", press);
}

/** Says that a button is on or off. */
export function press(button: HTMLElement, pressed: boolean): void {
  button.setAttribute("aria-pressed", String(pressed));
}
