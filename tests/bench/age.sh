#!/bin/sh
# age.sh: prints, for each file of measured/, how many commits have changed the program's code since the commit it was
# measured with. Needs the history of the repository.
set -eu
cd "$(dirname "$0")/measured"
for file in *.md; do
  commit=$(sed -n 's/^weft [0-9.]* of commit \([0-9a-f]*\),.*/\1/p' "$file")
  case $file in
    build.md | distances.md | falling_band.md | multi_sheet*.md | wound_ball.md) code=src/collision ;;
    linear_solvers.md) code=src/solver ;;
    drawing.md) code="src/render src/simulation src/solver src/collision" ;;
    build_time.md) code=src ;;
    *) code="src/simulation src/solver src/collision src/integrator src/forces src/bench" ;;
  esac
  if count=$(cd ../../.. && git rev-list --count "$commit"..HEAD -- $code 2>/dev/null); then
    echo "$file: commit $commit, $count later changes of $code"
  else
    echo "$file: commit $commit is not in the history here"
  fi
done
