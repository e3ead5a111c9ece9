// Reads what a session sends; what is not as it should be reads as nothing, so that no page breaks by it.

import type { BeatSaid, CapsuleData, HelloData, Note, Status, Told } from "./contract";

const [MOST_POINTS, MOST_BEATS, MOST_LEVELS, MOST_NAMES] = [2000, 64, 400, 500];
const HEAD = 12; // bytes before a pose's points: float64 time, uint32 number
const FAR = 1e5; // [m] nobody dances out there

/** A body's points at a time: points x 3 [m]. */
export interface PoseAt {
  time: number;
  number: number;
  points: Float32Array;
}

/** A pose of so many points, else undefined. */
export function readPose(bytes: ArrayBuffer, points: number): PoseAt | undefined {
  if (bytes.byteLength !== HEAD + 12 * points) return undefined;
  const view = new DataView(bytes);
  const time = view.getFloat64(0, true);
  const places = new Float32Array(bytes, HEAD); // browsers run on little-endian machines
  if (!finite(time) || !places.every((place) => Math.abs(place) < FAR)) return undefined;
  return { time, number: view.getUint32(8, true), points: places };
}

/** What was told, with lists no longer than they may be, else undefined. */
export function readTold(text: string): Told | undefined {
  let told: unknown;
  try {
    told = JSON.parse(text);
  } catch {
    return undefined;
  }
  if (!record(told)) return undefined;
  if (told.type === "hello") return readHello(told);
  if (told.type === "beat") return readBeat(told);
  if (told.type === "status") return readStatus(told);
  return told.type === "note" ? readNote(told) : undefined;
}

type Fields = Record<string, unknown>;

function readHello(told: Fields): HelloData | undefined {
  const { points, capsules, spine } = told;
  if (!list(points, text) || !list(spine, finite) || !Array.isArray(capsules)) return undefined;
  const inside = (place: unknown): boolean => Number.isInteger(place) && (place as number) >= 0 && (place as number) < points.length;
  if (!points.length || points.length > MOST_POINTS || !spine.length || !spine.every(inside)) return undefined;
  if (!capsules.length || capsules.length > MOST_POINTS) return undefined;
  if (!capsules.every((capsule) => isCapsule(capsule) && inside(capsule.a) && inside(capsule.b))) return undefined;
  const numbers = ["version", "facing", "floor", "latency", "started", "now", "sound_at", "sound_seconds"];
  if (!numbers.every((name) => finite(told[name])) || !text(told.title) || !text(told.name)) return undefined;
  const choreographies = (list(told.choreographies, text) ? told.choreographies : []).slice(0, MOST_NAMES);
  return { ...(told as unknown as HelloData), choreographies };
}

function isCapsule(told: unknown): told is CapsuleData {
  if (!record(told) || !text(told.group) || !text(told.colour)) return false;
  return ["a", "b", "radius_a", "radius_b", "start", "end"].every((name) => finite(told[name]));
}

function readBeat(told: Fields): BeatSaid | undefined {
  const { time, position, confidence, said } = told;
  if (!finite(time) || !finite(position) || !finite(confidence) || !finite(said)) return undefined;
  return { type: "beat", time, position, confidence: unit(confidence), said };
}

function readStatus(told: Fields): Status | undefined {
  const numbers = ["time", "tempo", "confidence", "meter", "next_position", "clock"];
  if (!numbers.every((name) => finite(told[name]))) return undefined;
  const { hearing, next_beats, level, dancing } = told;
  if (hearing !== "music" && hearing !== "held" && hearing !== "nothing") return undefined;
  if (!list(next_beats, finite) || !list(level, finite) || !text(dancing)) return undefined;
  const status = told as unknown as Status;
  return {
    ...status,
    confidence: unit(status.confidence),
    meter: Math.round(Math.min(Math.max(status.meter, 1), 16)),
    next_beats: next_beats.slice(0, MOST_BEATS),
    level: level.slice(-MOST_LEVELS).map(unit),
  };
}

function readNote(told: Fields): Note | undefined {
  if (!finite(told.time) || !text(told.text)) return undefined;
  return { type: "note", time: told.time, text: told.text.slice(0, 400) };
}

const record = (value: unknown): value is Fields => typeof value === "object" && value !== null;
const finite = (value: unknown): value is number => Number.isFinite(value);
const text = (value: unknown): value is string => typeof value === "string";
const unit = (value: number): number => Math.min(Math.max(value, 0), 1);

function list<T>(values: unknown, is: (value: unknown) => value is T): values is T[] {
  return Array.isArray(values) && values.every(is);
}
