// Making a library of motions of the project.

import { ask } from "./api";
import type { LibraryItem } from "./contract";
import { dialog } from "./dialogs";
import { button, field, h } from "./elements";
import { isGuessed } from "./rate_form";
import type { Store } from "./store";
import { go } from "./view";
import { exactly, plainName } from "./words";

const FEW = 4; // motions that are ticked one by one

export function newLibrary(store: Store, chosen: readonly string[] = []): void {
  const ready = (store.project?.motions ?? []).filter(({ state }) => state === "ready");
  const name = h("input", { type: "text", name: "name", value: "My moves", maxlength: 120, required: true });
  const boxes = ready.map((motion) => {
    const { id, name: words, seconds } = motion;
    const box = h("input", { type: "checkbox", value: id });
    box.checked = !chosen.length || chosen.includes(id);
    return {
      box,
      row: h(
        "label",
        { class: "tick" },
        box,
        h("span", {}, plainName(words)),
        h("span", { class: "soft" }, `${exactly(seconds)}${isGuessed(motion) ? ", rate assumed" : ""}`),
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
  const guessed = ready.some(isGuessed)
    ? [h("p", { class: "note" }, "Where the frame rate is assumed, the motion may be too fast or too slow: its page asks for it. Said later, the library is built again.")]
    : [];
  const parts = [field("Name", name), ...(boxes.length > FEW ? [ticking] : []), list, told, ...guessed];
  dialog("Make a library", parts, "Build", async () => {
    const motions = boxes.filter(({ box }) => box.checked).map(({ box }) => box.value);
    if (!motions.length) throw new Error("Choose at least one motion.");
    const made = await ask<LibraryItem>("POST", "libraries", { name: name.value.trim() || "My moves", motions });
    await store.refresh();
    go("library", made.id);
  });
}
