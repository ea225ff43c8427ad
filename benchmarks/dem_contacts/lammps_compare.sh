#!/bin/sh
# Times LAMMPS on the beds of dem_contacts, with the same law: pair_style gran/hooke/history (Debian package lammps).
#
#   lammps_compare.sh PROGRAM [RANKS]      PROGRAM: the built dem_contacts; LMP: the LAMMPS program, `lmp` by default
#
# Each bed: first Thalweg, then LAMMPS with newton on and off and three skins of its neighbour list, its atoms sorted in
# space before the timing; each the fastest of several intervals. The best settings of LAMMPS count, and are printed.
# Million grain-steps per second.
set -eu
program=${1:?usage: lammps_compare.sh PROGRAM [RANKS]}
ranks=${2:-1}
lmp=${LMP:-lmp}
command -v "$lmp" > /dev/null || { echo "LAMMPS ($lmp) is not installed: apt install lammps"; exit 0; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

for bed in 2884:3000 23072:400 103824:80; do
  grains=${bed%:*}
  steps=${bed#*:}
  mpirun --oversubscribe -n "$ranks" "$program" --grains "$grains" --write-lammps "$folder/bed.data" > "$folder/ours"
  # gamma_n = gamma/m* of a pair; e = 0.93: zeta = 0.023094, gamma/m* = 2 zeta sqrt(k_n/m*), m* = m/2.
  cat > "$folder/in.bed" <<'INPUT'
units si
atom_style sphere
comm_modify vel yes
processors * * 1
newton ${newton}
boundary p p f
read_data ${data}
pair_style gran/hooke/history 20000 5714 715.05 0 0.5 0
pair_coeff * *
neighbor ${skin} bin
neigh_modify delay 0 every 20 check no
atom_modify sort 1 0
fix gravity all gravity 9.8 vector 0 0 -1
fix floor all wall/gran hooke/history 20000 5714 715.05 0 0.5 0 zplane 0 NULL
fix motion all nve/sphere
timestep 2e-6
thermo 1000000
run 100 post no
neigh_modify delay 0 every 1 check yes
label again
variable stretch loop 5
run ${steps} post no
next stretch
jump SELF again
INPUT
  : > "$folder/theirs"
  for newton in on off; do
    for skin in 0.0005 0.0002 0.0001; do
      echo "settings newton $newton, skin $skin m" >> "$folder/theirs"
      mpirun --oversubscribe -n "$ranks" "$lmp" -in "$folder/in.bed" -var data "$folder/bed.data" -var steps "$steps" \
        -var newton "$newton" -var skin "$skin" -log none >> "$folder/theirs"
    done
  done
  awk -v grains="$grains" -v steps="$steps" '
    FNR == NR { if (match($0, /"million_grain_steps_per_second_[0-9]+": [0-9.]+/)) {
                  split(substr($0, RSTART, RLENGTH), part, ": "); ours = part[2] } next }
    /^settings/ { settings = substr($0, 10) }
    /^Loop time of/ && $(NF-4) == steps { if (!best || $4 < best) { best = $4; which = settings } }
    END { theirs = grains * steps / best / 1e6
          printf "%7d grains: Thalweg %.2f, LAMMPS %.2f million grain-steps/s (%s); ratio %.2f\n", grains, ours, theirs,
                 which, ours / theirs }' "$folder/ours" "$folder/theirs"
done
