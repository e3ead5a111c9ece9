// Which keys do what.

import { button, h } from "./elements";

const KEYS: [string, [keys: string, does: string][]][] = [
  [
    "Playing",
    [
      ["space", "play, pause"],
      ["← →", "2 s back, on; with shift a tenth of it"],
      ["home end", "to the beginning, the end"],
      ["L", "loop"],
      ["K", "clicks on the beats"],
      ["V", "another view"],
    ],
  ],
  [
    "Beats of a song",
    [
      [", .", "choose the beat before, after"],
      ["alt ← →", "move it 5 ms; with shift 20 ms"],
      ["A", "add one at the play head"],
      ["delete", "take it away"],
      ["D", "a bar begins here, or not"],
      ["B", "bars begin here and go on so"],
      ["ctrl Z", "undo; with shift redo"],
    ],
  ],
  [
    "A dance",
    [
      ["[ ]", "a locked stretch begins, ends at the play head"],
      ["S", "marks where feet stand"],
      ["O", "ghosts: the body some beats before and after"],
      ["G", "the motion graph"],
    ],
  ],
  [
    "Timelines",
    [
      ["+ −", "zoom"],
      ["ctrl wheel", "zoom"],
      ["shift wheel", "move"],
    ],
  ],
];

export function help(): void {
  const parts = KEYS.map(([title, keys]) =>
    h(
      "section",
      {},
      h("h3", {}, title),
      h(
        "dl",
        { class: "keys" },
        ...keys.flatMap(([key, does]) => [
          h("dt", {}, ...key.split(" ").map((one) => h("kbd", {}, one))),
          h("dd", {}, does),
        ]),
      ),
    ),
  );
  const box = h(
    "dialog",
    { class: "wide", "aria-labelledby": "help-title" },
    h("h2", { id: "help-title" }, "Keys"),
    h("div", { class: "columns" }, ...parts),
    h(
      "div",
      { class: "row end" },
      button("Close", () => box.close()),
    ),
  );
  box.addEventListener("close", () => box.remove());
  document.body.append(box);
  box.showModal();
}
