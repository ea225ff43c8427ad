#!/usr/bin/env bash
# A run longer than the queue's limit, as one job that puts itself back into the queue until the case is done.
#
#   sbatch scripts/cluster/slurm.sh CASE.yaml RUN_FOLDER      (from the folder of Thalweg)
#
# Adapt the #SBATCH lines, or give them to sbatch. The program asks Slurm how long the job may take, saves its state and stops
# cleanly before that; the next turn continues from there, and the result has the same bits as a run that was never
# interrupted, whatever the number of ranks of each turn. thalweg stop RUN_FOLDER ends it all, also while the job waits in the
# queue, and so does scancel; the same sbatch continues it.
#
# THALWEG_LAUNCH=srun         what starts the ranks, with its options (mpirun)
# THALWEG_WALLTIME=HH:MM:SS   how long a turn may take, instead of Slurm's word less a twentieth or ten minutes
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
source "${THALWEG_SCRIPTS:-scripts/cluster}/turn.sh"

# s until the job's time is up; nothing where it has no limit.
seconds_left() {
  if [[ -n ${SLURM_JOB_END_TIME:-} ]]; then
    local left=$((SLURM_JOB_END_TIME - $(date +%s)))
    echo $((left > 0 ? left : 0))
  else
    seconds_of "$(squeue --noheader --jobs "$SLURM_JOB_ID" --format %L 2>/dev/null | tr -d ' ' || true)"
  fi
}

seconds=$(seconds_for_turn "$(seconds_left)")
status=0
one_turn "$case_file" "$folder" "$seconds" || status=$?
((status == 3)) || exit "$status"
scontrol requeue "$SLURM_JOB_ID"
