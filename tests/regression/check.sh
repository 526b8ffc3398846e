#!/bin/sh
# Draws stills and compares them with their references, as the regression tests of a user would:
#
#     tests/regression/check.sh WEFT OUTPUT [NAME]     one still, or all of stills.txt; exit codes of `weft diff`
#
# After an intended change, inspect OUTPUT and OUTPUT/differences, then
#
#     WEFT accept tests/regression/references OUTPUT/*.png --reason "why"
set -uf
here=$(cd "$(dirname -- "$0")" && pwd)
root=$here/../..
weft=$1 output=$2 only=${3:-}
mkdir -p "$output"

# Draws a still. Removes the file of an earlier run first, so that it does not count as a result of this run.
draw() { # NAME SCENE FRAME CHANGE...
  name=$1 scene=$2 frame=$3
  shift 3
  for change; do
    set -- "$@" --set "$change"
    shift
  done
  rm -f "$output/$name.png"
  "$weft" thumbnail "$root/$scene" --frame "$frame" --size 320x180 -o "$output/$name.png" --progress none "$@"
}

while read -r line; do
  # shellcheck disable=SC2086 # split into words
  case $line in
    '' | '#'*) ;;
    "${only:-*}"' '*) draw $line || exit ;;
    *) [ -n "$only" ] || draw $line || exit ;;
  esac
done <"$here/stills.txt"
rm -rf "$output/differences" # `weft diff` would compare those of an earlier run too
[ -n "$only" ] && exec "$weft" diff "$here/references" "$output/$only.png" --heatmap "$output/differences" --overwrite
exec "$weft" diff "$here/references" "$output" --heatmap "$output/differences" --overwrite
