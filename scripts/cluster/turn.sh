# To be sourced by a job script: one turn of a run that takes longer than a queue allows.
#
#   one_turn CASE.yaml RUN_FOLDER WALLTIME
#
# Begins the run or goes on with it, whatever the last turn has left behind. Returns 0 where the run is finished and 3 where
# it has saved its state and wants another turn; anything else is an error. USR1 and TERM to the script make the run save
# and stop: both reach mpirun as USR1, which it passes on to every rank without killing any. (After TERM it would kill them
# within two seconds, too soon for a large checkpoint.)

thalweg=${THALWEG:-build/release/bin/thalweg}   # from the folder where the job was submitted

one_turn() {
  local case_file=$1 folder=$2 walltime=$3 before status=0
  local -a start=(--out "$folder")
  before=$(latest_checkpoint "$folder")
  if compgen -G "$folder/checkpoints/step_*.h5" > /dev/null; then
    start+=(--restart "$folder")
  elif [[ -f $folder/case.yaml ]]; then   # an earlier turn was killed before its first checkpoint: nothing to lose
    start+=(--overwrite)
  fi

  mpirun "$thalweg" run "$case_file" "${start[@]}" --walltime "$walltime" &
  job=$!
  trap 'kill -USR1 $job' USR1 TERM
  wait $job || status=$?
  while kill -0 $job 2>/dev/null; do   # that was the trap and not the end; the program is still saving
    status=0
    wait $job || status=$?
  done
  ((status == 0 || status == 3)) || return "$status"   # 3: stopped in good order

  grep -q '"finished": true' "$folder/summary.json" && return 0
  [[ $(latest_checkpoint "$folder") != "$before" ]] && return 3
  echo "${0##*/}: this turn made no new checkpoint, so another would not either; see $folder/run.log." >&2
  return 1
}

latest_checkpoint() { cat "$1/checkpoints/latest" 2>/dev/null || true; }
