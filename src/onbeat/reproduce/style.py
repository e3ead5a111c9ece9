"""How the pages of results look: light or dark as the reader has it, readable on a phone and on paper."""

from __future__ import annotations

CSS = """
:root { color-scheme: light dark; --ink: #262b3d; --soft: #5d6478; --line: #d9dde5; --back: #fbfbfc; --card: #fff;
  --paper: #8a4b12; --ours: #1f5f93; --good: #1d6f42; --bad: #a8262f; }
@media (prefers-color-scheme: dark) { :root { --ink: #e7e9f0; --soft: #a8afc0; --line: #3a4152; --back: #171a22;
  --card: #20242f; --paper: #e5a76b; --ours: #84bdec; --good: #7ccf9c; --bad: #f0959b; } }
* { box-sizing: border-box; }
body { margin: 0; color: var(--ink); background: var(--back);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, sans-serif; }
main { max-width: 62rem; margin: 0 auto; padding: 2rem 1.2rem 5rem; }
h1 { font-size: 1.7rem; line-height: 1.25; margin: .2rem 0; }
h2 { font-size: 1.2rem; margin: 3rem 0 .5rem; border-top: 1px solid var(--line); padding-top: 1.5rem; }
h1 b, h2 b { color: var(--soft); font-weight: 600; margin-right: .5em; }
p, ul, ol { max-width: 46rem; }
a { color: var(--ours); }
.soft, figcaption small { color: var(--soft); }
.data { background: var(--card); border: 1px solid var(--line); border-left: 4px solid var(--paper); border-radius: 6px;
  padding: .4rem 1.2rem; margin: 1.5rem 0; }
.data dt { font-weight: 600; margin-top: .8rem; } .data dd { margin: .1rem 0 .8rem; }
.data ul { padding-left: 1.1rem; margin: .2rem 0; max-width: none; } .data li { margin: .3rem 0; }
.tally { list-style: none; padding: 0; margin: 1rem 0 .6rem; display: flex; flex-wrap: wrap;
  align-items: baseline; gap: .5rem; max-width: none; }
.tally li { border: 1px solid; border-radius: 6px; padding: .15rem .7rem; font-weight: 600; }
.tally .all { border-color: transparent; padding-left: 0; }
.tally b { font-size: 1.25em; margin-right: .15em; }
nav.parts { margin: .6rem 0 0; } nav.parts a { display: inline-block; margin-right: .9em; padding: .2rem 0; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: .92rem; font-variant-numeric: tabular-nums; }
th, td { text-align: left; vertical-align: top; padding: .4rem .9rem .4rem 0; border-bottom: 1px solid var(--line); }
thead th { border-bottom: 2px solid var(--line); line-height: 1.3; vertical-align: bottom; }
tbody th { font-weight: 500; min-width: 11rem; }
td { white-space: nowrap; } td.note { white-space: normal; }
.of-paper { color: var(--paper); } .of-ours { color: var(--ours); }
td.note { color: var(--soft); min-width: 9rem; }
figure { margin: 1rem 0; }
figure img { width: 100%; min-width: 44rem; height: auto; display: block; background: #fff;
  border: 1px solid var(--line);
  border-radius: 6px; padding: .4rem; }
figcaption p { margin: .5rem 0; }
.tag { font-weight: 600; margin-right: .4em; }
.claims { list-style: none; padding: 0; max-width: none; }
.claims li { display: flex; flex-wrap: wrap; gap: 0 1rem; padding: .5rem 0; border-bottom: 1px solid var(--line); }
.claims .verdict { flex: 0 0 8.5em; white-space: nowrap; font-weight: 650; }
.claims div { flex: 1 1 20rem; max-width: 46rem; }
.yes { color: var(--good); } .no { color: var(--bad); } .open { color: var(--soft); }
.claims p { margin: .15rem 0 0; color: var(--soft); } .claims p a { white-space: nowrap; margin-right: .5em; }
nav { font-size: .92rem; } nav a { margin-right: 1em; }
@media print { body { background: #fff; color: #000; } figure, tr { break-inside: avoid; } }
"""
"""The style sheet, which stands in every page."""
