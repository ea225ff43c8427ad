#!/usr/bin/env bash
# Times this working tree's program against another commit's, side by side on the same cases.
#
#   benchmarks/compare.sh COMMIT [RANKS [ROUNDS]]      1 rank and 3 rounds by default
#
# The cases are typical ones: the quickstart and the paper's flume at six cells a diameter. Their grains settle
# once, with this tree's program. Each program then starts from that bed, lets the flow develop for 500 steps, and goes on
# from its own checkpoint for 500 timed steps, the two alternating, round by round; the fastest round counts. Prints steps a
# second, the ratio, milliseconds a step by phase, and whether both leave the same bits. Builds the other commit in
# build/compare (a few minutes the first time).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
commit=$(git rev-parse --short "${1:?usage: benchmarks/compare.sh COMMIT [RANKS [ROUNDS]]}")
ranks=${2:-1}
rounds=${3:-3}
source scripts/mpi_environment

work=$PWD/build/compare
other=$work/$commit
mkdir -p "$work"
scripts/build thalweg > "$work/build.log"
[[ -d $other ]] || git clone --quiet --no-checkout . "$other"
git -C "$other" checkout --quiet "$commit"
(cd "$other" && scripts/build thalweg > "$work/build.log" 2>&1) || { tail "$work/build.log"; exit 1; }
programs=("$other/build/release/bin/thalweg" "$PWD/build/release/bin/thalweg")

thalweg() {  # PROGRAM OPTIONS...: runs it quietly, or says what went wrong
  mpirun --quiet -n "$ranks" "$@" > "$work/last.log" 2>&1 || { tail -n 3 "$work/last.log"; return 1; }
}

measure() {  # NAME CASE SETTLED START END: when the bed is taken, the timing begins and ends, in s
  local name=$1 case=$2 settled=$3 start=$4 end=$5
  local quiet=(--overwrite --set output.fluid.every=0 --set output.grains.every=0)
  local bed=$work/$name/bed.h5 round n
  if [[ ! -f $bed ]]; then
    thalweg "${programs[1]}" run "$case" --out "$work/$name" "${quiet[@]}" --until "$settled"
  fi
  local grains="grains=[{placement: {file: $bed}}]"
  for n in 0 1; do
    thalweg "${programs[n]}" run "$case" --out "$work/$name.$n" "${quiet[@]}" --set "$grains" --until "$start"
  done
  for ((round = 0; round < rounds; ++round)); do
    for n in 0 1; do
      thalweg "${programs[n]}" run "$case" --out "$work/$name.$n.$round" "${quiet[@]}" --set "$grains" \
        --restart "$work/$name.$n" --until "$end"
    done
  done
  /usr/bin/python3 benchmarks/compare_rounds.py "$name" "$commit" "$work/$name.0" "$work/$name.1" "$rounds"
}

measure quickstart cases/quickstart/case.yaml 0.6 0.05 0.1
measure flume benchmarks/validation/water_mass/case.yaml 0.6 0.05 0.1
