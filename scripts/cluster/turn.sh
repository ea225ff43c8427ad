# shellcheck shell=bash
# To be sourced by a job script: one turn of a run that takes longer than a queue allows.
#
#   one_turn CASE.yaml RUN_FOLDER SECONDS
#
# SECONDS: what is left of the job's time (seconds_of, less_a_margin); empty: unknown, and the run is told of no limit.
# Starts or continues the run, whatever the last turn has left behind: thalweg run --resume decides, and loses nothing.
# Returns 0 where the run is finished, 3 where it has saved its state and wants another turn, and 4 where its user has stopped
# it: with thalweg stop, now or while this job waited in the queue, or with scancel or qdel. Anything else is an error.
# USR1 and TERM to the script make the run save and stop: both reach the launcher as USR1, which it passes on to every rank
# without killing any. (After TERM mpirun would kill them within two seconds, too soon for a large checkpoint.) TERM before
# SECONDS have passed is taken for scancel or qdel; after that, for the end of the job's time.

thalweg=${THALWEG:-build/release/bin/thalweg}   # from the folder where the job was submitted
read -ra launcher <<<"${THALWEG_LAUNCH:-mpirun}"   # what starts a program on all ranks of the job, with its options

one_turn() {
  local case_file=$1 folder=$2 seconds=$3 before status signalled cancelled='' began=$SECONDS limit=()
  before=$(latest_checkpoint "$folder")
  [[ -z $seconds ]] || limit=(--walltime "$(clock_of "$seconds")")

  "${launcher[@]}" "$thalweg" run "$case_file" "--out=$folder" --resume ${limit[@]+"${limit[@]}"} &
  job=$!
  trap 'signalled=1; kill -USR1 $job 2>/dev/null || true' USR1
  trap 'signalled=1; [[ -n $seconds ]] && ((SECONDS - began >= seconds)) || cancelled=1
        kill -USR1 $job 2>/dev/null || true' TERM
  signalled=1
  while [[ -n $signalled ]]; do   # a signal ends the wait, and the program is still saving
    signalled=
    status=0
    wait $job || status=$?
  done
  trap - USR1 TERM
  ((status == 3)) || return "$status"

  if [[ -n $cancelled ]]; then
    say "TERM${seconds:+ before the walltime of $(clock_of "$seconds")}, as from scancel or qdel: the run has saved its state," \
        "and this job is not queued again; the same submission continues it."
    return 4
  fi
  [[ $(latest_checkpoint "$folder") != "$before" ]] && return 3
  say "this turn made no new checkpoint, so another would not either; see $folder/run.log."
  return 1
}

say() { echo "${0##*/}: $*" >&2; }

latest_checkpoint() { cat -- "$1/checkpoints/latest" 2>/dev/null || true; }

# Of D-HH:MM:SS, D-HH:MM, D-HH, HH:MM:SS, MM:SS or whole seconds; nothing of anything else, such as UNLIMITED.
seconds_of() {
  local days=0 clock=$1 seconds=0 part
  if [[ $clock =~ ^[0-9]+-[0-9]+$ ]]; then clock+=:00; fi
  if [[ $clock =~ ^[0-9]+-[0-9]+:[0-9]+$ ]]; then clock+=:00; fi
  [[ $clock =~ ^([0-9]+-)?([0-9]+:)?([0-9]+:)?[0-9]+$ ]] || return 0
  [[ $clock != *-* ]] || { days=${clock%%-*}; clock=${clock#*-}; }
  for part in ${clock//:/ }; do ((seconds = 60 * seconds + 10#$part)) || true; done
  echo $((86400 * 10#$days + seconds))
}

# HH:MM:SS
clock_of() { printf '%02d:%02d:%02d' $(($1 / 3600)) $(($1 / 60 % 60)) $(($1 % 60)); }

# What of the SECONDS that a job has left is the run's: a twentieth, ten minutes at most, is kept for the launcher and the script.
less_a_margin() {
  [[ -n $1 ]] || return 0
  local -i margin=$(($1 / 20))
  ((margin <= 600)) || margin=600
  echo $(($1 > margin ? $1 - margin : 1))
}

# What a turn may take, in s: as THALWEG_WALLTIME says, or of the time left (s) by the scheduler's word; nothing where neither is known.
seconds_for_turn() {
  local seconds
  if [[ -n ${THALWEG_WALLTIME:-} ]]; then
    seconds=$(seconds_of "$THALWEG_WALLTIME")
    [[ -n $seconds ]] || { say "THALWEG_WALLTIME=$THALWEG_WALLTIME is not a time; give HH:MM:SS."; return 2; }
    echo "$seconds"
  else
    [[ -n $1 ]] || say "the scheduler does not tell when this job ends; if it has a limit, give it as THALWEG_WALLTIME=HH:MM:SS," \
                       "some minutes less."
    less_a_margin "$1"
  fi
}
