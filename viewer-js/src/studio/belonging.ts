// Which files belong together: skeletons and roles files go to the server in one archive with the motions they are for.

import { zipped } from "./zip";

const SKELETON = /\.asf$/i;
const MOVES = /\.amc$/i;
const ROLES = /^(?:(.+)\.)?roles\.toml$/i; // for all that comes with it, or for the files of one name
const PACKED = /\.zip$/i;
const SOUNDS = /\.(wav|flac|ogg|oga|mp3|m4a|aac|mp4|mov|mkv|webm|aif|aiff|opus)$/i;

/** What is sent as one: a file, or several that are packed; `names` are those of all of them. */
export interface Parcel {
  kind: "song" | "motion";
  name: string;
  names: readonly string[];
  bytes: number;
  file: () => Promise<File>;
}

/** The files as they are sent, songs first: those that need others beside them with those, all others by themselves. */
export function parcels(files: readonly File[]): Parcel[] {
  const songs = files.filter(isSound);
  const motions = files.filter((file) => !songs.includes(file) && ![SKELETON, ROLES, PACKED].some((one) => one.test(file.name)));
  const beside = files.filter(({ name }) => SKELETON.test(name) || ROLES.test(name));
  const pairs = beside.map((file) => [file, motions.filter((motion) => needs(motion.name, file.name))] as const);
  const together = new Set(pairs.flatMap(([file, needing]) => (needing.length ? [file, ...needing] : [])));
  const single = files.filter((file) => !together.has(file) && !songs.includes(file));
  return [...songs, ...single].map(alone).concat(together.size ? packed([...together]) : []);
}

function needs(motion: string, beside: string): boolean {
  if (SKELETON.test(beside)) return MOVES.test(motion);
  const stem = ROLES.exec(beside)?.[1];
  return stem === undefined || motion.replace(/\.[^.]*$/, "").toLowerCase() === stem.toLowerCase();
}

function alone(file: File): Parcel {
  const { name, size } = file;
  return { kind: isSound(file) ? "song" : "motion", name, names: [name], bytes: size, file: () => Promise.resolve(file) };
}

function packed(files: readonly File[]): Parcel {
  const name = files[0].name.replace(/\.(asf|toml)$/i, ".zip");
  const bytes = files.reduce((sum, { size }) => sum + size, 0);
  return { kind: "motion", name, names: files.map((file) => file.name), bytes, file: () => zipped(files, name) };
}

function isSound({ name, type }: File): boolean {
  return SOUNDS.test(name) || type.startsWith("audio/");
}
