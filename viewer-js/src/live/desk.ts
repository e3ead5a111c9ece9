// What is pressed: buttons and keys, which become commands to the session or change how the page shows it.

import type { Command, HelloData } from "./contract";
import { shutting } from "../keys";
import { at, made, on } from "./elements";

const STRUCK = 0.12; // [s] a button shows that its key was pressed

export interface Doings {
  send(what: Command["do"], value?: string): void;
  sound(): void;
  follow(): void;
  theme(): void;
}

export class Desk {
  constructor(private readonly doings: Doings) {
    for (const what of ["next", "rest", "dance", "tap"] as const) on(what, () => doings.send(what));
    on("choreographies", () => this.open(Boolean(at("choices").hidden)));
    on("sound", () => doings.sound());
    on("follow", () => doings.follow());
    on("dark", () => doings.theme());
    shutting(at("figures") as HTMLDetailsElement, false);
    addEventListener("keydown", (event) => this.key(event));
    addEventListener("pointerdown", (event) => {
      if (!at("choose").contains(event.target as Node)) this.open(false);
    });
  }

  offer(hello: HelloData): void {
    at("choose").hidden = hello.choreographies.length === 0;
    at("choices").replaceChildren(
      ...hello.choreographies.map((name) => {
        const [row, button] = [made("li"), made("button", name)];
        button.addEventListener("click", () => this.play(name));
        row.append(button);
        return row;
      }),
    );
  }

  private play(name: string): void {
    this.open(false);
    at("choreographies").focus();
    this.doings.send("play", name);
  }

  private open(open: boolean): void {
    if (at("choices").hidden !== open) return;
    at("choices").hidden = !open;
    at("choreographies").setAttribute("aria-expanded", String(open));
    if (!open) return;
    const buttons = Array.from(at("choices").querySelectorAll("button"));
    for (const button of buttons) button.toggleAttribute("aria-current", button.textContent === at("now").textContent?.trim());
    buttons[0]?.focus();
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey || event.repeat) return;
    if (event.key === "Escape" && !at("choices").hidden) {
      this.open(false);
      return at("choreographies").focus();
    }
    const keys: Record<string, string> = {
      n: "next", r: "rest", d: "dance", t: "tap", p: "choreographies", s: "sound", f: "follow", l: "dark",
    };
    const button = at(keys[event.key.toLowerCase()] ?? "") as HTMLButtonElement | null;
    if (!button || button.hidden || button.parentElement?.hidden) return;
    event.preventDefault();
    button.click();
    button.classList.add("struck");
    setTimeout(() => button.classList.remove("struck"), STRUCK * 1000);
  }
}
