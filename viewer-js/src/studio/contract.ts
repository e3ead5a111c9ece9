// Written by `python -m onbeat.studio.wire` from wire.py. Do not edit.

import type { CurveData, MetricData, PageData } from "../contract";

export const VERSION = 1;

/** A job: what is to be done for the item ``of``, how far it is (``share`` 0…1) and how long it will take. */
export interface JobItem {
  id: string;
  kind: "listen" | "look" | "build" | "dance" | "retime" | "robot" | "export";
  of: string;
  title: string;
  state: "waiting" | "running" | "done" | "failed" | "cancelled";
  share: number;
  left_s: number | null;
  message: string;
  error: string | null;
}

/** A song of the project; ``job`` works on it, ``error`` says why it is ``failed``. */
export interface SongItem {
  id: string;
  name: string;
  state: "waiting" | "ready" | "failed" | "cancelled";
  job: string | null;
  error: string | null;
  duration: number;
  tempo: number;
  meter: number;
  edited: boolean;
}

/** A motion file of the project; ``body`` says in words who moves, ``note`` what was guessed of the file. */
export interface MotionItem {
  id: string;
  name: string;
  state: "waiting" | "ready" | "failed" | "cancelled";
  job: string | null;
  error: string | null;
  seconds: number;
  fps: number;
  body: string;
  note: string;
  rate: number | null;
  rate_stored: boolean;
  lacks: string;
}

/** A motion library made of ``motions``; that with the id ``troupe`` is always there, made of none. */
export interface LibraryItem {
  id: string;
  name: string;
  state: "waiting" | "ready" | "failed" | "cancelled";
  job: string | null;
  error: string | null;
  motions: string[];
  clips: number;
  seconds: number;
  note: string;
}

/** A stretch of an earlier dance, in seconds of its clock, that the new one is to have at the same time. */
export interface KeptStretch {
  dance: string;
  from_s: number;
  to_s: number;
}

/** What is to be danced: ``seconds`` of the song from ``start`` on, all of it for none. */
export interface DanceOrder {
  song: string;
  library: string;
  start: number;
  seconds: number | null;
  method: string;
  seed: number;
  intensity_weight: number;
  robot: string | null;
  speed: number;
  keep: KeptStretch[];
  name: string;
}

/** A dance: ``danced`` to an order, or the dance ``source`` ``retimed`` to another speed or put on a ``robot``. */
export interface DanceItem {
  id: string;
  name: string;
  kind: "danced" | "retimed" | "robot";
  order: DanceOrder;
  state: "waiting" | "ready" | "failed" | "cancelled";
  job: string | null;
  error: string | null;
  source: string | null;
  song: string;
  start: number;
  speed: number;
  robot: string | null;
  seconds: number;
  f50: number | null;
  note: string;
}

/** A video: pixels across and down, pictures a second, and whether a ring runs over the floor on every beat. */
export interface FilmOrder {
  width: number;
  height: number;
  fps: number;
  flash: boolean;
}

/** A dance as a file to take away, at ``/api/exports/ID`` once it is ready; ``file`` is its name there. */
export interface ExportItem {
  id: string;
  dance: string;
  format: string;
  file: string;
  film: FilmOrder | null;
  state: "waiting" | "ready" | "failed" | "cancelled";
  job: string | null;
  error: string | null;
  bytes: number;
}

/** A robot that a dance can be put on. */
export interface RobotItem {
  name: string;
  title: string;
}

/** A method of choosing moves, and what it does in a sentence. */
export interface MethodItem {
  name: string;
  title: string;
}

/** A format of exports: ``who`` can be written in it, and which package is ``missing`` for it, or none. */
export interface FormatItem {
  name: string;
  title: string;
  who: "all" | "characters" | "robots" | "g1";
  missing: string;
}

/** All that is in the project; ``revision`` grows with each change. */
export interface Project {
  version: number;
  name: string;
  revision: number;
  largest: number;
  songs: SongItem[];
  motions: MotionItem[];
  libraries: LibraryItem[];
  dances: DanceItem[];
  exports: ExportItem[];
  jobs: JobItem[];
  robots: RobotItem[];
  methods: MethodItem[];
  formats: FormatItem[];
}

/** What is heard in a song, or put right by the user (``edited``); ``chord_change`` and ``confidence`` per beat. */
export interface SongView {
  id: string;
  name: string;
  duration: number;
  tempo: number;
  meter: number;
  beats: number[];
  downbeats: number[];
  chord_change: number[];
  confidence: number[];
  intensity: CurveData;
  waveform: CurveData;
  edited: boolean;
  key: string;
  heard_beats: number[];
}

/** Beats as the user has them, seconds of the song; the downbeats are some of them. */
export interface BeatsData {
  beats: number[];
  downbeats: number[];
}

/** What is seen in a motion file, and ``scene`` to play it. */
export interface MotionView {
  id: string;
  name: string;
  seconds: number;
  fps: number;
  body: string;
  note: string;
  stops: number[];
  intensity: CurveData;
  keyposes: number[];
  scene: PageData;
}

/** What was taken of a motion file or an archive of them, and names of what is in the archive and was not. */
export interface TakenMotions {
  motions: MotionItem[];
  passed_over: string[];
  found: MotionItem[];
}

/** Frames a second of motions whose files store none, or a wrong rate; what their files say for none. */
export interface RateOrder {
  motions: string[];
  fps: number | null;
}

/** Motions that are read again at another rate, and the libraries that are built again of them. */
export interface RatedMotions {
  motions: MotionItem[];
  libraries: LibraryItem[];
}

/** The skeleton, one of the project's motions that is an ASF file, with which an AMC file is to be read. */
export interface SkeletonOrder {
  skeleton: string;
}

/** A library to build of motions of the project. */
export interface LibraryOrder {
  name: string;
  motions: string[];
}

/** A clip of a library; ``mark`` is what the user wants of it. */
export interface ClipItem {
  name: string;
  seconds: number;
  mark: "forbidden" | "favourite" | null;
}

/** A library's clips, without their mirror images, and the files that are left out of it, a line each. */
export interface LibraryView {
  item: LibraryItem;
  clips: ClipItem[];
  problems: string[];
}

/** A dance to look at: ``scene`` is what a dance page holds, without the sound; ``metrics`` are all its figures. */
export interface DanceView {
  item: DanceItem;
  metrics: MetricData[];
  scene: PageData;
}

/** The same dance at another speed of its music, inside the body's limits. */
export interface RetimeOrder {
  speed: number;
  name: string;
}

/** The same dance on a robot. */
export interface RobotOrder {
  robot: string;
  name: string;
}

/** A dance as a file; ``film`` is for a video, which without it is as usual. */
export interface ExportOrder {
  format: string;
  film: FilmOrder | null;
}

/** Another name. */
export interface NameOrder {
  name: string;
}

/** Why something is refused, in a sentence, and which field of what was sent is meant. */
export interface ErrorData {
  error: string;
  field: string | null;
}

/** What ``/api/events`` tells: the project changed, or a job went on. */
export interface EventData {
  revision: number | null;
  job: JobItem | null;
}
