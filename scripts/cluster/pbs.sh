#!/usr/bin/env bash
# A run longer than the queue's limit, as a job that submits the next one until the case is done.
#
#   CASE=CASE.yaml FOLDER=RUN_FOLDER qsub -v CASE,FOLDER scripts/cluster/pbs.sh      (from the folder of Thalweg)
#
# Adapt the #PBS lines, or give them to qsub: the next job gets the queue, account, project, nodes and walltime of this one, as
# qstat -f tells them. The program saves its state and stops cleanly before the walltime; the next job continues from there,
# and the result has the same bits as a run that was never interrupted, whatever the number of ranks of each job. A job that PBS
# itself runs again (after a failed node: -r y) continues as well. thalweg stop RUN_FOLDER ends it all, also while the next job
# waits in the queue, and so does qdel; the same qsub continues it.
#
# Of these, add to -v which you set:
# THALWEG_LAUNCH=mpiexec      what starts the ranks, with its options (mpirun)
# THALWEG_WALLTIME=HH:MM:SS   how long a turn may take, instead of the walltime less a twentieth or ten minutes
#PBS -N thalweg
#PBS -l select=1:ncpus=64:mpiprocs=64
#PBS -l walltime=24:00:00
#PBS -r y
#PBS -j oe
set -euo pipefail

usage="usage: CASE=CASE.yaml FOLDER=RUN_FOLDER qsub -v CASE,FOLDER pbs.sh"
: "${CASE:?$usage}" "${FOLDER:?$usage}" "${PBS_O_WORKDIR:?$usage}"
cd "$PBS_O_WORKDIR"
scripts=${THALWEG_SCRIPTS:-scripts/cluster}
source "$scripts/turn.sh"

# What PBS knows of this job, an attribute a line: NAME = VALUE. It breaks long lines, and begins what follows with a tab.
told=$(qstat -f "$PBS_JOBID" | sed -e ':join' -e '$!N' -e 's/\n\t//' -e 't join' -e 'P' -e 'D') || told=
attribute() { sed -n "s/^ *$1 = //p" <<<"$told" | head -n 1; }

# s until the walltime is up; nothing where the job has none.
seconds_left() {
  local walltime used
  walltime=$(seconds_of "$(attribute 'Resource_List\.walltime')")
  used=$(seconds_of "$(attribute 'resources_used\.walltime')")
  [[ -z $walltime ]] || echo $((walltime > ${used:-0} ? walltime - ${used:-0} : 0))
}

# Submits the next job as this one was. The variables go by their names, so that their values may hold commas.
submit_next() {
  local options=() option name value resource resources=(select place walltime)
  value=${PBS_O_QUEUE:-$(attribute queue)}   # that it was submitted to, which may have passed it on to another
  [[ -z $value ]] || options+=(-q "$value")
  while read -r option name; do
    value=$(attribute "$name")
    [[ -z $value || $value == _pbs_project_default ]] || options+=("$option" "$value")
  done <<<"-A Account_Name
-P project
-N Job_Name"
  value=$(attribute group_list)
  [[ -z $value ]] || options+=(-W "group_list=$value")
  # PBS works out the others from these, and refuses them, and nodes, beside select; Torque knows nodes only.
  [[ -n $(attribute 'Resource_List\.select') ]] || resources=(nodes walltime)
  for resource in "${resources[@]}"; do
    value=$(attribute "Resource_List\\.$resource")
    [[ -z $value ]] || options+=(-l "$resource=$value")
  done
  local variables=CASE,FOLDER variable
  for variable in THALWEG THALWEG_SCRIPTS THALWEG_LAUNCH THALWEG_WALLTIME; do
    [[ -z ${!variable:-} ]] || { variables+=,$variable; export "${variable?}"; }
  done
  export CASE FOLDER
  qsub "${options[@]}" -v "$variables" "$scripts/pbs.sh"
}

[[ -n $told ]] || say "qstat -f $PBS_JOBID fails, so that the next job has the queue, the nodes and the walltime of this script."
seconds=$(seconds_for_turn "$(seconds_left)")
status=0
one_turn "$CASE" "$FOLDER" "$seconds" || status=$?
((status == 3)) || exit "$status"
submit_next
