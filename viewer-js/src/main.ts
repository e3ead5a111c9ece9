// The page: reads its data, sets the stage, and draws every frame at the time the clock says.

import { Caption } from "./caption";
import { Clicks } from "./clicks";
import { Clock } from "./clock";
import { ClipColours } from "./colours";
import type { PageData } from "./contract";
import { Controls, type Parts } from "./controls";
import { lastBefore, readPage } from "./data";
import { Dancer } from "./dancer";
import { at } from "./elements";
import { Ghosts } from "./ghosts";
import { GraphPanel } from "./graph_panel";
import { Heat } from "./heat";
import { Keyposes } from "./keyposes";
import { Loop } from "./loop";
import { Marks } from "./marks";
import { Master } from "./master";
import { Panel } from "./panel";
import { StoredPath } from "./path";
import { reachOf } from "./presets";
import { Room } from "./room";
import { type Covered, Stage } from "./stage";
import { Timeline } from "./timeline";
import { Tip } from "./tip";

const NARROW = 760; // [px]

function start(): void {
  const page = readPage();
  const parts = partsOf(page);
  const { clock, stage, clicks, keyposes, panel, timeline, loop, graph, now } = parts;
  const controls = new Controls(parts);
  loop.changed = parts.theme.changed = () => controls.tell();
  keyposes.draw(stage.dancer);
  let before = performance.now();
  const frame = (at: number): void => {
    const time = clock.now(at);
    const beat = lastBeat(page, time);
    stage.draw(time, Math.min((at - before) / 1000, 1), beat.since, clock.playing ? beat.strength : 0);
    timeline.draw(time);
    graph.draw(time);
    clicks.update(time);
    keyposes.update(time);
    panel.update(time, beat.since);
    const again = clock.playing ? loop.next(time) : undefined;
    if (again !== undefined) parts.seek(again);
    else if (clock.playing && time >= page.duration) clock.pause();
    before = at;
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
  if (page.audio) {
    clock.load(page.audio).catch((error: unknown) => panel.say(`This browser cannot play the sound: ${String(error)}`));
  }
  expose(parts, now);
}

/** All that the page is made of. */
function partsOf(page: PageData): Parts & { theme: Room } {
  const path = new StoredPath(page);
  const clock = new Clock(page.duration, page.audio !== null);
  const stage = stageOf(page, path);
  const now = (): number => clock.now(performance.now());
  const seek = (time: number): void => {
    clock.seek(time);
    stage.jump();
  };
  const colours = new ClipColours(page.moves.map((move) => move.clip));
  const loop = new Loop(page.duration, page.moves.map((move) => move.at_s));
  const clicks = new Clicks(clock, page);
  const keyposes = new Keyposes(page, clock, at("poses"), at("keypose"), seek);
  const panel = new Panel(page, clock, stage, colours);
  stage.keepClear(wordsAndButtons);
  const tip = new Tip(at("tip"));
  const [detail, overview] = [at<HTMLCanvasElement>("detail"), at<HTMLCanvasElement>("overview")];
  const timeline = new Timeline(detail, overview, at("names"), page, colours, seek, now, loop, () => clock.playing);
  tip.watch(detail, (x, y) => timeline.sayDetail(x, y));
  tip.watch(overview, (x) => timeline.sayOverview(x));
  const [marks, ghosts] = [new Marks(page.steps, page.floor), new Ghosts(page, path)];
  stage.add(marks);
  stage.add(ghosts);
  const graph = new GraphPanel(page, colours, seek, now, tip);
  const theme = new Room(stage, panel);
  return { page, clock, stage, clicks, keyposes, panel, timeline, loop, marks, ghosts, graph, theme, seek, now };
}

/** The dancer on its stage, with whom it is held against. */
function stageOf(page: PageData, path: StoredPath): Stage {
  const compared = page.compared;
  const heat = compared?.heat ? new Heat(compared.heat, page.joints.length, page.fps) : undefined;
  const dancer = new Dancer(page, path, heat);
  const tall = dancer.standing(page.duration);
  const company = compared && {
    master: new Master(compared, page, tall),
    captions: compared.captions.map((words) => new Caption(words, page.floor, tall)),
  };
  const stage = new Stage(at<HTMLCanvasElement>("scene"), page, dancer, company ?? undefined);
  const reach = reachOf(path, page.joints.length, page.spine[0], page.duration, page.floor + 0.5 * tall);
  stage.survey(reach, Math.max(tall, company?.master.tall ?? 0));
  return stage;
}

/** What lies over the dancer on a narrow screen: on a wide one words and buttons are beside it. */
function wordsAndButtons(): Covered {
  const [floor, words, buttons] = ["floor", "subtitle", "shown"].map((id) => at(id).getBoundingClientRect());
  if (floor.width > NARROW) return { top: 0, bottom: 0 };
  const [top, bottom] = [words.bottom - floor.top, buttons.height && floor.bottom - buttons.top];
  return { top: Math.max(top, 0), bottom: Math.max(bottom, 0) };
}

function lastBeat(page: PageData, time: number): { since: number; strength: number } {
  const index = lastBefore(page.beats, time);
  if (index < 0) return { since: 9, strength: 0 };
  const down = lastBefore(page.downbeats, time);
  const first = down >= 0 && Math.abs(page.downbeats[down] - page.beats[index]) < 0.01;
  return { since: time - page.beats[index], strength: first ? 1 : 0.55 };
}

/** A small door for scripts and tests: `onbeat.state()`, `onbeat.seek(12)`, `onbeat.play()`, `onbeat.pause()`. */
function expose({ page, clock, stage, clicks, keyposes, loop, marks, ghosts, timeline, seek }: Parts, now: () => number): void {
  const state = () => ({
    time: now(),
    heard: clock.heard() ?? null,
    posed: stage.posed,
    playing: clock.playing,
    rate: clock.rate,
    sound: clock.hasSound,
    clicks: clicks.sounded,
    keypose: keyposes.at(now()),
    duration: page.duration,
    names: page.joints,
    joints: Array.from(stage.dancer.joints),
    heat: Array.from(stage.dancer.heat?.levels ?? []),
    master: stage.master?.place ?? null,
    size: stage.master?.dancer.group.scale.x ?? 1,
    other: Array.from(stage.master?.dancer.joints ?? []),
    view: stage.view ?? null,
    follow: stage.follow,
    camera: stage.eye,
    loop: loop.chosen ? [loop.from, loop.to, loop.on] : null,
    ghosts: ghosts.chosen,
    standing: marks.standing(now()).map(({ foot }) => foot),
    lanes: timeline.around(),
  });
  Object.assign(window, { onbeat: { state, seek, play: () => clock.play(), pause: () => clock.pause() } });
}

try {
  start();
} catch (error) {
  const message = at("message");
  message.hidden = false;
  message.textContent = error instanceof Error ? error.message : String(error);
}
