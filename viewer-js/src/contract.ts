// Written by `python -m onbeat.viewer.typescript` from contract.py. Do not edit.

export const VERSION = 5;

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

/** Joint positions: uint16 ``q`` (frames, joints, 3) in base64, ``metres = origin + step q``. */
export interface PathData {
  base64: string;
  origin: number[];
  step: number;
}

/** Values 0…1 at a steady rate: uint8 ``q`` in base64, ``value = q / 255`` at time ``index / rate``. */
export interface CurveData {
  base64: string;
  rate: number;
}

/** The song's sound: a data URI, its MIME type inside, and the seconds and Hz of what was encoded. */
export interface AudioData {
  uri: string;
  seconds: number;
  rate: number;
}

/** One stretch of one clip: shown from ``at_s`` on, seconds ``from_s`` to ``to_s`` of the clip. */
export interface MoveData {
  clip: string;
  from_s: number;
  to_s: number;
  at_s: number;
}

/** A keypose at ``time``: its number and beat, both from 1, what rests there, and the yaw that the body faces. */
export interface KeyposeData {
  time: number;
  number: number;
  beat: number;
  source: string;
  facing: number;
}

/** Global and local energy over time, 1 being the highest of both, and when candidates for keyposes lie on them. */
export interface EnergyData {
  world: CurveData;
  local: CurveData;
  world_candidates: number[];
  local_candidates: number[];
}

/** A figure of the dance, in words for people. */
export interface MetricData {
  name: string;
  value: string;
}

/** A second body on the stage, as many frames as the first: its joints, its shape and its path. */
export interface BodyData {
  joints: string[];
  capsules: CapsuleData[];
  path: PathData;
  spine: number[];
}

/** How far each joint is off: uint8 ``q`` (frames, joints) in base64, ``most q / 254`` cm; 255 where unknown. */
export interface HeatData {
  base64: string;
  most: number;
  scale: string[];
  unknown: string;
}

/** The dancer held against another: how far off its joints are, and the other one's body in the same place. */
export interface ComparedData {
  name: string;
  heat: HeatData | null;
  body: BodyData;
  who: string;
  captions: string[];
  apart: number;
}

/** A foot, ``left`` or ``right``, that stands: when, where its middle is, the yaw it points to, and how long it is. */
export interface StepData {
  foot: string;
  from_s: number;
  to_s: number;
  x: number;
  y: number;
  yaw: number;
  length: number;
}

/** A clip of the library: its name and its seconds. */
export interface ClipData {
  name: string;
  seconds: number;
}

/** A join of the motion graph: out of one of its clips, by number, at a second of it, into another. */
export interface JoinData {
  clip: number;
  from_s: number;
  next_clip: number;
  to_s: number;
}

/** The motion graph: clips danced and a sample of others, joins between them, and how many of both there are. */
export interface GraphData {
  clips: ClipData[];
  joins: JoinData[];
  clip_count: number;
  join_count: number;
}

/** The time warp: at ``times`` of the dance is shown what was at ``before`` without it; linear between them. */
export interface WarpData {
  times: number[];
  before: number[];
}

/** Everything the page shows. */
export interface PageData {
  version: number;
  title: string;
  method: string;
  duration: number;
  tempo: number;
  fps: number;
  frames: number;
  joints: string[];
  capsules: CapsuleData[];
  path: PathData;
  spine: number[];
  facing: number;
  floor: number;
  audio: AudioData | null;
  waveform: CurveData;
  beats: number[];
  downbeats: number[];
  stops: number[];
  moves: MoveData[];
  joins: number[];
  keyposes: KeyposeData[];
  energy: EnergyData | null;
  music_intensity: CurveData;
  motion_intensity: CurveData;
  metrics: MetricData[];
  compared: ComparedData | null;
  steps: StepData[];
  graph: GraphData | null;
  warp: WarpData | null;
}
