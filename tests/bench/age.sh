#!/bin/sh
# age.sh: prints, for each file of measured/, how many commits have changed the measured code since the commit that the
# file names. Needs the history of the repository.
set -eu
cd "$(dirname "$0")/measured"
for file in *.md; do
  commit=$(sed -n 's/^weft [0-9.]* of commit \([0-9a-f]*\),.*/\1/p' "$file")
  case $file in
    build.md | distances.md | falling_band.md | multi_sheet*.md | wound_ball.md) modules=collision ;;
    linear_solvers.md) modules=solver ;;
    build_time.md) modules= ;;
    *) modules="simulation solver collision integrator forces bench" ;;
  esac
  code=${modules:+$(for module in $modules; do echo "src/$module src/*/$module"; done)}  # both depths in the history
  if count=$(cd ../../.. && git rev-list --count "$commit"..HEAD -- ${code:-src} 2>/dev/null); then
    echo "$file: commit $commit, $count later changes of ${modules:-src}"
  else
    echo "$file: commit $commit is not in the history here"
  fi
done
