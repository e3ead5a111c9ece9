// The live stage: takes what a session sends, and draws every picture at the second that is shown.

import { Dancer } from "../dancer";
import { Stage } from "../stage";
import { Beats } from "./beats";
import { Board } from "./board";
import { Connection, type Listener } from "./connection";
import { type Command, type HelloData, type Status, type Told, VERSION } from "./contract";
import { Desk } from "./desk";
import { at, press } from "./elements";
import { Lane } from "./lane";
import { Levels } from "./levels";
import { readPose } from "./messages";
import { Playhead } from "./playhead";
import { Poses } from "./poses";
import { Sound } from "./sound";
import { Theme } from "./theme";

const HELD = 0.3; // [s] after the last pose the time stands still
const KEEP_SOUND = 250; // [ms]
const ROOM = 1.1; // for raised hands: nobody knows yet what will be danced
const CAMERA_JUMP = 1; // [m] farther than that the camera does not glide

class LiveStage implements Listener {
  private readonly playhead = new Playhead();
  private readonly poses = new Poses();
  private readonly beats = new Beats();
  private readonly levels = new Levels();
  private readonly board = new Board();
  private readonly lane = new Lane(at("lane") as HTMLCanvasElement, this.beats, this.levels);
  private readonly sound = new Sound(() => this.showSound());
  private readonly theme = new Theme(() => this.showTheme());
  private readonly desk = new Desk({
    send: (what, value) => this.send(what, value),
    sound: () => this.sound.toggle(),
    follow: () => this.toggleFollow(),
    theme: () => this.theme.toggle(),
  });
  private readonly connection: Connection;
  private stage?: Stage;
  private hello?: HelloData;
  private status?: Status;
  private body = ""; // what the dancer on the stage is made of
  private dressed = false; // whether it is that of the session
  private connected = false;
  private hellos = 0;
  private unread = 0; // messages that were passed over
  private time = 0; // that is shown
  private drawnAt = performance.now();

  constructor() {
    const scheme = location.protocol === "https:" ? "wss:" : "ws:";
    this.board.tell("Looking for the session…");
    this.connection = new Connection(`${scheme}//${location.host}/live`, this);
    setInterval(() => this.keepSound(), KEEP_SOUND);
    requestAnimationFrame((now) => this.frame(now));
  }

  told(told: Told): void {
    if (told.type === "hello") this.greet(told);
    else if (told.type === "note") this.board.note(told.text, told.time);
    else if (told.type === "beat") this.beats.say(told);
    else this.know(told);
  }

  pose(bytes: ArrayBuffer): void {
    if (!this.hello) return;
    const pose = readPose(bytes, this.hello.points.length);
    if (!pose || !this.playhead.came(pose.time, performance.now() / 1000)) return this.refused();
    this.poses.add(pose);
  }

  refused(): void {
    if (this.unread++ === 0) this.board.note("Something unreadable came from the session; it is passed over.", this.time);
  }

  lost(): void {
    if (this.connected) this.board.note("The session is gone.", this.time);
    this.connected = false;
    this.board.link(false, "away");
    this.board.tell(`${this.hellos ? "The session is gone" : "There is no session"}; trying again …`);
  }

  /** A small door for scripts and tests. */
  state() {
    const { beats, poses, sound, status } = this;
    return {
      connected: this.connected,
      hellos: this.hellos,
      time: this.time,
      posed: this.stage?.posed ?? -1,
      music: this.music,
      delay: this.playhead.delay,
      poses: poses.count,
      newest: poses.newest,
      names: this.hello?.points ?? [],
      joints: Array.from(this.stage?.dancer.joints ?? []),
      beats: beats.heard,
      next: beats.coming(this.music),
      strikes: beats.strikes,
      marks: this.lane.marks,
      tempo: status?.tempo ?? 0,
      confidence: status?.confidence ?? 0,
      meter: status?.meter ?? 0,
      unheard: beats.unheard(),
      hearing: status?.hearing ?? "",
      dancing: status?.dancing ?? "",
      clock: status?.clock ?? 1,
      unread: this.unread,
      notes: this.board.notes,
      dark: this.theme.dark,
      follow: this.stage?.follow ?? true,
      sound: {
        possible: sound.possible, on: sound.on, sounding: sound.sounding, error: sound.error, jumps: sound.jumps,
        problem: sound.problem,
      },
    };
  }

