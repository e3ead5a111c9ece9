// Builds the page's shell: one HTML file with style and script inside, which Python fills with a dance.
// `node build.mjs [OUT]`; the same sources and versions give the same bytes.

import { readFileSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const out = process.argv[2] ?? here("../src/onbeat/viewer/static/dance.html");

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

const [script, style] = [await bundle("src/main.ts"), await bundle("src/style.css")];
if (/<\/script|<!--/i.test(script)) throw new Error("the script would end its own element");
const licence = readFileSync(here("node_modules/three/LICENSE"), "utf8").trim();
const notice = `/* This page holds three.js.\n${licence} */\n`;
const page = readFileSync(here("src/page.html"), "utf8")
  .replace("<!--style-->", () => style)
  .replace("<!--script-->", () => notice + script);
writeFileSync(out, page);
console.log(`${out}: ${Math.round(page.length / 1024)} kB`);
