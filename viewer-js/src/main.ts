// The page: reads its data, sets the stage, and draws every frame at the time the clock says.

import { Caption } from "./caption";
import { Clicks } from "./clicks";
import { Clock } from "./clock";
import { ClipColours } from "./colours";
import type { PageData } from "./contract";
import { lastBefore, readPage } from "./data";
import { Dancer } from "./dancer";
import { Heat } from "./heat";
import { Keyposes } from "./keyposes";
import { Master } from "./master";
import { Panel } from "./panel";
import { StoredPath } from "./path";
import { Stage } from "./stage";
import { Timeline } from "./timeline";

function start(): void {
  const page = readPage();
  const clock = new Clock(page.duration, page.audio !== null);
  const colours = new ClipColours(page.moves.map((move) => move.clip));
  const stage = stageOf(page);
  let caughtUp = true;
  const seek = (time: number): void => {
    clock.seek(time);
    caughtUp = false;
  };
  const now = (): number => clock.now(performance.now());
  const clicks = new Clicks(clock, page);
  const keyposes = new Keyposes(page, clock, element("poses"), element("keypose"), seek);
  const panel = new Panel(page, clock, stage, colours, clicks, keyposes, seek);
  const [detail, overview] = [element("detail"), element("overview")] as HTMLCanvasElement[];
  const timeline = new Timeline(detail, overview, page, colours, seek, now);
  keyposes.draw(stage.dancer);
  let before = performance.now();
  const frame = (at: number): void => {
    const time = clock.now(at);
    const beat = lastBeat(page, time);
    stage.draw(time, Math.min((at - before) / 1000, 0.1), beat.since, clock.playing ? beat.strength : 0);
    if (!caughtUp) stage.catchUp();
    caughtUp = true;
    timeline.draw(time);
    clicks.update(time);
    keyposes.update(time);
    panel.update(time, beat.since);
    if (clock.playing && time >= page.duration) clock.pause();
    before = at;
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
  if (page.audio) {
    clock.load(page.audio).catch((error: unknown) => panel.say(`This browser cannot play the sound: ${String(error)}`));
  }
  expose(page, clock, stage, clicks, keyposes, seek);
}

/** The dancer on its stage, with whom it is held against. */
function stageOf(page: PageData): Stage {
  const compared = page.compared;
  const heat = compared?.heat ? new Heat(compared.heat, page.joints.length, page.fps) : undefined;
  const dancer = new Dancer(page, new StoredPath(page), heat);
  const company = compared && {
    master: new Master(compared, page, dancer.height),
    captions: compared.captions.map((words) => new Caption(words, page.floor, dancer.height)),
  };
  return new Stage(element("scene") as HTMLCanvasElement, page, dancer, company ?? undefined);
}

function lastBeat(page: PageData, time: number): { since: number; strength: number } {
  const index = lastBefore(page.beats, time);
  if (index < 0) return { since: 9, strength: 0 };
  const down = lastBefore(page.downbeats, time);
  const first = down >= 0 && Math.abs(page.downbeats[down] - page.beats[index]) < 0.01;
  return { since: time - page.beats[index], strength: first ? 1 : 0.55 };
}

/** A small door for scripts and tests: `onbeat.state()`, `onbeat.seek(12)`, `onbeat.play()`, `onbeat.pause()`. */
function expose(
  page: PageData, clock: Clock, stage: Stage, clicks: Clicks, keyposes: Keyposes, seek: (time: number) => void,
): void {
  const state = () => ({
    time: clock.now(performance.now()),
    playing: clock.playing,
    sound: clock.hasSound,
    clicks: clicks.sounded,
    keypose: keyposes.at(clock.now(performance.now())),
    duration: page.duration,
    names: page.joints,
    joints: Array.from(stage.dancer.joints),
    heat: Array.from(stage.dancer.heat?.levels ?? []),
    master: stage.master?.place ?? null,
    size: stage.master?.dancer.group.scale.x ?? 1,
    other: Array.from(stage.master?.dancer.joints ?? []),
  });
  Object.assign(window, { onbeat: { state, seek, play: () => clock.play(), pause: () => clock.pause() } });
}

function element(id: string): HTMLElement {
  return document.getElementById(id) as HTMLElement;
}

try {
  start();
} catch (error) {
  const message = element("message");
  message.hidden = false;
  message.textContent = error instanceof Error ? error.message : String(error);
}
