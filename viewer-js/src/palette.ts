// The colours that strips and pictures are painted with, in a light and in a dark room.

export interface Paint {
  dark: boolean;
  paper: string; // behind lanes
  band: string; // a lane's own ground
  ink: string;
  words: string; // small text
  soft: string;
  faint: string;
  accent: string;
  wave: string;
  heard: string; // of the waveform, what has been
  music: string;
  dance: string;
  global: string;
  local: string;
  other: string;
  left: string;
  right: string;
  quiet: string; // lines of the graph that are not danced
}

const LIGHT: Paint = {
  dark: false, paper: "#fafafb", band: "#f1f3f6", ink: "#262b3d", words: "#5d6477", soft: "#8d93a5", faint: "#c6cad5", accent: "#e2583e",
  wave: "#c9cfdb", heard: "#eda796", music: "#d5dae4", dance: "#2f9c95", global: "#1f3f77", local: "#c2611a", other: "#5b6472",
  left: "#1d7f9c", right: "#8b4bb3", quiet: "rgba(92, 100, 120, 0.09)",
};
const DARK: Paint = {
  dark: true, paper: "#181b26", band: "#1f2330", ink: "#e9ecf5", words: "#aab2c6", soft: "#78819a", faint: "#3c4356", accent: "#ff7a5c",
  wave: "#4b546b", heard: "#b4604c", music: "#3a4258", dance: "#4cc4bb", global: "#7fa6ef", local: "#f0954a", other: "#98a2b6",
  left: "#58bfdd", right: "#c48bea", quiet: "rgba(160, 172, 200, 0.1)",
};

/** What everything is painted with now. */
export const paint: Paint = { ...LIGHT };

/** Paints for a dark or a light room from now on; what is drawn already is to be drawn again. */
export function dim(dark: boolean): void {
  Object.assign(paint, dark ? DARK : LIGHT);
}
