// Making a library of motions of the project.

import { ask } from "./api";
import type { LibraryItem } from "./contract";
import { dialog } from "./dialogs";
import { button, field, h } from "./elements";
import type { Store } from "./store";
import { go } from "./view";
import { exactly, plainName } from "./words";

const FEW = 4; // motions that are ticked one by one

export function newLibrary(store: Store, chosen: readonly string[] = []): void {
  const ready = (store.project?.motions ?? []).filter(({ state }) => state === "ready");
  const name = h("input", { type: "text", name: "name", value: "My moves", maxlength: 120, required: true });
  const boxes = ready.map(({ id, name: words, seconds }) => {
    const box = h("input", { type: "checkbox", value: id });
    box.checked = !chosen.length || chosen.includes(id);
    return {
      box,
      row: h(
        "label",
        { class: "tick" },
        box,
        h("span", {}, plainName(words)),
        h("span", { class: "soft" }, exactly(seconds)),
      ),
    };
  });
  const list = h(
    "fieldset",
    { class: "ticks", name: "motions" },
    h("legend", {}, "Motions"),
    ...boxes.map(({ row }) => row),
  );
  const tick = (on: boolean) => () => boxes.forEach(({ box }) => (box.checked = on));
  const ticking = h("div", { class: "row" }, button("All", tick(true)), button("None", tick(false)));
  const told = h(
    "p",
    { class: "soft" },
    "A library holds the clips and all places where one can give way to another. Files of one body go together.",
  );
  dialog("Make a library", [field("Name", name), ...(boxes.length > FEW ? [ticking] : []), list, told], "Build", async () => {
    const motions = boxes.filter(({ box }) => box.checked).map(({ box }) => box.value);
    if (!motions.length) throw new Error("Choose at least one motion.");
    const made = await ask<LibraryItem>("POST", "libraries", { name: name.value.trim() || "My moves", motions });
    await store.refresh();
    go("library", made.id);
  });
}
