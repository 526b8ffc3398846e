# Functions that `weft` and `tests/run` share: packages, lock and build. These scripts source this file; $root must be
# the top folder of the source tree. All messages go to stderr, because stdout is for the output of the program.

say() { echo "weft: $*" >&2; }
die() { status=$1; shift; say "$*"; exit "$status"; }

# use_preset NAME: selects the build folder of a preset, waits until no other process builds there, and locks it. To
# unlock: exec 9>&-
use_preset() {
  preset=$1
  folder=$root/build
  [ "$preset" = release ] || folder=$root/build-$preset
  { mkdir -p "$folder" && : >>"$folder/.lock"; } 2>/dev/null || die 2 "cannot write in $folder, where Weft is built"
  exec 9>>"$folder/.lock"
  flock -n 9 || { say "waiting for another build in $folder"; flock 9; }
}

# quietly COMMAND...: runs the command with its output in a log file. Prints this log only if the command fails.
quietly() {
  "$@" </dev/null >"$folder/launch.log" 2>&1 || { cat "$folder/launch.log" >&2; return 1; }
}

# choose CHOICE...: prints, for each choice A|B|C, the first alternative that apt knows, else the last one. An
# alternative may be several packages, separated by commas.
choose() {
  for choices; do
    while [ "${choices#*|}" != "$choices" ] && ! apt-cache show "${choices%%[|,]*}" >/dev/null 2>&1; do
      choices=${choices#*|}
    done
    echo "${choices%%|*}" | tr , ' '
  done
}

# need_packages KIND...: installs missing packages of these kinds (first column of .packages). Apt must not inherit the
# lock of use_preset, because daemons that a package starts would keep it.
need_packages() {
  command -v dpkg-query >/dev/null || return 0  # not Debian: CMake will name what it cannot find
  missing=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' | awk -v kinds=" $* " '
    NR == FNR { if ($2 == "installed") installed[$1]; next }
    NF && index(kinds, " " $1 " ") {
      for (i = split($2, choices, "|"); i > 0; i--) {
        absent = 0
        for (k = split(choices[i], packages, ","); k > 0; k--) absent += !(packages[k] in installed)
        if (!absent) next
      }
      printf " %s", $2
    }' - "$root/.packages")
  [ -n "$missing" ] || return 0
  # shellcheck disable=SC2046,SC2086 # one word per package
  [ "$(id -u)" = 0 ] || die 2 "Debian packages are missing; install them and call again:
  sudo apt-get update && sudo apt-get install --no-install-recommends "$(choose $missing)
  export DEBIAN_FRONTEND=noninteractive
  # shellcheck disable=SC2086
  { quietly apt-get -q -o DPkg::Lock::Timeout=600 update && missing=$(choose $missing) && say "installing" $missing &&
    quietly apt-get -q -y -o DPkg::Lock::Timeout=600 install --no-install-recommends $missing; } 9>&- ||
    die 2 "apt-get could not install" $missing
}

# configure [-DNAME=VALUE...]: runs CMake if it has not run yet, if the source tree has moved, or if an option has
# another value. (Ninja detects changes of CMake files itself.) Builds have no tests unless an option asks for them.
configure() {
  cache=$folder/CMakeCache.txt
  if [ ! -f "$folder/build.ninja" ] || ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$cache"; then
    set -- --fresh -DWEFT_TESTS=OFF "$@"
  else
    differs=
    for option; do grep -qxF "${option#-D}" "$cache" || differs=1; done
    [ -n "$differs" ] || return 0
  fi
  quietly cmake -S "$root" --preset "$preset" "$@" || die 1 "the build could not be configured"
}

# report_progress: reads the output of ninja, and prints every 15 s how many files are built. Returns the exit status of
# ninja, which the last line contains.
report_progress() {
  due=15
  while read -r count seconds rest; do
    seconds=${seconds%%.*}
    case $count in
      exit) return "$seconds" ;;
      "["*/*"]") [ "$seconds" -ge "$due" ] || continue ;;
      *) continue ;;
    esac
    finished=${count%/*} all=${count#*/} due=$((seconds + 15))
    finished=${finished#?} all=${all%?}
    say "$finished of $all files, about $(((seconds * (all - finished) / finished + 59) / 60)) min left"
  done
}

# build TARGET...: builds the targets. Runs one compiler per processor, but only as many as have 1.5 GB of free memory
# each.
build() {
  jobs=$(awk -v jobs="$(nproc)" '/^MemAvailable:/ { fit = int($2 / 1500000) }
                                 END { print fit < 1 ? 1 : fit < jobs ? fit : jobs }' /proc/meminfo)
  say "building"
  if [ -t 2 ]; then
    ninja -C "$folder" -j "$jobs" "$@" >&2
  else
    { NINJA_STATUS="[%f/%t] %e s: " ninja -C "$folder" -j "$jobs" "$@" </dev/null 2>&1; echo "exit $?"; } |
      tee "$folder/launch.log" | report_progress || { sed '$d' "$folder/launch.log" >&2; false; }
  fi || die 1 "the build failed"
}
