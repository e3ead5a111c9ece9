// What is shown of something on which a job still works, or failed.

import { ask, words } from "./api";
import type { JobItem } from "./contract";
import { button, h, say } from "./elements";
import { notice } from "./notices";
import type { Store } from "./store";
import { left, plainName } from "./words";

interface Worked {
  id: string;
  name: string;
  state: "waiting" | "ready" | "failed" | "cancelled";
  job: string | null;
  error: string | null;
}

/** A bar, words, and a button that ends the job; brought up to date by `showJob`. */
export function jobBar(job: JobItem): HTMLElement {
  const bar = h("progress", { max: 1, "aria-label": job.title });
  const stop = button("Cancel", () => void cancel(job.id), { "aria-label": `Cancel: ${job.title}` });
  const element = h("div", { class: "job" }, h("span", { class: "what" }), bar, h("span", { class: "soft" }), stop);
  showJob(element, job);
  return element;
}

export function showJob(element: HTMLElement, job: JobItem): void {
  const [what, bar, told, stop] = Array.from(element.children) as [
    HTMLElement,
    HTMLProgressElement,
    HTMLElement,
    HTMLButtonElement,
  ];
  say(what, job.title);
  if (job.state === "waiting") bar.removeAttribute("value");
  else bar.value = job.share;
  const share = `${Math.round(100 * job.share)} %`;
  const going = [job.message, share, left(job.left_s)].filter(Boolean).join(" · ");
  say(
    told,
    job.state === "waiting" ? "waits for its turn" : job.state === "running" ? going : (job.error ?? job.state),
  );
  stop.hidden = job.state !== "waiting" && job.state !== "running";
}

export function pending(
  root: HTMLElement,
  store: Store,
  item: Worked,
  what: string,
  where: "songs" | "motions" | "libraries" | "dances",
  otherwise?: HTMLElement,
): void {
  const job = store.job(item.job);
  if (item.state === "waiting" && job) {
    const shown = root.querySelector<HTMLElement>(`.job[data-job="${CSS.escape(job.id)}"]`);
    if (shown) return showJob(shown, job);
    const bar = jobBar(job);
    bar.dataset.job = job.id;
    return root.replaceChildren(
      h("div", { class: "pending" }, h("h2", {}, plainName(item.name)), bar, h("p", {}, "You can do something else meanwhile; it goes on.")),
    );
  }
  const why =
    item.state === "cancelled"
      ? `${what} was cancelled.`
      : item.state === "failed"
        ? (item.error ?? `${what} failed.`)
        : `${what} is not ready yet.`;
  if (root.querySelector("[role=status]")?.textContent === why) return;
  const ended = item.state === "failed" || item.state === "cancelled";
  root.replaceChildren(
    h(
      "div",
      { class: "pending" },
      h("h2", {}, plainName(item.name)),
      h("p", { class: item.state === "failed" ? "problem" : "soft", role: "status" }, why),
      ended &&
        h("div", { class: "row" }, button("Try again", () => void again(store, `${where}/${item.id}/again`)), otherwise),
    ),
  );
}

async function again(store: Store, path: string): Promise<void> {
  try {
    await ask("POST", path);
    await store.refresh();
  } catch (error) {
    notice(words(error), true);
  }
}

async function cancel(job: string): Promise<void> {
  try {
    await ask("POST", `jobs/${job}/cancel`);
  } catch (error) {
    notice(words(error), true);
  }
}