  private greet(hello: HelloData): void {
    if (hello.version !== VERSION) {
      this.board.tell(`This page speaks version ${VERSION}, the session ${hello.version}: load the page again.`);
      return;
    }
    const another = hello.started !== this.hello?.started;
    if (another) [this.beats, this.levels, this.poses].forEach((part) => part.clear());
    this.playhead.forget();
    const body = JSON.stringify([hello.points, hello.capsules, hello.spine, hello.floor]);
    if (body !== this.body) this.poses.clear();
    this.dressed = body === this.body && this.stage !== undefined;
    this.body = body;
    this.hello = hello;
    if (this.hellos++ > 0) this.board.note("The session is back.", hello.now);
    this.connected = true;
    this.board.greet(hello);
    this.desk.offer(hello);
    this.sound.offer(hello);
  }

  private know(told: Status): void {
    // Where nothing is heard the session may count on by itself; nobody dances to that.
    const status = told.hearing === "nothing" ? { ...told, tempo: 0, confidence: 0, next_beats: [] } : told;
    this.status = status;
    this.levels.add(status.level, status.time);
    this.beats.foretell(status);
    this.board.status(status);
  }

  private send(what: Command["do"], value = ""): void {
    if (!this.connection.send(what, value)) this.board.note("There is no session to tell.", this.time);
  }

  private frame(now: number): void {
    const seconds = Math.min((now - this.drawnAt) / 1000, 1);
    this.drawnAt = now;
    this.time = this.shown(now / 1000);
    this.beats.update(this.music);
    if (this.poses.newest > -Infinity) this.drawStage(seconds);
    this.lane.draw(this.music);
    this.board.lights(this.beats, this.music, this.status?.tempo ?? 0);
    this.board.figures(this.figures());
    requestAnimationFrame((next) => this.frame(next));
  }

  /** The second of the music that the body shows: the session dances that much ahead of what it has heard. */
  private get music(): number {
    return this.time + (this.hello?.latency ?? 0);
  }

  /** The second that is shown: it goes on, but not far beyond the last pose. */
  private shown(now: number): number {
    if (!this.playhead.started) return this.time;
    return Math.min(this.playhead.now(now), this.poses.newest + HELD);
  }

  private drawStage(seconds: number): void {
    const stage = this.dressed && this.stage ? this.stage : this.dress();
    const { x, y } = stage.dancer.centre;
    const struck = this.beats.struck;
    const since = struck ? Math.max(this.music - struck.time, 0) : 9;
    stage.draw(this.time, seconds, since, struck?.position === 1 ? 1 : 0.55);
    const { centre } = stage.dancer;
    if (Math.hypot(centre.x - x, centre.y - y) > CAMERA_JUMP) stage.catchUp();
  }

  /** Puts the session's dancer on the stage; its limbs are as long as they are in the first pose. */
  private dress(): Stage {
    const hello = this.hello as HelloData;
    const dancer = new Dancer({ ...hello, joints: hello.points }, this.poses);
    if (this.stage) this.stage.replace(dancer);
    else this.stage = new Stage(at("scene") as HTMLCanvasElement, { ...hello, room: ROOM }, dancer);
    this.stage.dark = this.theme.dark;
    this.dressed = true;
    return this.stage;
  }

  private keepSound(): void {
    this.time = this.shown(performance.now() / 1000);
    this.sound.update(this.music, this.connected && this.time < this.poses.newest + HELD);
  }

  private figures(): [string, string][] {
    const { hello, status } = this;
    if (!hello || !status) return [];
    const ms = (seconds: number): string => `${Math.round(1000 * seconds)} ms`;
    const rows: [string, string][] = [
      ["tempo", status.tempo > 0 ? `${status.tempo.toFixed(1)} beats a minute` : "–"],
      ["confidence", `${Math.round(100 * status.confidence)} %`],
      ["the dance goes", `×${status.clock.toFixed(2)}`],
      ["latency made up for", ms(hello.latency)],
      ["shown behind", ms(this.playhead.delay)],
      ["poses", String(this.poses.count)],
      ["time", this.time.toFixed(1)],
    ];
    if (status.simulated) rows.push(["in simulation", "yes"]);
    if (this.sound.on) rows.push(["sound off by", ms(this.sound.error)]);
    return rows;
  }

  private toggleFollow(): void {
    if (!this.stage) return;
    this.stage.follow = !this.stage.follow;
    press("follow", this.stage.follow);
  }

  private showSound(): void {
    at("sound").hidden = !this.sound.possible;
    press("sound", this.sound.on);
    if (this.sound.problem) this.board.note(this.sound.problem, this.time);
  }

  private showTheme(): void {
    // Called once before all parts are there.
    const dark = document.documentElement.dataset.theme === "dark";
    press("dark", dark);
    this.lane.dark = dark;
    if (this.stage) this.stage.dark = dark;
  }
}

try {
  const live = new LiveStage();
  Object.assign(window, { onbeatLive: { state: () => live.state() } });
} catch (error) {
  const message = at("message");
  message.hidden = false;
  message.textContent = error instanceof Error ? error.message : String(error);
}
