// What of many files could not be taken: the first ones told at once, each with its reason, the others together at the end.

import { notice } from "./notices";
import { plural } from "./words";

const AT_ONCE = 3;
const NAMED = 20; // files in one message

export class Refusals {
  private count = 0;
  private readonly more: string[] = [];

  /** Files that were sent as one. */
  add(names: readonly string[], why: string): void {
    if (this.count++ >= AT_ONCE) this.more.push(...names);
    else notice(names.length === 1 && why.includes(names[0]) ? why : `${named(names)}: ${why}`, true);
  }

  end(): void {
    if (this.more.length) notice(`${plural(this.more.length, "more file")} could not be taken: ${named(this.more)}.`, true);
  }
}

export function named(names: readonly string[]): string {
  return names.length > NAMED ? `${names.slice(0, NAMED).join(", ")} and ${names.length - NAMED} more` : names.join(", ");
}
