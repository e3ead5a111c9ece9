// Builds the pages' shells: HTML files with style and script inside. Python fills that of a dance; the live stage and the
// studio are whole. `node build.mjs [FOLDER]`; the same sources and versions give the same bytes.

import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const PAGES = [
  { room: "viewer", name: "dance.html", shell: "src/page.html", script: "src/main.ts", style: "src/dance.css" },
  { room: "viewer", name: "live.html", shell: "src/live/page.html", script: "src/live/main.ts", style: "src/live/style.css" },
  { room: "studio", name: "studio.html", shell: "src/studio/page.html", script: "src/studio/main.ts", style: "src/studio/style.css" },
];
const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const folderOf = (room) => process.argv[2] ?? here(`../src/onbeat/${room}/static`);

async function bundle(entry) {
  const result = await build({
    entryPoints: [here(entry)],
    absWorkingDir: here("."),
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: ["es2021", "chrome100", "firefox103", "safari16"],
    charset: "ascii",
    legalComments: "none",
  });
  return result.outputFiles[0].text.trim();
}

const licence = readFileSync(here("node_modules/three/LICENSE"), "utf8").trim();
const notice = `/* This page holds three.js.\n${licence} */\n`;
for (const { room, name, shell, script: entry, style: sheet } of PAGES) {
  const [script, style] = [await bundle(entry), await bundle(sheet)];
  if (/<\/script|<!--/i.test(script)) throw new Error(`the script of ${name} would end its own element`);
  const page = readFileSync(here(shell), "utf8")
    .replace("<!--style-->", () => style)
    .replace("<!--script-->", () => notice + script);
  const out = join(folderOf(room), name);
  mkdirSync(folderOf(room), { recursive: true });
  writeFileSync(out, page);
  console.log(`${out}: ${Math.round(page.length / 1024)} kB`);
}
