#!/bin/sh
# Fails where the built page in the package is not what these sources build. Skips where there is no node.
set -eu
cd "$(dirname "$0")"
if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
  echo "skipped: node and npm are not installed; the built page was not compared with its sources" >&2
  exit 0
fi
if [ ! -d node_modules ] && ! npm ci --no-audit --no-fund >&2; then
  echo "skipped: \`npm ci\` could not install the tools; the built page was not compared with its sources" >&2
  exit 0
fi
npx tsc --noEmit
fresh=$(mktemp)
trap 'rm -f "$fresh"' EXIT
node build.mjs "$fresh" >&2
if ! cmp -s "$fresh" ../src/onbeat/viewer/static/dance.html; then
  echo "src/onbeat/viewer/static/dance.html is not current: run \`npm run build\` in viewer-js and commit it" >&2
  exit 1
fi
echo "the built page is current" >&2
