#!/usr/bin/env bash
# Counts the messages and bytes that the busiest rank sends in a step of the fluid: count.sh CASE FROM UNTIL RANKS...
#
# The case runs to FROM (s) on all cores; from there to UNTIL, and half as far, on each number of ranks. The difference of the
# two, divided by the steps between them, excludes what is sent at the start and at the end. Nothing is timed.
set -euo pipefail
case=$(realpath "${1:?usage: count.sh CASE FROM UNTIL RANKS...}") from=$2 until=$3
shift 3
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scripts/build thalweg count_messages >/dev/null
source scripts/mpi_environment
thalweg=$PWD/build/release/bin/thalweg
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
quiet=(--set output.grains.every=0 --set output.fluid.every=0 --set output.checkpoint.every=0)

run() {  # RANKS OPTIONS...: prints the messages and bytes of the rank that sends most
  mpirun --quiet -n "$1" -x LD_PRELOAD="$PWD/build/release/lib/count_messages.so" "$thalweg" run "$case" "${quiet[@]}" \
    "${@:2}" >"$work/log" 2>&1 </dev/null || { tail -n 3 "$work/log" >&2; return 1; }
  awk '/^sent by rank/ {if ($5 > messages) messages = $5; if ($7 > bytes) bytes = $7} END {print messages + 0, bytes + 0}' "$work/log"
}
steps() { /usr/bin/python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["steps_in_this_session"])' "$1/summary.json"; }

run "$(available_cores)" --out "$work/start" --until "$from" >/dev/null
half=$(awk "BEGIN {print ($from + $until) / 2}")
echo "ranks  messages a step  bytes a step"
for ranks in "$@"; do
  read -r messages_1 bytes_1 < <(run "$ranks" --restart "$work/start" --out "$work/half.$ranks" --until "$half")
  read -r messages_2 bytes_2 < <(run "$ranks" --restart "$work/start" --out "$work/whole.$ranks" --until "$until")
  between=$(($(steps "$work/whole.$ranks") - $(steps "$work/half.$ranks")))
  awk "BEGIN {printf \"%5d %16.1f %13.0f\n\", $ranks, ($messages_2 - $messages_1) / $between, ($bytes_2 - $bytes_1) / $between}"
done
