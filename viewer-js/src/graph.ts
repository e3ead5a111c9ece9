// The motion graph laid on a circle: clips are arcs as long as they last, joins are chords; and the dance's way through.

import type { ClipData, GraphData, PageData } from "./contract";
import { lastBefore } from "./data";

const TURN = 2 * Math.PI;
const GAP = 0.016; // [rad] between arcs
const LEAST = 0.02; // [rad] that the shortest arc has
const DANCED = 0.72; // of the circle is for clips that are danced, where there are others

/** A clip as an arc, clockwise from the top. */
export interface Arc {
  clip: ClipData;
  from: number; // [rad]
  to: number; // [rad]
  danced: number[]; // the moves that show it
}

/** A join, from an angle to another. */
export interface Chord {
  from: number;
  to: number;
}

/** Where the dance is: the move, the angle on its arc, and how far the move is gone, 0…1. */
export interface Here {
  move: number;
  angle: number;
  part: number;
}

export class Graph {
  readonly arcs: Arc[];
  readonly sample: Chord[];
  readonly path: Chord[]; // the join after each move but the last
  readonly total: { clips: number; joins: number };
  private readonly arcOf = new Map<string, Arc>();
  private readonly starts: number[];

  constructor(private readonly page: PageData) {
    const data = page.graph ?? danced(page);
    this.starts = page.moves.map((move) => move.at_s);
    this.arcs = this.lay(data);
    for (const arc of this.arcs) this.arcOf.set(arc.clip.name, arc);
    const angle = (clip: number, second: number): number => angleAt(this.arcs[clip], second);
    this.sample = data.joins.map((join) => ({ from: angle(join.clip, join.from_s), to: angle(join.next_clip, join.to_s) }));
    this.path = page.moves.slice(1).map((next, i) => ({
      from: this.angle(page.moves[i].clip, page.moves[i].to_s),
      to: this.angle(next.clip, next.from_s),
    }));
    this.total = { clips: data.clip_count, joins: data.join_count };
  }

  get possible(): boolean {
    return this.page.moves.length > 0 && this.arcs.length > 0;
  }

  angle(clip: string, second: number): number {
    const arc = this.arcOf.get(clip);
    return arc ? angleAt(arc, second) : 0;
  }

  here(time: number): Here {
    const move = Math.max(lastBefore(this.starts, time), 0);
    const { clip, from_s, to_s, at_s } = this.page.moves[move];
    const end = this.page.moves[move + 1]?.at_s ?? this.page.duration;
    const part = Math.min(Math.max((time - at_s) / Math.max(end - at_s, 1e-6), 0), 1);
    return { move, part, angle: this.angle(clip, from_s + part * (to_s - from_s)) };
  }

  /** The arc at an angle, if there is one. */
  at(angle: number): Arc | undefined {
    const turned = ((angle % TURN) + TURN) % TURN;
    return this.arcs.find(({ from, to }) => turned >= from - GAP / 2 && turned <= to + GAP / 2);
  }

  /** Arcs around the whole circle, those danced wider than the others for what they last. */
  private lay(data: GraphData): Arc[] {
    const moves = new Map<string, number[]>();
    this.page.moves.forEach(({ clip }, i) => moves.set(clip, [...(moves.get(clip) ?? []), i]));
    const others = data.clips.filter(({ name }) => !moves.has(name));
    const seconds = (clips: readonly ClipData[]): number => clips.reduce((sum, clip) => sum + Math.max(clip.seconds, 0.1), 0);
    const all = seconds(data.clips);
    const share = others.length && others.length < data.clips.length ? DANCED : 1 - seconds(others) / all;
    const room = Math.max(TURN - (GAP + LEAST) * data.clips.length, 0);
    const perSecond = (name: string): number =>
      moves.has(name) ? (room * share) / (all - seconds(others)) : (room * (1 - share)) / seconds(others);
    let from = GAP / 2;
    return data.clips.map((clip) => {
      const to = from + LEAST + Math.max(clip.seconds, 0.1) * perSecond(clip.name);
      const arc = { clip, from, to, danced: moves.get(clip.name) ?? [] };
      from = to + GAP;
      return arc;
    });
  }
}

function angleAt(arc: Arc, second: number): number {
  const part = Math.min(Math.max(second / Math.max(arc.clip.seconds, 1e-6), 0), 1);
  return arc.from + part * (arc.to - arc.from);
}

/** The graph as far as a dance alone tells it: its clips as long as they are seen, and no other joins. */
function danced(page: PageData): GraphData {
  const seconds = new Map<string, number>();
  for (const { clip, to_s } of page.moves) seconds.set(clip, Math.max(seconds.get(clip) ?? 0, to_s));
  const clips = [...seconds].map(([name, length]) => ({ name, seconds: length }));
  return { clips, joins: [], clip_count: clips.length, join_count: page.joins.length };
}
