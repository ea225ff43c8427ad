#!/bin/sh
# The flume's five wall stresses: run.sh PROGRAM FOLDER (forty minutes on one core). Friction velocities in m/s; with
# cells of 0.5 mm and steps of 5e-5 s they are a tenth of that in cells per step; half the width is 5.25 mm, the viscosity 1e-6 m^2/s.
program=$1
mkdir -p "$2" && cd "$2" || exit 1
run() {  # name, friction velocity, C_s or qr, further options
  name=$1 friction=$2
  if [ "$3" = qr ]; then subgrid=--qr; else subgrid="--smagorinsky $3"; fi
  shift 3
  "$program" --height 21 --length 64 --width 32 --samples 10 --until 100 --average-from 40 \
    --friction-velocity "$(echo "$friction/10" | bc -l)" --reynolds "$(echo "$friction*5250" | bc -l)" \
    $subgrid --output "$name.csv" "$@"
}
imposed="--wall law_of_the_wall" slip="--wall slip_law_of_the_wall --slip-coefficient"
first_cell="--wall slip_law_of_the_wall --slip-of-first-cell"
# tau*, friction velocity, A of the tangent at the first cell's centre: ln(dx+/2)/0.41 + 5 - 1/0.41
for case in 0.023:0.0434:8.38 0.028:0.0479:8.61 0.047:0.0620:9.25 0.063:0.0718:9.61 0.068:0.0746:9.70; do
  stress=${case%%:*} rest=${case#*:}
  run "tau_${stress}" "${rest%:*}" 0.27 $imposed
  run "tau_${stress}_A_8.36" "${rest%:*}" 0.27 $slip 8.36
  run "tau_${stress}_A_${rest#*:}" "${rest%:*}" 0.27 $slip "${rest#*:}"
  run "tau_${stress}_first_cell" "${rest%:*}" 0.27 $first_cell
done
# What the slip depends on, at 0.047.
run printed_A_2.35 0.0620 0.27 $slip 2.35
run Cs_0.17 0.0620 0.17 $slip 8.36
run Cs_0.22 0.0620 0.22 $slip 8.36
run Cs_0.33 0.0620 0.33 $slip 8.36
run trt 0.0620 0.27 $slip 8.36 --collision trt
run larger_box 0.0620 0.27 $slip 8.36 --length 128 --width 64 --until 80
run shorter_step 0.0620 0.27 $slip 8.36 --friction-velocity 0.00248 --until 80

# The workstation's flume at 0.028: 13 cells of 0.8077 mm, 1e-4 s.
coarse="--height 13 --length 40 --width 20 --until 160 --average-from 60 --friction-velocity 0.00593 --reynolds 251"
run six 0.0479 0.27 $coarse $imposed
run six_qr 0.0479 qr $coarse $imposed
run six_trt 0.0479 0.27 $coarse $imposed --collision trt
run six_first_cell 0.0479 0.27 $coarse $first_cell
run six_trt_first_cell 0.0479 0.27 $coarse $first_cell --collision trt
run six_trt_A_7.4 0.0479 0.27 $coarse $slip 7.4 --collision trt
run six_A_10.05 0.0479 0.27 $coarse $slip 10.05
