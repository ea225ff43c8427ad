# To be sourced by a job script: one turn of a run that takes longer than a queue allows.
#
#   one_turn CASE.yaml RUN_FOLDER WALLTIME
#
# Begins the run or goes on with it, whatever the last turn has left behind: thalweg run --resume decides, and loses nothing.
# Returns 0 where the run is finished, 3 where it has saved its state and wants another turn, and 4 where its user has stopped
# it: with thalweg stop, now or while this job waited in the queue, or with scancel or qdel. Anything else is an error.
# USR1 and TERM to the script make the run save and stop: both reach mpirun as USR1, which it passes on to every rank without
# killing any. (After TERM it would kill them within two seconds, too soon for a large checkpoint.) TERM before WALLTIME has
# passed is taken for scancel or qdel; after it, for the end of the job's time.

thalweg=${THALWEG:-build/release/bin/thalweg}   # from the folder where the job was submitted

one_turn() {
  local case_file=$1 folder=$2 before status signalled cancelled= began=$SECONDS
  local -i walltime_seconds
  walltime_seconds=$(seconds_of "$3")
  before=$(latest_checkpoint "$folder")

  mpirun "$thalweg" run "$case_file" --out "$folder" --resume --walltime "$3" &
  job=$!
  trap 'signalled=1; kill -USR1 $job 2>/dev/null || true' USR1
  trap 'signalled=1; ((SECONDS - began >= walltime_seconds)) || cancelled=1; kill -USR1 $job 2>/dev/null || true' TERM
  signalled=1
  while [[ -n $signalled ]]; do   # a signal ends the wait, and the program is still saving
    signalled=
    status=0
    wait $job || status=$?
  done
  trap - USR1 TERM
  ((status == 3)) || return "$status"

  if [[ -n $cancelled ]]; then
    echo "${0##*/}: TERM before the walltime of $3, as from scancel or qdel: the run has saved its state, and this job is not" \
         "queued again; the same submission goes on." >&2
    return 4
  fi
  [[ $(latest_checkpoint "$folder") != "$before" ]] && return 3
  echo "${0##*/}: this turn made no new checkpoint, so another would not either; see $folder/run.log." >&2
  return 1
}

latest_checkpoint() { cat "$1/checkpoints/latest" 2>/dev/null || true; }

# Of D-HH:MM:SS, HH:MM:SS or MM:SS.
seconds_of() {
  local days=0 clock=$1 seconds=0 part
  [[ $clock != *-* ]] || { days=${clock%%-*}; clock=${clock#*-}; }
  for part in ${clock//:/ }; do ((seconds = 60 * seconds + 10#$part)) || true; done
  echo $((86400 * days + seconds))
}
