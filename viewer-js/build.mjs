// Builds the pages' shells: HTML files with style and script inside. Python fills that of a dance; the live stage is
// whole. `node build.mjs [FOLDER]`; the same sources and versions give the same bytes.

import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const PAGES = [
  { name: "dance.html", shell: "src/page.html", script: "src/main.ts", style: "src/style.css" },
  { name: "live.html", shell: "src/live/page.html", script: "src/live/main.ts", style: "src/live/style.css" },
];
const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const folder = process.argv[2] ?? here("../src/onbeat/viewer/static");

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
for (const { name, shell, script: entry, style: sheet } of PAGES) {
  const [script, style] = [await bundle(entry), await bundle(sheet)];
  if (/<\/script|<!--/i.test(script)) throw new Error(`the script of ${name} would end its own element`);
  const page = readFileSync(here(shell), "utf8")
    .replace("<!--style-->", () => style)
    .replace("<!--script-->", () => notice + script);
  const out = join(folder, name);
  writeFileSync(out, page);
  console.log(`${out}: ${Math.round(page.length / 1024)} kB`);
}
