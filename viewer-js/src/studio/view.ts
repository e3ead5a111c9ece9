// What the middle of the page can show, and what all of it has at hand.

import type { Look } from "./look";
import type { Player } from "./player";
import type { Store } from "./store";

export interface Studio {
  store: Store;
  player: Player;
  looks: [Look, Look];
  dark: () => boolean;
}

export interface View {
  readonly root: HTMLElement;
  readonly title: string;
  /** The project changed. */
  update(): void;
  /** A picture is due: the time that plays, and seconds since the last one. */
  frame?(time: number, seconds: number): void;
  /** A key that nobody else took; true where it was used. */
  key?(event: KeyboardEvent): boolean;
  /** The room is dark or light now. */
  dim?(): void;
  close?(): void;
  /** For scripts and tests. */
  state?(): Record<string, unknown>;
}

/** Goes to another view: it can be gone back from, and linked to. */
export function go(kind: string, id = ""): void {
  location.hash = id ? `${kind}/${id.split("/").map(encodeURIComponent).join("/")}` : kind;
}
