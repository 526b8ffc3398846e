set -e

submit_task() { # NAME TASK OPTION...
  name=$1 task=$2
  shift 2
  job=$(run_sbatch --parsable --job-name="weft-$name" --requeue --signal=B:USR1@60 --kill-on-invalid-dep=yes \
    --open-mode=append --output=farm/log/slurm.log "$@" --wrap="exec sh farm/task.sh $task")
  job=${job%%;*}
  printf '%s\t%s\n' "$job" "$name" >>farm/jobs
}

