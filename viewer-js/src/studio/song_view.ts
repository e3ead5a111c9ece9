// A song: what is heard in it, and its beats put right.

import { ask, words } from "./api";
import { BeatEditor } from "./beat_editor";
import { BeatSheet } from "./beat_sheet";
import { Clicks } from "./clicks";
import type { SongItem, SongView as Heard } from "./contract";
import { confirmed } from "./dialogs";
import { button, h, say } from "./elements";
import { corrected } from "./in_words";
import { notice } from "./notices";
import { palette } from "./palette";
import { pending } from "./pending";
import { Transport } from "./transport";
import { go, type Studio, type View } from "./view";
import { exactly, pace, plainName } from "./words";

const KEEP_AFTER = 500; // [ms] without a change, the beats are sent
/** Of each song the beats with every step, as long as the page is open; and what is still on its way to the server. */
const sheets = new Map<string, BeatSheet>();
const leaving = new Map<string, Promise<void>>();

export class SongView implements View {
  readonly root = h("article", { class: "view song" });
  title = "Song";
  private heard?: Heard;
  private sheet?: BeatSheet;
  private editor?: BeatEditor;
  private transport?: Transport;
  private clicks?: Clicks;
  private asked = false;
  private waiting?: ReturnType<typeof setTimeout>;
  private readonly kept = h("span", { class: "soft", role: "status" });
  private readonly facts = h("p", { class: "facts" });
  private readonly back = button("Back to what was heard", () => this.restore());

  constructor(
    private readonly studio: Studio,
    private readonly id: string,
  ) {
    this.update();
  }

  update(): void {
    const item = this.studio.store.project?.songs.find(({ id }) => id === this.id);
    if (!item)
      return void this.root.replaceChildren(h("p", { class: "empty" }, "This song is not in the project any more."));
    this.title = plainName(item.name);
    if (item.state !== "ready") return pending(this.root, this.studio.store, item, "This song", "songs");
    if (!this.asked) void this.open(item);
  }

  frame(time: number): void {
    this.transport?.update(time);
    this.clicks?.update(time);
    this.editor?.track.draw(time, this.studio.player.playing);
  }

  key(event: KeyboardEvent): boolean {
    return (this.editor?.key(event) || this.transport?.key(event)) ?? false;
  }

  dim(): void {
    this.editor?.track.stale();
  }

  close(): void {
    this.clicks?.stop();
    if (this.waiting !== undefined) leaving.set(this.id, this.keep());
  }

  state(): Record<string, unknown> {
    return {
      beats: this.sheet?.times ?? [],
      downbeats: this.sheet?.downbeats ?? [],
      clicks: this.clicks?.sounded ?? 0,
      unsent: this.waiting !== undefined,
    };
  }

  private async open(item: SongItem): Promise<void> {
    this.asked = true;
    await leaving.get(this.id); // what was changed when it was left
    try {
      this.heard = await ask<Heard>("GET", `songs/${this.id}`);
    } catch (error) {
      this.asked = false;
      this.root.replaceChildren(h("p", { class: "problem", role: "alert" }, words(error)));
      return;
    }
    this.show(item, this.heard);
  }

  private show(item: SongItem, heard: Heard): void {
    const { player } = this.studio;
    const sheet = sheets.get(this.id) ?? new BeatSheet(heard.duration);
    sheets.set(this.id, sheet);
    this.sheet = sheet;
    sheet.changed = () => this.changed();
    sheet.open(heard.beats, heard.downbeats);
    const colours = () => palette(this.studio.dark());
    const downs = () => sheet.beats;
    this.clicks = new Clicks(player, () => ({ times: sheet.times, down: (i) => downs()[i]?.down ?? false }));
    this.editor = new BeatEditor(heard, sheet, player, colours, [this.back]);
    this.transport = new Transport(player, { clicks: this.clicks });
    player.load({ url: `/api/songs/${this.id}/sound`, start: 0, speed: 1, duration: heard.duration });
    this.root.replaceChildren(
      h(
        "header",
        { class: "head" },
        h("div", {}, h("h2", {}, plainName(item.name)), this.facts),
        h(
          "div",
          { class: "row" },
          this.kept,
          button("Dance to this song", () => go("order", this.id), { class: "text strong" }),
        ),
      ),
      this.editor.root,
      this.transport.root,
    );
    this.tell();
  }

  private tell(): void {
    const { heard, sheet } = this;
    if (!heard || !sheet) return;
    const facts = [
      exactly(heard.duration),
      pace(heard.tempo),
      ...(heard.tempo > 0 ? [`${sheet.meter} in a bar`] : []),
      `${sheet.beats.length} beats`,
    ];
    const { own, gone } = corrected(sheet.beats, heard.heard_beats);
    if (own || gone) facts.push(`${own} put right${gone > own ? `, ${gone - own} taken away` : ""}`);
    if (heard.key) facts.push(heard.key.replace("b:", "♭:").replace(":", " "));
    say(this.facts, facts.join(" · "));
    this.back.disabled = !heard.edited && this.waiting === undefined;
  }

  private changed(): void {
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => void this.keep(), KEEP_AFTER);
    say(this.kept, "keeping …");
    this.clicks?.anew();
    this.editor?.show();
    this.tell();
  }

  private async keep(): Promise<void> {
    clearTimeout(this.waiting);
    this.waiting = undefined;
    if (!this.sheet || !this.heard) return;
    const { times: beats, downbeats } = this.sheet;
    try {
      this.heard = { ...this.heard, edited: true };
      this.heard = await ask<Heard>("PUT", `songs/${this.id}/beats`, { beats, downbeats });
      say(this.kept, "your beats are kept");
    } catch (error) {
      say(this.kept, "not kept");
      notice(words(error), true);
    }
    this.tell();
  }

  private restore(): void {
    const told =
      "Your corrections are put aside, and the beats are again as they were heard. You can undo this as long as this page is open.";
    confirmed("Back to what was heard?", told, "Take them back", async () => {
      clearTimeout(this.waiting);
      this.waiting = undefined;
      const heard = await ask<Heard>("DELETE", `songs/${this.id}/beats`);
      this.sheet?.replace(heard.beats, heard.downbeats);
      clearTimeout(this.waiting);
      this.waiting = undefined;
      this.heard = heard;
      say(this.kept, "as it was heard");
      this.tell();
    });
  }
}
