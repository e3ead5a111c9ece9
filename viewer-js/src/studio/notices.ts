// Words that come up over the head of the page, where nothing is played, and go again; what went wrong stays until it is put away.

import { at, h } from "./elements";

const STAYS = 6000; // [ms]
const MOST = 4;

export function notice(words: string, bad = false): void {
  const away = h(
    "button",
    { type: "button", "aria-label": "Put this message away", onclick: () => entry.remove() },
    "×",
  );
  const entry = h("li", { class: bad ? "bad" : "" }, h("span", {}, words), away);
  const list = at("notices");
  unsay(words);
  list.append(entry);
  while (list.children.length > MOST) list.firstElementChild?.remove();
  if (!bad) setTimeout(() => entry.remove(), STAYS);
}

/** It does not hold any more. */
export function unsay(words: string): void {
  for (const old of Array.from(at("notices").children)) if (old.firstChild?.textContent === words) old.remove();
}
