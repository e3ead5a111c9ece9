// Colours of what is drawn on canvases, in a light and in a dark room.

export interface Palette {
  ink: string;
  soft: string;
  line: string;
  beat: string;
  ground: string;
  lane: string;
  accent: string;
  wave: string;
  played: string;
  music: string;
  motion: string;
  chord: string;
  keypose: string;
  lock: string;
  locked: string;
  mark: string;
}

export const FONT = '11px system-ui, -apple-system, "Segoe UI", Roboto, sans-serif';

const LIGHT: Palette = {
  ink: "#262b3d",
  soft: "#596074",
  line: "#dcdfe6",
  beat: "#a9afbe",
  ground: "#ffffff",
  lane: "#f3f4f7",
  accent: "#d2472c",
  wave: "#c3c9d6",
  played: "#eaa697",
  music: "#d5dae4",
  motion: "#1d857e",
  chord: "#8a6fc9",
  keypose: "#1f3f77",
  lock: "#1f6fd0",
  locked: "rgba(31, 111, 208, 0.16)",
  mark: "#ffffff",
};
const DARK: Palette = {
  ink: "#e9ecf5",
  soft: "#a3abbf",
  line: "#333949",
  beat: "#666f86",
  ground: "#171a24",
  lane: "#1e222e",
  accent: "#ff7a5c",
  wave: "#4a5266",
  played: "#95503f",
  music: "#343b4d",
  motion: "#4fd0c5",
  chord: "#a88ef0",
  keypose: "#8fb3ff",
  lock: "#6fb1ff",
  locked: "rgba(111, 177, 255, 0.2)",
  mark: "#171a24",
};

export function palette(dark: boolean): Palette {
  return dark ? DARK : LIGHT;
}
