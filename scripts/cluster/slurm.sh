#!/usr/bin/env bash
# A run longer than the queue's limit, as one job that puts itself back into the queue until the case is done.
#
#   sbatch scripts/cluster/slurm.sh CASE.yaml RUN_FOLDER      (from the folder of Thalweg)
#
# Adapt the #SBATCH lines (or give them to sbatch) and, with another --time, THALWEG_WALLTIME. The program saves its
# state and stops in good order before its --walltime; the next turn goes on from there, and the result has the same bits
# as a run that was never interrupted, whatever the number of ranks of each turn. thalweg stop RUN_FOLDER ends it all, also while
# the job waits in the queue, and so does scancel; the same sbatch goes on.
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
walltime=${THALWEG_WALLTIME:-23:50:00}   # ten minutes before --time

source "${THALWEG_SCRIPTS:-scripts/cluster}/turn.sh"
status=0
one_turn "$case_file" "$folder" "$walltime" || status=$?
((status == 3)) || exit "$status"
scontrol requeue "$SLURM_JOB_ID"
