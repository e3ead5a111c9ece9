// What is known of the project, and the line to the server by which it is kept up to date. When the server was restarted
// everything is asked for again.

import { ask, words } from "./api";
import { type DanceItem, type EventData, type JobItem, type Project, VERSION } from "./contract";

const [SOON, LATER] = [400, 3000]; // [ms] before the line is tried again
const ENDED = new Set(["done", "failed", "cancelled"]);

export class Store {
  project?: Project;
  connected = false;
  problem = ""; // why there is no project
  private revision = -1; // that was asked for last
  private asking = false;
  private tries = 0;
  private line?: EventSource;
  private readonly listeners: (() => void)[] = [];

  listen(listener: () => void): void {
    this.listeners.push(listener);
  }

  open(): void {
    this.line?.close();
    const line = new EventSource("/api/events");
    this.line = line;
    line.onopen = () => {
      this.tries = 0;
      void this.refresh();
    };
    line.onmessage = ({ data }) => this.take(data as string);
    line.onerror = () => this.lose();
  }

  /** Asks for the whole project; once more, if it changed meanwhile. */
  async refresh(): Promise<void> {
    if (this.asking) {
      this.revision = Infinity;
      return;
    }
    this.asking = true;
    this.revision = -1;
    try {
      this.know(await ask<Project>("GET", "project"));
    } catch (error) {
      this.problem = words(error);
      this.connected = false;
    }
    this.asking = false;
    this.tell();
    if (this.connected && this.revision > (this.project?.revision ?? 0)) void this.refresh();
  }

  job(id: string | null): JobItem | undefined {
    return id === null ? undefined : this.project?.jobs.find((job) => job.id === id);
  }

  /** Jobs that wait or run. */
  get active(): JobItem[] {
    return (this.project?.jobs ?? []).filter(({ state }) => !ENDED.has(state));
  }

  dance(id: string): DanceItem | undefined {
    return this.project?.dances.find((dance) => dance.id === id);
  }

  private know(project: Project): void {
    if (project.version !== VERSION) {
      throw new Error(`This page speaks version ${VERSION} and the server ${project.version}: load the page again.`);
    }
    this.project = project;
    this.connected = true;
    this.problem = "";
  }

  private take(data: string): void {
    let event: Partial<EventData>;
    try {
      event = JSON.parse(data) as Partial<EventData>;
    } catch {
      return; // a line that was cut: the next revision brings what it told
    }
    if (event.job) this.goOn(event.job);
    if (typeof event.revision === "number" && event.revision !== this.project?.revision) void this.refresh();
  }

  private goOn(job: JobItem): void {
    if (!this.project) return;
    const known = this.project.jobs.some(({ id }) => id === job.id);
    const jobs = known ? this.project.jobs.map((old) => (old.id === job.id ? job : old)) : [...this.project.jobs, job];
    this.project = { ...this.project, jobs };
    this.tell();
    if (ENDED.has(job.state)) void this.refresh();
  }

  private lose(): void {
    this.line?.close();
    this.connected = false;
    this.tell();
    if (this.tries++ === 1) void this.refresh(); // a server that refuses says why
    setTimeout(() => this.open(), this.tries < 4 ? SOON : LATER);
  }

  private tell(): void {
    for (const listener of this.listeners) listener();
  }
}
