// What is read: who dances and what, tempo, place in the bar, what is heard, and notes.

import { ClipColours } from "../colours";
import type { Beats } from "./beats";
import type { HelloData, Status } from "./contract";
import { at, made, minutes, text } from "./elements";

const HEARING = { music: "hears music", held: "holds the tempo", nothing: "hears no music" };
const TOAST = 6; // [s]
const [TOASTS, LOG] = [3, 100];
const LIT = 0.6; // of a beat: how long a light stays at least, if no other comes

export class Board {
  notes: string[] = [];
  private meter = 0;
  private lit = 0;
  private who = "";
  private dancing = "";

  greet(hello: HelloData): void {
    document.title = hello.title;
    text("title", hello.title);
    // A title that names the dancer need not be followed by its name.
    const who = hello.kind === "robot" ? `the robot ${hello.name}` : hello.name;
    this.who = hello.title.startsWith(hello.name) ? "" : `${who}, `;
    this.tell("");
    this.link(true, "live");
  }

  /** A word that stays in the middle of the stage; none for an empty one. */
  tell(words: string): void {
    text("message", words);
    at("message").hidden = words === "";
  }

  link(live: boolean, words: string): void {
    document.body.classList.toggle("away", !live);
    (at("link").lastElementChild as HTMLElement).textContent = words;
  }

  /** A note: for some seconds on the stage, and for good in the log. */
  note(words: string, time: number): void {
    this.notes = [...this.notes.slice(1 - LOG), words];
    const entry = made("li");
    entry.append(made("time", minutes(time)), words);
    at("log").prepend(entry);
    while (at("log").children.length > LOG) at("log").lastChild?.remove();
    const toast = made("li", words);
    at("toasts").append(toast);
    while (at("toasts").children.length > TOASTS) at("toasts").firstChild?.remove();
    setTimeout(() => toast.remove(), TOAST * 1000);
  }

  status(status: Status): void {
    (at("tempo").firstElementChild as HTMLElement).textContent = status.tempo > 0 ? String(Math.round(status.tempo)) : "–";
    (at("confidence") as HTMLMeterElement).value = status.confidence;
    const hearing = at("hearing");
    if (hearing.className !== status.hearing) {
      hearing.className = status.hearing;
      (hearing.firstElementChild as HTMLElement).textContent = HEARING[status.hearing];
    }
    text("subtitle", `${this.who}${status.simulated ? "live, in simulation" : "live"}`);
    text("rate", `dances ×${status.clock.toFixed(2)}`);
    if (status.meter !== this.meter) this.hang(status.meter);
    if (status.dancing !== this.dancing) this.showDance(status.dancing);
  }

  /** Lights the place in the bar of the beat struck last. */
  lights(beats: Beats, now: number, tempo: number): void {
    const struck = beats.struck;
    const fresh = struck && now - struck.time < (1 + LIT) * (60 / Math.max(tempo, 40));
    const lit = fresh ? struck.position : 0;
    if (lit === this.lit) return;
    this.lit = lit;
    Array.from(at("lights").children).forEach((light, i) => light.classList.toggle("lit", i + 1 === lit));
    at("lights").setAttribute("aria-label", `Place in the bar: ${this.meter} beats`);
  }

  figures(rows: readonly (readonly [name: string, value: string])[]): void {
    if (!(at("figures") as HTMLDetailsElement).open) return;
    const values = Array.from(at("metrics").querySelectorAll("dd"));
    if (values.length !== rows.length) {
      at("metrics").replaceChildren(...rows.flatMap(([name, value]) => [made("dt", name), made("dd", value)]));
      return;
    }
    rows.forEach(([, value], i) => {
      if (values[i].textContent !== value) values[i].textContent = value;
    });
  }

  private hang(meter: number): void {
    this.meter = meter;
    this.lit = 0;
    at("lights").replaceChildren(...Array.from({ length: meter }, (_, i) => made("li", String(i + 1))));
  }

  private showDance(name: string): void {
    this.dancing = name;
    const chip = at("now");
    chip.hidden = name === "";
    // A name keeps its colour, whatever else was danced: it is counted from its letters.
    const place = Array.from(name).reduce((sum, letter) => (31 * sum + letter.charCodeAt(0)) % 97, 0);
    const colours = new ClipColours([...Array.from({ length: place }, (_, i) => String(i)), name]);
    (chip.querySelector("i") as HTMLElement).style.color = colours.strong(name);
    (chip.querySelector("span") as HTMLElement).textContent = chip.title = name;
  }
}
