#!/bin/sh
# Draws each scene below scenes/ into out/ (a video, and a picture of every tenth frame), and compares out/ with
# references/. Differences go to report/, statistics of each run to report/stats/. Arguments such as --threads 4 go to the
# simulations. If a scene fails, the others are still drawn. Exit code: that of the first scene that failed; else 0 if all
# pictures match, 7 if a picture differs or is missing, 8 if a picture has no reference.
cd -- "$(dirname -- "$0")" || exit 2
weft=${WEFT:-weft}
size=480x270
mkdir -p report || exit 6
rm -rf out caches report/*
mkdir -p out report/stats || exit 6

draw() {
  scene=$1 name=$2
  shift 2
  mkdir -p "report/stats/$(dirname -- "$name")" &&
    "$weft" simulate "$scene" --cache "caches/$name" --stats "report/stats/$name.json" --progress none "$@" &&
    "$weft" render "caches/$name" -o "out/$name.mp4" --size "$size" --progress none &&
    "$weft" render "caches/$name" -o "out/$name/{frame:05}.png" --frames ::10 --size "$size" --progress none
}

find scenes -name '*.toml' | sort >report/scenes.txt
failed=0
while IFS= read -r scene; do
  name=${scene#scenes/}
  draw "$scene" "${name%.toml}" "$@" </dev/null && continue
  code=$?
  echo "pictures.sh: $scene failed with exit code $code" >&2
  [ "$failed" != 0 ] || failed=$code
done <report/scenes.txt

"$weft" diff references out --limits limits.toml --html report/index.html --junit report/junit.xml
code=$?
[ "$failed" = 0 ] || exit "$failed"
exit "$code"
