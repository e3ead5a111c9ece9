#!/bin/sh
# Fails where a built page in the package is not what these sources build. Skips where there is no node.
set -eu
cd "$(dirname "$0")"
if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
  echo "skipped: node and npm are not installed; the built pages were not compared with their sources" >&2
  exit 0
fi
if [ ! -d node_modules ] && ! npm ci --no-audit --no-fund >&2; then
  echo "skipped: \`npm ci\` could not install the tools; the built pages were not compared with their sources" >&2
  exit 0
fi
npx tsc --noEmit
fresh=$(mktemp -d)
trap 'rm -rf "$fresh"' EXIT
node build.mjs "$fresh" >&2
for page in viewer/static/dance.html viewer/static/live.html studio/static/studio.html; do
  if ! cmp -s "$fresh/${page##*/}" "../src/onbeat/$page"; then
    echo "src/onbeat/$page is not current: run \`npm run build\` in viewer-js and commit it" >&2
    exit 1
  fi
done
echo "the built pages are current" >&2
