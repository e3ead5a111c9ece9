// The overlay that tells all keys.

import type { KeyGroup } from "./keys";

export class Help {
  constructor(
    private readonly dialog: HTMLDialogElement,
    groups: readonly KeyGroup[],
  ) {
    const list = dialog.querySelector("#keys") as HTMLElement;
    list.replaceChildren(...groups.filter(({ keys }) => keys.length).map(section));
    dialog.addEventListener("click", (event) => event.target === dialog && dialog.close());
    dialog.querySelector("button")?.addEventListener("click", () => dialog.close());
    dialog.addEventListener("keydown", (event) => event.key === "?" && dialog.close());
  }

  open(): void {
    this.dialog.showModal();
  }
}

function section({ title, keys }: KeyGroup): HTMLElement {
  const [part, name, list] = ["section", "h3", "dl"].map((tag) => document.createElement(tag));
  name.textContent = title;
  for (const { told, words } of keys) {
    const [key, meaning] = [document.createElement("dt"), document.createElement("dd")];
    key.append(
      ...told.split(" ").map((one) => {
        const mark = document.createElement(one === "or" ? "span" : "kbd");
        mark.textContent = one;
        return mark;
      }),
    );
    meaning.textContent = words;
    list.append(key, meaning);
  }
  part.append(name, list);
  return part;
}
