// Files that are dropped anywhere on the page, or chosen: songs are listened to, motions looked at.

import { send, words } from "./api";
import { type Parcel, parcels } from "./belonging";
import type { SongItem, TakenMotions } from "./contract";
import { droppedFiles } from "./dropped_files";
import { at } from "./elements";
import { notice } from "./notices";
import { named, Refusals } from "./refusals";
import type { Store } from "./store";
import { go } from "./view";
import { isSkeleton } from "./words";

const FEW = 4; // files that are named one by one

/** A file on its way to the server. */
export interface Sending {
  key: string;
  name: string;
  kind: "song" | "motion";
  share: number; // 0…1 of it has gone
}

export class Dropping {
  sending: Sending[] = [];
  private depth = 0;
  private count = 0;

  constructor(
    private readonly store: Store,
    private readonly changed: () => void,
  ) {
    const files = (event: DragEvent): boolean => event.dataTransfer?.types.includes("Files") ?? false;
    addEventListener("dragenter", (event) => files(event) && this.hover(1));
    addEventListener("dragleave", (event) => files(event) && this.hover(-1));
    addEventListener("dragover", (event) => files(event) && event.preventDefault());
    addEventListener("drop", (event) => {
      if (!files(event)) return;
      event.preventDefault();
      this.hover(-this.depth);
      void droppedFiles(event.dataTransfer).then(
        (folders) => this.take(folders),
        () => notice("The folder could not be read: drop the files in it, or a zip of them.", true),
      );
    });
    const chooser = at("files") as HTMLInputElement;
    chooser.addEventListener("change", () => {
      const chosen = Array.from(chooser.files ?? []);
      chooser.value = "";
      void this.take([chosen]);
    });
  }

  choose(): void {
    at("files").click();
  }

  /** One after the other: the server's line is not made wider by many at once. What is taken first is shown. */
  async take(folders: readonly (readonly File[])[]): Promise<void> {
    const here = location.hash;
    const refusals = new Refusals();
    if (!folders.flat().length) notice("There is no file in what was dropped.", true);
    const all = folders.flatMap(parcels).sort((a, b) => Number(b.kind === "song") - Number(a.kind === "song"));
    const entries = all.map((parcel) => ({ parcel, entry: this.entry(parcel, refusals) }));
    for (const { parcel, entry } of entries) {
      if (entry) await this.give(parcel, entry, refusals, () => location.hash === here);
    }
    refusals.end();
  }

  private entry(parcel: Parcel, refusals: Refusals): Sending | undefined {
    const largest = this.store.project?.largest ?? Infinity;
    if (parcel.bytes > largest) {
      refusals.add(parcel.names, `${megabytes(parcel.bytes)} are too much; this studio takes up to ${megabytes(largest)} at once.`);
      return undefined;
    }
    const entry: Sending = { key: `sending${++this.count}`, name: parcel.name, kind: parcel.kind, share: 0 };
    this.sending = [...this.sending, entry];
    this.changed();
    return entry;
  }

  private async give(parcel: Parcel, entry: Sending, refusals: Refusals, free: () => boolean): Promise<void> {
    const told = (share: number): void => {
      entry.share = share;
      this.changed();
    };
    try {
      const file = await parcel.file();
      const id = parcel.kind === "song" ? (await send<SongItem>("songs", file, told)).id : await this.motions(file, told);
      if (id && free()) go(parcel.kind, id);
    } catch (error) {
      refusals.add(parcel.names, words(error));
    }
    this.sending = this.sending.filter((other) => other !== entry);
    await this.store.refresh();
    this.changed();
  }

  /** The motion to show, where it is one. */
  private async motions(file: File, told: (share: number) => void): Promise<string | undefined> {
    const { motions, passed_over, found } = await send<TakenMotions>("motions", file, told);
    const bodies = motions.filter(({ name }) => !isSkeleton(name));
    if (bodies.length > 1) notice(`${bodies.length} motions came out of ${file.name}.`);
    if (found.length) notice(`Read now, for the skeleton has come: ${found.length > FEW ? `${found.length} motions` : named(found.map(({ name }) => name))}.`);
    const lacking = bodies.filter(({ lacks }) => lacks).map(({ name }) => name);
    if (bodies.length > 1 && lacking.length) notice(`Waiting for a skeleton (.asf): ${named(lacking)}.`);
    if (passed_over.length)
      notice(`Not taken, for it is no motion and belongs to none: ${named(passed_over)}.`, true);
    const shown = bodies.length ? bodies : found.length ? found : motions;
    return shown.length === 1 || (!bodies.length && found.length) ? shown[0].id : undefined;
  }

  private hover(by: number): void {
    this.depth = Math.max(this.depth + by, 0);
    at("drop").hidden = this.depth === 0;
  }
}

function megabytes(bytes: number): string {
  return `${(bytes / 2 ** 20).toLocaleString("en", { maximumFractionDigits: bytes < 2 ** 20 ? 2 : 0 })} MB`;
}
