// A dance: it plays with its song, over its timeline, alone or beside another on the same clock.

import { readCurve } from "../data";
import { ask, words } from "./api";
import { Clicks } from "./clicks";
import type { DanceItem, DanceOrder, DanceView as Danced, SongView } from "./contract";
import { DanceTools } from "./dance_tools";
import { button, h, say } from "./elements";
import { Entries } from "./entries";
import { GraphView } from "./graph_view";
import { LockList } from "./lock_list";
import { Locks, type Stretch } from "./locks";
import { notice } from "./notices";
import { LIKE } from "./order_view";
import { palette } from "./palette";
import { pending } from "./pending";
import { Score } from "./score";
import { StageTools } from "./stage_tools";
import { Transport } from "./transport";
import { go, type Studio, type View } from "./view";
import { exactly, nextName } from "./words";

/** What is there once a dance is ready. */
interface Shown {
  danced: Danced;
  score: Score;
  transport: Transport;
  tools: DanceTools;
  locks: Locks;
  clicks: Clicks;
  stage: StageTools;
  graph: GraphView;
}

export class DanceView implements View {
  readonly root = h("article", { class: "view dance" });
  title = "Dance";
  private shown?: Shown;
  private other?: Danced;
  private asked = false;
  private opening?: number; // [s] where a locked stretch begins that has no end yet
  private readonly name = h("h2", {});

  constructor(
    private readonly studio: Studio,
    private readonly id: string,
    private readonly besideAtFirst = "",
  ) {
    this.update();
  }

  update(): void {
    const item = this.studio.store.dance(this.id);
    if (!item)
      return void this.root.replaceChildren(h("p", { class: "empty" }, "This dance is not in the project any more."));
    this.title = item.name;
    if (item.state !== "ready")
      return pending(this.root, this.studio.store, item, "This dance", "dances", this.otherwise(item));
    say(this.name, item.name);
    this.shown?.tools.update(item);
    if (!this.asked) void this.open();
  }

  frame(time: number, seconds: number): void {
    const { shown, other, studio } = this;
    if (!shown) return;
    shown.transport.update(time);
    shown.clicks.update(time);
    const { playing } = studio.player;
    studio.looks[0].draw(time, seconds, playing);
    if (other) studio.looks[1].draw(this.besideOf(time), seconds, playing);
    shown.score.track.draw(time, playing);
    shown.graph.draw(time);
  }

  key(event: KeyboardEvent): boolean {
    const { shown } = this;
    if (!shown) return false;
    const now = this.studio.player.now(performance.now());
    if (event.key === "[") {
      this.opening = now;
      notice(`A locked stretch begins at ${exactly(now)}: go on, and press ] where it ends.`);
    } else if (event.key === "]") {
      shown.locks.add(this.opening ?? 0, now);
      this.opening = undefined;
    } else if (event.key.toLowerCase() === "g") shown.graph.toggle();
    else return shown.stage.key(event) || shown.score.track.key(event) || shown.transport.key(event);
    return true;
  }

  dim(): void {
    this.shown?.score.track.stale();
  }

  close(): void {
    this.shown?.clicks.stop();
    this.studio.looks[1].clear();
  }

  state(): Record<string, unknown> {
    return {
      dance: this.id,
      ready: this.shown !== undefined,
      beside: this.other?.item.id ?? null,
      clicks: this.shown?.clicks.sounded ?? 0,
      locks: this.shown?.locks.stretches ?? [],
      besideTime: this.other ? this.besideOf(this.studio.player.now(performance.now())) : null,
      names: this.shown?.danced.scene.joints ?? [],
      floor: this.shown?.danced.scene.floor ?? 0,
    };
  }

  private async open(): Promise<void> {
    this.asked = true;
    try {
      this.show(await ask<Danced>("GET", `dances/${this.id}`));
    } catch (error) {
      this.asked = false;
      this.root.replaceChildren(h("p", { class: "problem", role: "alert" }, words(error)));
    }
  }

  private show(danced: Danced): void {
    const { player, looks, store } = this.studio;
    const { item, scene } = danced;
    player.load({
      url: `/api/songs/${item.song}/sound`,
      start: item.start,
      speed: item.speed,
      duration: scene.duration,
    });
    const entries = new Entries(store, `locks/${this.id}`);
    const locks = new Locks(scene.duration, () => {
      entries.set("stretches", JSON.stringify(locks.stretches));
      list.show();
      score.track.stale();
    });
    const kept = JSON.parse(entries.get("stretches") ?? "[]") as Stretch[];
    locks.stretches = kept.filter(({ to }) => to <= scene.duration);
    const list = new LockList(locks, () => void this.again(item));
    const score = new Score(scene, player, item.kind === "danced" ? locks : undefined, () =>
      palette(this.studio.dark()),
    );
    const starts = new Set(scene.downbeats);
    const clicks = new Clicks(player, () => ({ times: scene.beats, down: (i) => starts.has(scene.beats[i]) }));
    const transport = new Transport(player, { clicks, looks });
    const tools = new DanceTools(store, item, danced, this.besideAtFirst);
    const [stage, graph] = [new StageTools(looks), new GraphView(scene, player)];
    this.shown = { danced, score, transport, tools, locks, clicks, stage, graph };
    tools.beside.addEventListener("change", () => void this.compare(tools.beside.value));
    void this.hear(item, score);
    this.lay(item, list.root);
    looks[0].show(scene, "", `${item.name}, danced`);
    stage.tell();
    if (tools.beside.value) void this.compare(tools.beside.value);
  }

