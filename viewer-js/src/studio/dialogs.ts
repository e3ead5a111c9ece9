// Dialogs: the browser's own keep the focus inside, close with Escape and give the focus back.

import { words, type Refusal } from "./api";
import { button, h } from "./elements";

/** Opens a dialog whose form is done by `act`; what is refused is said in it, and it stays open. */
export function dialog(title: string, content: readonly Node[], does: string, act: () => Promise<void> | void): void {
  const problem = h("p", { class: "problem", role: "alert", hidden: true });
  const name = h("h2", { id: "dialog-title" }, title);
  const go = h("button", { type: "submit", class: "text strong" }, does);
  const form = h(
    "form",
    { method: "dialog" },
    name,
    ...content,
    problem,
    h(
      "div",
      { class: "row end" },
      button("Cancel", () => box.close()),
      go,
    ),
  );
  const box = h("dialog", { "aria-labelledby": name.id }, form);
  box.addEventListener("close", () => box.remove());
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    go.disabled = true;
    Promise.resolve(act())
      .then(() => box.close())
      .catch((error: unknown) => complain(form, problem, error))
      .finally(() => (go.disabled = false));
  });
  document.body.append(box);
  box.showModal();
  const first = form.querySelector<HTMLElement>("input, select");
  (first ?? go).focus();
  if (first instanceof HTMLInputElement) first.select();
}

/** Says why something was refused, at the entry that is meant where there is one. */
export function complain(form: HTMLElement, problem: HTMLElement, error: unknown): void {
  for (const old of form.querySelectorAll("[aria-invalid]")) old.removeAttribute("aria-invalid");
  problem.textContent = words(error);
  problem.hidden = false;
  const name = (error as Refusal).field;
  const entry = name ? form.querySelector<HTMLElement>(`[name="${CSS.escape(name)}"]`) : null;
  entry?.setAttribute("aria-invalid", "true");
  entry?.focus();
}

export function confirmed(title: string, told: string, does: string, act: () => Promise<void>): void {
  dialog(title, [h("p", {}, told)], does, act);
}

export function renamed(name: string, act: (name: string) => Promise<void>): void {
  const entry = h("input", {
    type: "text",
    name: "name",
    value: name,
    maxlength: 120,
    required: true,
    "aria-label": "Name",
  });
  dialog("Another name", [entry], "Rename", () => act(entry.value.trim()));
}
