// What keys do: one list, for the keyboard and for the overlay that tells it.

export interface Key {
  keys: string[];
  told: string; // as it is printed
  words: string;
  press(): void;
}

/** Keys in groups that belong together. */
export interface KeyGroup {
  title: string;
  keys: Key[];
}

/** Listens for keys; those that whatever has the focus needs itself are left to it. */
export function listen(groups: readonly KeyGroup[]): void {
  const all = new Map(groups.flatMap(({ keys }) => keys.flatMap((key) => key.keys.map((name) => [name, key] as const))));
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
    const key = all.get(event.key);
    if (!key || taken(event)) return;
    event.preventDefault();
    key.press();
  });
  // What was pressed with a pointer gives the focus back, else space would press it again.
  addEventListener("click", (event) => {
    const pressed = (event.target as Element).closest?.("button, summary, input");
    if (event.detail > 0 && pressed instanceof HTMLElement) pressed.blur();
  });
}

/** What opens over the page goes away again by Escape, wherever the focus is, and mostly by a press beside it. */
export function shutting(over: HTMLDetailsElement, beside = true): void {
  addEventListener("click", (event) => {
    if (beside && !over.contains(event.target as Node)) over.open = false;
  });
  addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !over.open || document.querySelector("dialog[open]")) return;
    if (over.contains(document.activeElement)) over.querySelector("summary")?.focus();
    over.open = false;
  });
}

function taken(event: KeyboardEvent): boolean {
  const focused = event.target instanceof Element ? event.target : undefined;
  if (focused?.matches("button, summary, a")) return event.key === " " || event.key === "Enter";
  if (focused?.matches("input[type=checkbox]")) return event.key === " ";
  if (focused?.matches("input, select")) return event.key.startsWith("Arrow") || ["Home", "End", " ", "Enter"].includes(event.key);
  return false;
}
