#!/usr/bin/env bash
# A run longer than the queue's limit, as one job that puts itself back into the queue until the case is done.
#
#   sbatch scripts/cluster/slurm.sh CASE.yaml RUN_FOLDER
#
# Adapt the #SBATCH lines (or give them to sbatch) and, with another --time, THALWEG_WALLTIME. The program saves its
# state and stops in good order before its --walltime; the next turn goes on from there, and the result has the same bits
# as a run that was never interrupted, whatever the number of ranks of each turn.
#SBATCH --job-name=thalweg
#SBATCH --nodes=1
#SBATCH --ntasks-per-node=64
#SBATCH --time=24:00:00
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=%x_%j.log
#SBATCH --signal=B:USR1@300
set -euo pipefail

case_file=${1:?usage: sbatch slurm.sh CASE.yaml RUN_FOLDER}
folder=${2:?usage: sbatch slurm.sh CASE.yaml RUN_FOLDER}
thalweg=${THALWEG:-build/release/bin/thalweg}   # from the folder where sbatch was called
walltime=${THALWEG_WALLTIME:-23:50:00}          # ten minutes before --time

latest() { cat "$folder/checkpoints/latest" 2>/dev/null || true; }

before=$(latest)
start=(--out "$folder")
if compgen -G "$folder/checkpoints/step_*.h5" > /dev/null; then
  start+=(--restart "$folder")
elif [[ -f $folder/case.yaml ]]; then   # an earlier turn was killed before its first checkpoint: nothing to lose
  start+=(--overwrite)
fi

mpirun "$thalweg" run "$case_file" "${start[@]}" --walltime "$walltime" &
job=$!
trap 'kill -USR1 $job' USR1   # the queue wants the nodes back: every rank gets the signal, saves and stops
status=0
wait $job || status=$?
while kill -0 $job 2>/dev/null; do   # that was the trap and not the end; the program is still saving
  status=0
  wait $job || status=$?
done
((status == 0 || status == 3)) || exit "$status"   # 3: stopped in good order

finished=$(python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["finished"])' "$folder/summary.json")
[[ $finished == True ]] && exit 0
if [[ $(latest) == "$before" ]]; then
  echo "slurm.sh: this turn made no new checkpoint, so another would not either; see $folder/run.log." >&2
  exit 1
fi
scontrol requeue "$SLURM_JOB_ID"
