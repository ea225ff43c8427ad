#!/bin/sh
# The flume's five wall stresses: run.sh PROGRAM FOLDER (half an hour on one core). Friction velocities in m/s; with
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
imposed="--wall law_of_the_wall --bulk-relaxation-time 1" slip="--wall slip_law_of_the_wall --slip-coefficient"
first_cell="--wall slip_law_of_the_wall --slip-of-first-cell"
# The workstation's flume: 13 cells of 0.8077 mm, 1e-4 s.
coarse="--height 13 --length 40 --width 20 --until 160 --average-from 60"
# tau*, friction velocity, A of the tangent at the first cell's centre: ln(dx+/2)/0.41 + 5 - 1/0.41
for case in 0.023:0.0434:8.38 0.028:0.0479:8.61 0.047:0.0620:9.25 0.063:0.0718:9.61 0.068:0.0746:9.70; do
  stress=${case%%:*} rest=${case#*:}
  friction=${rest%:*} a=${rest#*:}
  on_coarse="$coarse --friction-velocity $(echo "$friction*0.1238" | bc -l)"
  run "tau_${stress}_qr" "$friction" qr $imposed
  run "six_${stress}_qr" "$friction" qr $imposed $on_coarse
  run "tau_${stress}_A_8.36" "$friction" 0.27 $slip 8.36
  run "tau_${stress}_A_$a" "$friction" 0.27 $slip "$a"
  run "tau_${stress}_first_cell" "$friction" 0.27 $first_cell
done
# What the middle depends on, with the walls that impose the stress, at 0.028 and 13 cells.
coarse="$coarse --friction-velocity 0.00593"
run six_half_step 0.0479 qr $imposed $coarse --friction-velocity 0.002965 --until 120 --average-from 40
run six_larger_box 0.0479 qr $imposed $coarse --length 80 --width 40 --until 90 --average-from 40
run fine 0.0479 qr $imposed $coarse --height 27 --length 84 --width 42 --until 70 --average-from 30
run six_trt 0.0479 0.27 $imposed $coarse --collision trt
# What the slip depends on, at 0.047.
run printed_A_2.35 0.0620 0.27 $slip 2.35
run Cs_0.17 0.0620 0.17 $slip 8.36
run Cs_0.22 0.0620 0.22 $slip 8.36
run Cs_0.33 0.0620 0.33 $slip 8.36
run trt 0.0620 0.27 $slip 8.36 --collision trt
run larger_box 0.0620 0.27 $slip 8.36 --length 128 --width 64 --until 80
run shorter_step 0.0620 0.27 $slip 8.36 --friction-velocity 0.00248 --until 80

# The slip at 0.028 and 13 cells.
run six_first_cell 0.0479 0.27 $coarse $first_cell
run six_trt_first_cell 0.0479 0.27 $coarse $first_cell --collision trt
run six_trt_A_7.4 0.0479 0.27 $coarse $slip 7.4 --collision trt
run six_A_10.05 0.0479 0.27 $coarse $slip 10.05
