// Written by `python -m onbeat.live.page.wire` from wire.py and protocol.py. Do not edit.

export const VERSION = 1;

/** A tapering capsule between two joints of the page; see :mod:`onbeat.viewer.shape`. */
export interface CapsuleData {
  a: number;
  b: number;
  radius_a: number;
  radius_b: number;
  group: string;
  colour: string;
  start: number;
  end: number;
}

/** Who dances and how to draw it: the first message on each connection. */
export interface HelloData {
  type: "hello";
  version: number;
  title: string;
  name: string;
  kind: "character" | "robot";
  points: string[];
  capsules: CapsuleData[];
  spine: number[];
  facing: number;
  floor: number;
  latency: number;
  started: number;
  now: number;
  choreographies: string[];
  sound: boolean;
  sound_at: number;
  sound_seconds: number;
  loops: boolean;
}

/** A beat as it is heard: when it is, its place in the bar from 1, how likely it is right, and when it was said. */
export interface BeatSaid {
  type: "beat";
  time: number;
  position: number;
  confidence: number;
  said: number;
}

/** How things are, twenty times a second. */
export interface Status {
  type: "status";
  time: number;
  hearing: "music" | "held" | "nothing";
  tempo: number;
  confidence: number;
  meter: number;
  next_position: number;
  next_beats: number[];
  level: number[];
  dancing: string;
  clock: number;
  simulated: boolean;
}

/** Something that people should know, said once: the input is lost, it is back, it clips. */
export interface Note {
  type: "note";
  time: number;
  text: string;
}

/** What somebody wants: "next" or "play" with the name of what to dance, "rest", "dance", "tap" (a beat, now). */
export interface Command {
  type: "command";
  do: "next" | "play" | "rest" | "dance" | "tap";
  value: string;
}

/** What comes as text. */
export type Told = HelloData | BeatSaid | Status | Note;
