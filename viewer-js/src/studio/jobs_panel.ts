// The jobs that wait and run, under a button that counts them.

import { at, keyed, say } from "./elements";
import { jobBar, showJob } from "./pending";
import type { Store } from "./store";
import { plural } from "./words";

export class JobsPanel {
  private readonly panel = at("jobs") as HTMLDetailsElement;
  private readonly list = at("job-list");

  constructor(private readonly store: Store) {
    addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || !this.panel.open) return;
      this.panel.open = false;
      this.panel.querySelector("summary")?.focus();
    });
    addEventListener("pointerdown", (event) => {
      if (!this.panel.contains(event.target as Node)) this.panel.open = false;
    });
  }

  update(): void {
    const jobs = this.store.active;
    say(at("job-count"), jobs.length ? plural(jobs.length, "job") : "no jobs");
    this.panel.classList.toggle("busy", jobs.length > 0);
    at("no-jobs").hidden = jobs.length > 0;
    const row = (): HTMLElement => document.createElement("li");
    keyed(
      this.list,
      jobs,
      ({ id }) => id,
      row,
      (element, job) => {
        const bar = element.firstElementChild as HTMLElement | null;
        if (bar) showJob(bar, job);
        else element.append(jobBar(job));
      },
    );
  }
}
