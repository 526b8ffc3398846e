#!/bin/sh
# Changes one member of Numerics, builds the program and runs tests, to see which tests detect the change.
# Usage, in the folder of the project after a build: change_numerics.sh 'newton.slow_after *= 10' [CTEST_OPTION...]
set -eu
[ $# -ge 1 ] || { echo "usage: $0 'GROUP.MEMBER *= 10' [CTEST_OPTION...]" >&2; exit 2; }
change=$1
shift
restore() { cmake -S . -B build -DWEFT_CHANGED_NUMERICS= >/dev/null && ninja -C build >/dev/null; }
trap restore EXIT
cmake -S . -B build "-DWEFT_CHANGED_NUMERICS=$change" >/dev/null
ninja -C build >/dev/null
ctest --test-dir build -LE slow --output-on-failure "$@"
