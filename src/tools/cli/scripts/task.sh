# The rest is the same for all farms. Usage: task.sh unpack | simulate RUN | draw RUN PART | join RUN | report
#
# A complete task ends at once, and a stopped one resumes. Each output file gets its final name when it is complete, so
# a task may run twice at the same time. Without RUN or PART, the index in the job array of Slurm is used.
pause=${WEFT_PAUSE:-10} # the pause before retry n is n times this [s]
stopped= child=

echo "== $(date -u '+%F %T') $label on $(uname -n)"
code_file=farm/log/$label.code
echo '    ' >"$code_file" # reserves space for the exit code, since the disk may be full at the end

# Slurm sends USR1 before the time limit: the child finishes its current frame, and the task is queued again. At TERM or
# INT, the child needs no signal from here, since schedulers signal all processes of a task.
trap 'stopped=again; [ -z "$child" ] || kill -TERM "$child"' USR1
trap 'stopped=yes' TERM INT

# Runs a command, and again if that may help: after a killed process, an internal error or a full disk.
attempt() {
  tries=0
  while :; do
    "$@" </dev/null &
    child=$!
    wait "$child"
    code=$?
    while [ "$code" -gt 128 ] && kill -0 "$child" 2>/dev/null; do
      wait "$child"
      code=$?
    done
    child=
    case $code in 0 | 2 | 3 | 4 | 5 | 9) return ;; esac
    tries=$((tries + 1))
    if [ -n "$stopped" ] || [ "$tries" -gt "$retries" ]; then return; fi
    echo "exit code $code: try $tries of $retries follows in $((pause * tries)) s"
    sleep $((pause * tries))
    if [ -n "$stopped" ]; then return; fi # by a signal during the pause
  done
}

# Unpacks the program archive once for all tasks. The folder gets its name when it is complete. If two tasks unpack at
# the same time, the second one removes its own folder.
unpack() {
  if [ -z "$unpacked" ] || [ -d "$unpacked" ]; then return 0; fi
  new=$unpacked.new.$(uname -n).$$
  if rm -rf "$new" && mkdir "$new" && tar -xf "$unpacked.tar" -C "$new" && mv "$new" "$unpacked"; then
    rm -rf "$unpacked"/*.new.* "$unpacked".new.* "$unpacked.tar"
  elif ! [ -d "$unpacked" ]; then
    rm -rf "$new"
    echo "weft: farm/task.sh: expected the program in $unpacked.tar, which cannot be unpacked; weft farm submit writes it anew"
    return 6
  fi
}

case $task in
  unpack) attempt unpack ;;
  simulate)
    mkdir -p "$name"
    attempt simulate "$@" --cache "$name/cache" --stats "$name/$scene.json" --frames "$begin:$simulated" --resume \
      --progress none
    ;;
  draw)
    from=$((begin + part * frames_each * step))
    to=$((from + frames_each * step))
    if [ "$to" -gt "$end" ]; then to=$end; fi
    attempt draw "$name/cache" --frames "$from:$to:$step" -o "$name/frames/{frame:05}.png" --resume --progress none
    ;;
  join) attempt join "$name/frames" --frames "$begin:$end:$step" -o "$name/$scene.mp4" --overwrite ;;
  report) attempt report ;;
  *)
    echo "expected unpack, simulate, draw, join or report, got $task" >&2
    code=2
    ;;
esac

case $code in
  0 | 2 | 3 | 4 | 5 | 9) ;; # another machine would give the same exit code
  *)
    if [ "$stopped" = again ] && [ "${SLURM_RESTART_COUNT:-0}" -lt 100 ]; then
      echo "the time limit is near: the task continues from here in a new place in the queue"
      scontrol requeue "$SLURM_JOB_ID" && exit 75
    fi
    ;;
esac
echo "exit code $code"
printf '%-4s\n' "$code" 1<>"$code_file"
exit "$code"
