// Frames a second of a motion whose file does not tell them, or tells them wrong: asked for, and said.

import { ask } from "./api";
import type { MotionItem, RatedMotions } from "./contract";
import { complain, dialog } from "./dialogs";
import { button, field, h, say } from "./elements";
import { notice } from "./notices";
import type { Store } from "./store";

const [SLOWEST, FASTEST] = [1, 1000]; // [1/s]

/** Whether the rate of a motion is a guess. */
export function isGuessed({ state, rate, rate_stored, lacks }: MotionItem): boolean {
  return !rate_stored && rate === null && !lacks && (state === "ready" || state === "failed");
}

/** The rate of a motion in words. */
export function rateInWords(item: MotionItem): string {
  const how = item.rate !== null ? ", as you said" : item.rate_stored ? "" : ", assumed";
  return `${rounded(item.fps)} frames a second${how}`;
}

/** Asks for the rate where it is a guess, and shows it where the user said it; nothing where the file tells it. */
export function rateForm(store: Store, item: MotionItem): HTMLElement | undefined {
  if (item.rate_stored && item.rate === null) return undefined;
  const entry = rateEntry(item);
  const others = (store.project?.motions ?? []).filter(
    (other) => other.id !== item.id && isGuessed(other) && ending(other) === ending(item),
  );
  const all = h("input", { type: "checkbox" });
  const problem = h("p", { class: "problem", role: "alert", hidden: true });
  const give = async (fps: number | null): Promise<void> => {
    try {
      await sayRate(store, [item.id, ...(all.checked ? others.map(({ id }) => id) : [])], fps);
    } catch (error) {
      complain(form, problem, error);
    }
  };
  const go = h("button", { type: "submit", class: "text strong" }, item.rate === null ? "That is right" : "Use it");
  entry.addEventListener("input", () => say(go, item.rate === null && Number(entry.value) === rounded(item.fps) ? "That is right" : "Use it"));
  const form: HTMLFormElement = h(
    "form",
    { class: `rate${item.rate === null ? " asks" : ""}`, "aria-label": "Frames a second" },
    h("p", {}, told(item)),
    h(
      "div",
      { class: "row" },
      h("label", {}, entry, " frames a second"),
      go,
      item.rate !== null && button(item.rate_stored ? "As the file says" : "As it was assumed", () => void give(null)),
      item.rate === null &&
        others.length > 0 &&
        h("label", { class: "tick" }, all, h("span", {}, `the same for the ${others.length === 1 ? "" : `${others.length} `}other ${ending(item)} file${others.length === 1 ? "" : "s"}`)),
    ),
    problem,
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    void give(Number(entry.value));
  });
  return form;
}

/** Another rate than that which a file tells. */
export function otherRate(store: Store, item: MotionItem): void {
  const entry = rateEntry(item);
  const words = `The file says ${rounded(item.fps)}. Say what is right if the motion is too slow or too fast.`;
  dialog("Another frame rate", [field("Frames a second", entry), h("p", { class: "soft" }, words)], "Use it", () =>
    sayRate(store, [item.id], Number(entry.value)),
  );
}

function rounded(fps: number): number {
  return Math.round(fps * 1000) / 1000;
}

/** Files of one kind are assumed to be from one place. */
function ending({ name }: MotionItem): string {
  return name.slice(name.lastIndexOf(".")).toLowerCase();
}

function rateEntry({ fps }: MotionItem): HTMLInputElement {
  const value = fps ? rounded(fps) : "";
  return h("input", { type: "number", name: "fps", value, min: SLOWEST, max: FASTEST, step: "any", required: true });
}

function told({ state, fps, rate, rate_stored }: MotionItem): string {
  if (rate !== null) return rate_stored ? "You said another frame rate than the file." : "The file tells no frame rate; you did.";
  if (state === "failed") return "What is the frame rate of this file?";
  return `The file tells no sure frame rate: ${rounded(fps)} frames a second are assumed. Does it move as fast as it should?`;
}

async function sayRate(store: Store, motions: readonly string[], fps: number | null): Promise<void> {
  const { libraries } = await ask<RatedMotions>("PUT", "motions/rate", { motions, fps });
  if (libraries.length) {
    const names = libraries.map(({ name }) => `“${name}”`).join(", ");
    notice(`Built again with it: ${names}. Dances made before stay as they are.`);
  }
  await store.refresh();
}
