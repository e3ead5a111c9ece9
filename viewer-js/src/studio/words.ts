// Times and amounts in words.

export function minutes(seconds: number): string {
  const whole = Math.max(Math.floor(seconds + 1e-6), 0);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
}

/** Minutes, seconds and tenths. */
export function exactly(seconds: number): string {
  const tenths = Math.max(Math.round(seconds * 10), 0);
  return `${Math.floor(tenths / 600)}:${String(Math.floor((tenths % 600) / 10)).padStart(2, "0")}.${tenths % 10}`;
}

/** How long something will still take, roughly. */
export function left(seconds: number | null): string {
  if (seconds === null) return "";
  if (seconds < 1) return "about a second left";
  if (seconds < 90) return `about ${Math.round(seconds)} s left`;
  return `about ${Math.round(seconds / 60)} min left`;
}

/** The name of the next dance after this one. */
export function nextName(name: string): string {
  const [, first, , count] = /^(.*?)(, again( \d+)?)?$/s.exec(name) as RegExpExecArray;
  const again = count ? Number(count) + 1 : first === name ? 1 : 2;
  return `${first.slice(0, 100)}, again${again > 1 ? ` ${again}` : ""}`;
}

export function plural(count: number, one: string, many = `${one}s`): string {
  return `${count} ${count === 1 ? one : many}`;
}

/** How fast a song is, or that it has no beat. */
export function pace(tempo: number, unit = "beats a minute"): string {
  return tempo > 0 ? `${Math.round(tempo)} ${unit}` : "no beat heard";
}

/** Whether a file is the skeleton of others. */
export function isSkeleton(name: string): boolean {
  return /\.asf$/i.test(name);
}

/** A name that somebody can read, of one that is a path or has an ending. */
export function plainName(name: string): string {
  return (name.split(/[\\/]/).pop() ?? name).replace(/\.[A-Za-z0-9]{1,5}$/, "");
}
