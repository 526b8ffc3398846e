#!/bin/sh
# build_time.sh BUILD: prints how long each part of the program takes to compile, as Markdown, from ninja's log. Sums
# wall-clock seconds of jobs: on a busy machine only ratios are meaningful.
set -eu
awk -F '\t' '
  function name_of(path) { split(path, part, "/"); name = part[3]; sub(/^weft_/, "", name); sub(/\.dir$/, "", name); return name }
  $4 ~ /^src\/CMakeFiles\/weft_[a-z_]+\.dir\/.*\.(o|gch)$/ {
    # If a unit was compiled more than once, only its first time counts.
    if ($4 in seconds) next
    units[name_of($4)]++
    seconds[$4] = ($2 - $1) / 1000
  }
  END {
    for (path in seconds) { sum[name_of(path)] += seconds[path]; all += seconds[path]; if (seconds[path] > most[name_of(path)]) most[name_of(path)] = seconds[path] }
    for (name in sum) if (sum[name] < 0.03 * all) { few += sum[name]; few_units += units[name]; delete sum[name] }
    printf "00000.1 | parts below 3 %% | %d | %.0f | | %.0f %% |\n", few_units, few, 100 * few / all
    for (name in sum) printf "%08.1f | %s | %d | %.0f | %.0f | %.0f %% |\n", sum[name], name, units[name], sum[name], most[name], 100 * sum[name] / all
    printf "00000.0 | all | | %.0f | | 100 %% |\n", all
  }' "$1/.ninja_log" | sort -r | awk 'BEGIN {
    print "| part | units | s of jobs | slowest unit s | share |"; print "|---|---|---|---|---|" } { sub(/^[0-9.]+ /, ""); print }'
