// Cases of several tests, and how they read one.
#pragma once

#include "driver/input/case_reader.hpp"
#include "tests/io/scratch_folder.hpp"

#include <string>
#include <vector>

namespace thalweg::testing {

inline const std::string flume = R"(system: resolved
name: "small flume"
domain:
  size: [0.060, 0.0105, 0.075]
  spacing: 0.5e-3
  boundaries: {x: periodic, y: {type: slip_law_of_the_wall, coefficient: 2.35}, bottom: no_slip, top: free_slip}
fluid:
  density: 1000
  kinematic_viscosity: 1.0e-6
  smagorinsky_constant: 0.27
  time_step: 2.0e-5
gravity: {magnitude: 9.8, slope: 0.07}
grains:
  - count: 150
    diameter: 4.95e-3
    density: 2550
    placement: {pattern: random, seed: 7, region: {lower: [0, 0, 0], upper: [0.06, 0.0105, 0.05]}}
  - {diameter: 4.0e-3, density: 2550, placement: {positions: [[0.01, 0.005, 0.06], [0.02, 0.005, 0.06]]}, fixed: true}
contact:
  restitution: 0.93
run: {until: 3.0}
output:
  series: {every: 0.02}
  fluid: {every: 0.1, region: slice_y, fields: [velocity]}
  checkpoint: {every: 1.0, keep: 3}
analysis:
  transport_rate: {from: 1.0}
)";

// 40 x 20 x 20 cells of clear water between side walls.
inline const std::string channel = R"(system: fluid
domain:
  size: [0.04, 0.02, 0.02]
  spacing: 1.0e-3
  boundaries: {x: periodic, y: no_slip, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-6}
gravity: {magnitude: 9.81, slope: 0.001}
run: {until: 100}
)";

inline driver::Case read_text(const std::string& yaml, const std::vector<std::string>& overrides = {}) {
  const ScratchFolder folder;
  if (rank_of(MPI_COMM_WORLD) == 0) put(folder / "case.yaml", yaml);
  MPI_Barrier(MPI_COMM_WORLD);  // else a rank may read what another is writing
  return driver::read_case(folder / "case.yaml", overrides);
}

}  // namespace thalweg::testing