  private async hear(item: DanceItem, score: Score): Promise<void> {
    try {
      const { waveform } = await ask<SongView>("GET", `songs/${item.song}`);
      score.sound(readCurve(waveform), item.start, item.speed);
    } catch {
      // the song was taken away: the dance shows without it
    }
  }

  /** The song's own tempo, where the dance goes at half or double of it. */
  private heard(item: DanceItem, danced: number): string {
    const tempo = (this.studio.store.project?.songs.find(({ id }) => id === item.order.song)?.tempo ?? 0) * item.speed;
    return tempo > 0 && Math.abs(Math.log2(tempo / danced)) > 0.8 ? ` (${Math.round(tempo)} heard)` : "";
  }

  /** Which part of its song is danced. */
  private stretch({ song: id, start, speed }: DanceItem, seconds: number): string {
    const song = this.studio.store.project?.songs.find((one) => one.id === id);
    const end = start + seconds * speed;
    if (song && start < 0.05 && end > song.duration - 0.1) return "the whole song";
    return `from ${exactly(start)} to ${exactly(end)}${song ? ` of ${exactly(song.duration)}` : ""}`;
  }

  private lay(item: DanceItem, locks: HTMLElement): void {
    const { danced, score, transport, tools, stage, graph } = this.shown as Shown;
    const { order } = item;
    const facts = [
      exactly(danced.scene.duration),
      this.stretch(item, danced.scene.duration),
      item.robot ?? order.method,
      `λ ${order.intensity_weight}`,
      `seed ${order.seed}`,
    ];
    if (danced.scene.tempo > 0) facts.splice(2, 0, `${Math.round(danced.scene.tempo)} beats a minute${this.heard(item, danced.scene.tempo)}`);
    if (item.speed !== 1) facts.push(`×${item.speed.toFixed(2)}`);
    if (item.f50 !== null) facts.push(`F50 ${item.f50.toFixed(2)}`);
    this.root.replaceChildren(
      h(
        "div",
        { class: "middle" },
        h(
          "header",
          { class: "head" },
          h(
            "div",
            {},
            this.name,
            h("p", { class: "facts" }, facts.join(" · ")),
            item.note && h("p", { class: "note" }, item.note),
          ),
          this.otherwise(item),
        ),
        h("div", { class: "looks" }, ...this.studio.looks.map(({ root }) => root), stage.root),
        transport.root,
        score.root,
        item.kind === "danced" && locks,
        graph.root,
      ),
      tools.root,
    );
    this.studio.looks[1].root.hidden = true;
  }

  private otherwise(item: DanceItem): HTMLElement | undefined {
    if (item.kind !== "danced") return undefined;
    return button("Dance it otherwise", () => go("order", `${LIKE}/${item.id}`));
  }

  /** Where the second dance is while the first is at `time`: both are heard at the same second of the song. */
  private besideOf(time: number): number {
    const [one, other] = [this.shown?.danced.item, this.other?.item];
    if (!one || !other || one.song !== other.song) return time;
    return (one.start + time * one.speed - other.start) / other.speed;
  }

  private besideBack(time: number): number {
    const [one, other] = [this.shown?.danced.item, this.other?.item];
    if (!one || !other || one.song !== other.song) return time;
    return (other.start + time * other.speed - one.start) / one.speed;
  }

  private async compare(id: string): Promise<void> {
    const { looks } = this.studio;
    const { danced, score, stage } = this.shown as Shown;
    try {
      this.other = id ? await ask<Danced>("GET", `dances/${id}`) : undefined;
    } catch (error) {
      return notice(words(error), true);
    }
    const { other } = this;
    this.root.classList.toggle("compared", other !== undefined);
    looks[1].root.hidden = !other;
    looks[0].show(danced.scene, other ? danced.item.name : "", `${danced.item.name}, danced`);
    stage.tell();
    score.compare(other && { name: other.item.name, scene: other.scene, at: (time) => this.besideBack(time) });
    if (!other) return looks[1].clear();
    looks[1].show(other.scene, other.item.name, `${other.item.name}, danced`);
    if (other.item.song !== danced.item.song)
      notice("The two dances have different songs: both begin together, and the first one's song is heard.");
  }

  private async again(item: DanceItem): Promise<void> {
    const { locks } = this.shown as Shown;
    const keep = locks.stretches.map(({ from, to }) => ({ dance: item.id, from_s: from, to_s: to }));
    await this.order({ ...item.order, keep, seed: item.order.seed + 1, name: nextName(item.name) }, item.id);
  }

  private async order(order: DanceOrder, beside = ""): Promise<void> {
    try {
      const made = await ask<DanceItem>("POST", "dances", order);
      await this.studio.store.refresh();
      go("dance", beside ? `${made.id}/${beside}` : made.id);
    } catch (error) {
      notice(words(error), true);
    }
  }
}
