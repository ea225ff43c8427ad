#!/usr/bin/env bash
# A run longer than the queue's limit, as a job that submits the next one until the case is done.
#
#   qsub -v CASE=CASE.yaml,FOLDER=RUN_FOLDER scripts/cluster/pbs.sh      (from the folder of Thalweg)
#
# Adapt the #PBS lines (or give them to qsub) and, with another walltime, THALWEG_WALLTIME (to be added to -v). The program
# saves its state and stops in good order before its --walltime; the next job goes on from there, and the result has the
# same bits as a run that was never interrupted, whatever the number of ranks of each job. A job that PBS itself runs again
# (after a failed node: -r y) goes on as well. thalweg stop RUN_FOLDER ends it all, also while the next job waits in the queue,
# and so does qdel; the same qsub goes on.
#PBS -N thalweg
#PBS -l select=1:ncpus=64:mpiprocs=64
#PBS -l walltime=24:00:00
#PBS -r y
#PBS -j oe
set -euo pipefail
cd "$PBS_O_WORKDIR"

usage="usage: qsub -v CASE=CASE.yaml,FOLDER=RUN_FOLDER pbs.sh"
case_file=${CASE:?$usage}
folder=${FOLDER:?$usage}
walltime=${THALWEG_WALLTIME:-23:50:00}   # ten minutes before that of the job
scripts=${THALWEG_SCRIPTS:-scripts/cluster}

source "$scripts/turn.sh"
status=0
one_turn "$case_file" "$folder" "$walltime" || status=$?
((status == 3)) || exit "$status"
passed_on="CASE=$case_file,FOLDER=$folder,THALWEG_WALLTIME=$walltime,THALWEG_SCRIPTS=$scripts,THALWEG=$thalweg"
qsub -v "$passed_on" "$scripts/pbs.sh"
