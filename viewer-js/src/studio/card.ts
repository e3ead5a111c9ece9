// One thing of the project on the shelf: its name, what it is, and how far the job on it is.

import type { JobItem } from "./contract";
import { h, say } from "./elements";
import { isSkeleton, left } from "./words";

export interface CardData {
  kind: "song" | "motion" | "library" | "dance";
  id: string;
  name: string;
  line: string;
  state: "waiting" | "ready" | "failed" | "cancelled";
  error: string | null;
  job?: JobItem;
  kept?: boolean; // it is always there
  lacks?: string; // what it waits for that nobody works on
  sending?: number; // 0…1 of its file has gone to the server
}

export function card({ kind, id, name, kept, sending }: CardData, remove: () => void): HTMLElement {
  const link = h(
    "a",
    { href: sending === undefined ? `#${kind}/${encodeURIComponent(id)}` : "#" },
    h("b"),
    h("span", { class: "soft" }),
  );
  if (sending !== undefined) link.removeAttribute("href");
  const bar = h("progress", { max: 1, "aria-label": `Progress: ${name}`, hidden: true });
  const away = h(
    "button",
    { type: "button", class: "away", "aria-label": `Take away: ${name}`, title: "Take away", onclick: remove },
    "×",
  );
  return h("li", { class: "card" }, link, kept || sending !== undefined ? null : away, bar);
}

export function showCard(element: HTMLElement, one: CardData, here: boolean): void {
  const [link, bar] = [
    element.querySelector("a") as HTMLElement,
    element.querySelector("progress") as HTMLProgressElement,
  ];
  say(link.children[0], one.name);
  (link.children[0] as HTMLElement).title = one.name;
  say(link.children[1], line(one));
  (link.children[1] as HTMLElement).title = one.state === "ready" ? "" : (one.error ?? line(one));
  link.children[1].className =
    one.state === "failed" ? "bad" : one.lacks && !isSkeleton(one.name) ? "lacks" : one.state === "waiting" && !one.lacks ? "soft works" : "soft";
  if (here) link.setAttribute("aria-current", "page");
  else link.removeAttribute("aria-current");
  const share = one.sending ?? (one.job?.state === "running" ? one.job.share : undefined);
  bar.hidden = one.state !== "waiting" || Boolean(one.lacks);
  if (share === undefined) bar.removeAttribute("value");
  else bar.value = share;
}

function line({ state, line: ready, error, job, lacks, sending }: CardData): string {
  if (lacks) return lacks;
  if (sending !== undefined) return `sending, ${Math.round(100 * sending)} %`;
  if (state === "failed") return error ?? "failed";
  if (state === "cancelled") return "cancelled";
  if (state === "ready") return ready;
  if (job?.state !== "running") return "waits for its turn";
  return [left(job.left_s), job.message].filter(Boolean).join(" · ") || "works";
}
