#!/bin/sh
# Shows that the regression tests detect small changes of the program: applies each line of mutations.txt to a copy of
# the last commit, builds it, draws the stills and compares them. Each line takes about a minute of CPU time, so ctest
# runs only --check.
#
#     tests/regression/mutations.sh FOLDER [STILL...]     table in FOLDER/mutations.md; without names, all stills
#     tests/regression/mutations.sh --check               checks that each line still changes its file: a test
set -uf
here=$(cd "$(dirname -- "$0")" && pwd)
root=$here/../..
if [ "${1:-}" = --check ]; then
  grep -v '^#' "$here/mutations.txt" | {
    status=0
    while IFS='|' read -r name file change; do
      file=$root/$(echo "$file" | tr -d ' ')
      if [ ! -f "$file" ] || sed "$change" "$file" | cmp -s - "$file"; then
        status=1
        echo "$name: changes nothing in $file"
      fi
    done
    exit $status
  }
  exit
fi
mkdir -p "$1/source"
folder=$(cd "$1" && pwd)
source=$folder/source
shift

build() {
  ninja -C "$source/build" weft_tools_program >"$folder/build.log" 2>&1 || { tail "$folder/build.log"; exit 1; }
}

# Prints the lines of `weft diff`, one per still.
compare() { # OUTPUT STILL...
  output=$1
  shift
  if [ $# -eq 0 ]; then
    sh "$source/tests/regression/check.sh" "$source/build/bin/weft" "$output" 2>/dev/null
  fi
  for still; do
    sh "$source/tests/regression/check.sh" "$source/build/bin/weft" "$output" "$still" 2>/dev/null
  done
}

git -C "$root" archive HEAD | tar x -C "$source"
CCACHE_BASEDIR=$source
CCACHE_NOHASHDIR=1
export CCACHE_BASEDIR CCACHE_NOHASHDIR
if command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
cmake -S "$source" -B "$source/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DWEFT_TESTS=OFF >/dev/null || exit 1
build
compare "$folder/unchanged" "$@" | tee "$folder/unchanged.txt"
if grep -q DIFFERS "$folder/unchanged.txt"; then
  echo "the unchanged program already differs from its references: accept them first"
  exit 1
fi

table=$folder/mutations.md
echo "| mutation | caught by | worst still | pixels over 4 levels | largest | FLIP | spot | SSIM |" >"$table"
echo "|---|---|---|---|---|---|---|---|" >>"$table"
number=0
while IFS='|' read -r name file change; do
  case $name in '#'*) continue ;; esac
  name=$(echo "$name" | sed 's/ *$//') file=$(echo "$file" | tr -d ' ')
  number=$((number + 1))
  cp -p "$source/$file" "$folder/original"
  sed "$change" "$folder/original" >"$source/$file"
  cmp -s "$source/$file" "$folder/original" && { echo "$name: changes nothing in $file"; exit 1; }
  build
  compare "$folder/$number" "$@" >"$folder/$number.txt"
  cp "$folder/original" "$source/$file" # the new time of change makes ninja rebuild it
  # Fields of the line with the largest FLIP.
  awk -v name="$name" '
    / pixels differ/ {
      ++compared
      if (/DIFFERS/) caught = caught (caught ? ", " : "") substr($1, 1, index($1, ".") - 1)
      match($0, /FLIP [^ ,(]+/); flip = substr($0, RSTART + 5, RLENGTH - 5)
      if (flip + 0 < worst + 0) next
      worst = flip; still = substr($1, 1, index($1, ".") - 1)
      match($0, /[0-9]+ by more/); over = substr($0, RSTART, RLENGTH - 8)
      match($0, /; at most [0-9]+/); largest = substr($0, RSTART + 10, RLENGTH - 10)
      match($0, /of [0-9]+ pixels/); pixels = substr($0, RSTART + 3, RLENGTH - 10)
      rest = substr($0, index($0, "FLIP")); match(rest, /, at most [^ ;(]+/); spot = substr(rest, RSTART + 10, RLENGTH - 10)
      match($0, /SSIM .*/); ssim = substr($0, RSTART + 5)
    }
    END {
      if (!compared) { print "| " name " | **none: all stills are the same** | | | | | | |"; exit }
      printf "| %s | %s | %s | %.2f %% | %d | %s | %s | %s |\n", name, caught ? caught : "**none**", still,
             100 * over / pixels, largest, worst, spot, ssim
    }' "$folder/$number.txt" | tee -a "$table"
done <"$here/mutations.txt"
