// Making parts of the page. All words of files, people and the server go in as text, never as HTML.

type Child = Node | string | null | undefined | false;
type Value = string | number | boolean | null | undefined | ((event: never) => void);

/** A new element: what begins with "on" listens, `true` is an attribute without a value, nothing leaves one out. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  given: Record<string, Value> = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(given)) {
    if (typeof value === "function") element.addEventListener(name.slice(2), value as EventListener);
    else if (value !== null && value !== undefined && value !== false) {
      element.setAttribute(name, value === true ? "" : String(value));
    }
  }
  element.append(
    ...children.filter((child): child is Node | string => child !== null && child !== undefined && child !== false),
  );
  return element;
}

export function button(words: string, press: () => void, given: Record<string, Value> = {}): HTMLButtonElement {
  return h("button", { type: "button", class: "text", onclick: press, ...given }, words);
}

/** Words in place of those before, if they are others: sixty times a second costs nothing. */
export function say(element: Element, words: string): void {
  if (element.textContent !== words) element.textContent = words;
}

export function at(id: string): HTMLElement {
  return document.getElementById(id) as HTMLElement;
}

let labelled = 0;

/** A control with its label before it. */
export function field(words: string, control: HTMLElement, hint = ""): HTMLElement {
  control.id ||= `field${++labelled}`;
  const told = hint ? h("small", { id: `${control.id}-hint` }, hint) : undefined;
  if (told) control.setAttribute("aria-describedby", told.id);
  return h("div", { class: "field" }, h("label", { for: control.id }, words), control, told);
}

export function choice(
  options: readonly (readonly [value: string, words: string])[],
  chosen: string,
): HTMLSelectElement {
  const select = h("select");
  offer(select, options, chosen);
  return select;
}

/** Options in place of those before; what was chosen stays, where it is still there. */
export function offer(
  select: HTMLSelectElement,
  options: readonly (readonly [string, string])[],
  chosen = select.value,
): void {
  const told = JSON.stringify(options);
  if (select.dataset.told !== told) {
    select.dataset.told = told;
    select.replaceChildren(...options.map(([value, words]) => h("option", { value }, words)));
  }
  if (options.some(([value]) => value === chosen)) select.value = chosen;
}

/** Keeps one child for each item, in their order: what has the focus keeps it. */
export function keyed<T>(
  parent: HTMLElement,
  items: readonly T[],
  key: (item: T) => string,
  make: (item: T) => HTMLElement,
  update: (element: HTMLElement, item: T) => void,
): void {
  const old = new Map(
    Array.from(parent.children, (child) => [(child as HTMLElement).dataset.key, child as HTMLElement]),
  );
  items.forEach((item, i) => {
    const name = key(item);
    const element = old.get(name) ?? make(item);
    old.delete(name);
    element.dataset.key = name;
    update(element, item);
    if (parent.children[i] !== element) parent.insertBefore(element, parent.children[i] ?? null);
  });
  for (const gone of old.values()) gone.remove();
}
