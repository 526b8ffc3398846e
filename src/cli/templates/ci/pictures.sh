#!/bin/sh
# Draws every scene below scenes/ into out/, a video and a picture of each tenth frame, and compares all of them with
# references/. What differs is in report/. People and the workflow run just this. Options go to the simulations, such as
# --threads 4. Exit codes: 0 all as it was, 7 a picture differs or is missing, 8 a picture has no reference, others: the
# first command that failed.
cd -- "$(dirname -- "$0")" || exit 2
weft=${WEFT:-weft}
size=480x270
mkdir -p report || exit 6
rm -rf out caches report/*

find scenes -name '*.toml' | sort | while IFS= read -r scene; do
  name=${scene#scenes/}
  name=${name%.toml}
  "$weft" simulate "$scene" --cache "caches/$name" --progress none "$@" || exit
  "$weft" render "caches/$name" -o "out/$name.mp4" --size "$size" --progress none || exit
  "$weft" render "caches/$name" -o "out/$name/{frame:05}.png" --frames ::10 --size "$size" --progress none || exit
done || exit

"$weft" diff references out --limits limits.toml --html report/index.html --junit report/junit.xml
