// Files that are dropped anywhere on the page, or chosen: songs are listened to, motions looked at.

import { send, words } from "./api";
import type { MotionItem, SongItem } from "./contract";
import { at } from "./elements";
import { notice } from "./notices";
import type { Store } from "./store";
import { go } from "./view";
import { zipped } from "./zip";

const SOUNDS = /\.(wav|flac|ogg|oga|mp3|m4a|aac|mp4|mov|mkv|webm|aif|aiff|opus)$/i;
const BESIDE = /\.(asf|toml)$/i; // what motion files need beside them

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
      void this.take(Array.from(event.dataTransfer?.files ?? []));
    });
    const chooser = at("files") as HTMLInputElement;
    chooser.addEventListener("change", () => {
      const chosen = Array.from(chooser.files ?? []);
      chooser.value = "";
      void this.take(chosen);
    });
  }

  choose(): void {
    at("files").click();
  }

  /** One after the other: the server's line is not made wider by many at once. */
  async take(chosen: readonly File[]): Promise<void> {
    const files = await together(chosen);
    const entries = files.map((file) => ({ file, entry: this.entry(file) }));
    for (const { file, entry } of entries) if (entry) await this.give(file, entry);
  }

  private entry(file: File): Sending | undefined {
    const largest = this.store.project?.largest ?? Infinity;
    if (file.size > largest) {
      notice(`${file.name} has ${megabytes(file.size)}; this studio takes files of up to ${megabytes(largest)}.`, true);
      return undefined;
    }
    const kind = isSound(file) ? "song" : "motion";
    const entry: Sending = { key: `sending${++this.count}`, name: file.name, kind, share: 0 };
    this.sending = [...this.sending, entry];
    this.changed();
    return entry;
  }

  private async give(file: File, entry: Sending): Promise<void> {
    const told = (share: number): void => {
      entry.share = share;
      this.changed();
    };
    try {
      if (entry.kind === "song") go("song", (await send<SongItem>("songs", file, told)).id);
      else await this.motions(file, told);
    } catch (error) {
      const why = words(error);
      notice(why.includes(entry.name) ? why : `${entry.name}: ${why}`, true);
    }
    this.sending = this.sending.filter((other) => other !== entry);
    await this.store.refresh();
    this.changed();
  }

  private async motions(file: File, told: (share: number) => void): Promise<void> {
    const made = await send<MotionItem[]>("motions", file, told);
    if (made.length === 1 && !location.hash.startsWith("#song")) go("motion", made[0].id);
    if (made.length > 1) notice(`${made.length} motions came out of ${file.name}.`);
  }

  private hover(by: number): void {
    this.depth = Math.max(this.depth + by, 0);
    at("drop").hidden = this.depth === 0;
  }
}

/** Skeletons and roles files go in one archive with the motion files that came with them. */
async function together(files: readonly File[]): Promise<readonly File[]> {
  const beside = files.filter(({ name }) => BESIDE.test(name));
  const wanted = beside.some(({ name }) => /\.toml$/i.test(name)) ? /./ : /\.amc$/i;
  const motions = files.filter((file) => !beside.includes(file) && wanted.test(file.name) && !isSound(file) && !/\.zip$/i.test(file.name));
  if (!beside.length || !motions.length) return files;
  const archive = await zipped([...beside, ...motions], beside[0].name.replace(BESIDE, ".zip"));
  return [...files.filter((file) => !beside.includes(file) && !motions.includes(file)), archive];
}

function isSound({ name, type }: File): boolean {
  return SOUNDS.test(name) || type.startsWith("audio/");
}

function megabytes(bytes: number): string {
  return `${(bytes / 2 ** 20).toLocaleString("en", { maximumFractionDigits: bytes < 2 ** 20 ? 2 : 0 })} MB`;
}
