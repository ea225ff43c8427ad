// Context of an observer: properties of the case that it may use besides the snapshots, in SI units.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/periodic_box.hpp"
#include "core/parallel/decomposition.hpp"
#include "core/state/population_ids.hpp"

#include <mpi.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::analysis {

struct FluidContext {
  double density = 0.0;              // kg/m^3
  double kinematic_viscosity = 0.0;  // m^2/s
  double velocity_unit = 0.0;        // m/s of one cell a step
  bool steered = false;              // its mean velocity is prescribed, so that no slope drives it
  int side_walls = 0;                // number of walls across y that hold the flow back: 0 to 2
  bool top_drags = false;            // the face z_high exchanges shear with the flow
  bool top_moves = false;            // the top moves along x
  bool has_solids = false;           // solids take momentum from it
  bool side_walls_move = false;      // one of them along x, so that no hydraulic radius says what it takes
};

// Context of a run with a model fluid (model_fluid/model_fluid.hpp).
struct ModelFluidContext {
  double speed = 0.0;    // m/s, v_0, of the first Shields number
  double gravity = 0.0;  // m/s^2, reduced
};

// Grains of a case that belong together, with the ids first ... end - 1.
struct PopulationContext {
  std::string name;  // the name in its columns
  GlobalId first = 0, end = 0;
  std::function<Vec3(double time)> pivot;  // m, of its torque at a time (s)
  bool held = false;                       // moves as prescribed, or not at all
  bool clumps = false;
  std::int64_t members = 1;  // of each of its clumps; 1 where they are not all alike, too
};

struct HeldGrains {
  GlobalId first = 0, end = 0;  // ids from `first` to one before `end`
};
bool is_held(const std::vector<HeldGrains>& held, GlobalId id);

// What stands in a bed and is none of its grains: a sill, a pier, a boulder.
struct BedObstacles {
  std::vector<GlobalId> spheres = {};  // ids, ascending
  // m^3, of solids that stand still, at layers + 1 heights from the floor of the box to its top; empty: there are none.
  std::function<std::vector<double>(int layers)> solids_below = {};
  // kg/m^3: free grains no denser float, and are no grains of the bed either; 0: none do.
  double floating_density = 0.0;
};

struct GrainContext {
  std::vector<PopulationContext> populations;
  double reference_diameter = 0.0;  // m, d of q* and the Shields number
  double reference_density = 0.0;   // kg/m^3
  double smallest_diameter = 0.0;   // m, of spheres and members of clumps
  double largest_diameter = 0.0;    // m
  double disk_thickness = 0.0;      // m; 0: spheres
  // Where size classes are asked for: m, of free grains, or of all if none is free, a clump with the diameter of the
  // sphere (disk) of its volume; and the edges of classes that suit them, rising.
  double smallest_free = 0.0, largest_free = 0.0;
  std::vector<double> size_class_edges = {};
  BedObstacles obstacles = {};
  std::vector<std::int64_t> supplied = {};  // of the grains that come in later, as PopulationIds has it

  using Force = std::function<Vec3(double mass, double radius)>;  // N, on a sphere (kg, m)
  Force body_force = {};                                          // in a fluid only, as the next two
  Force submerged_weight = {};
  Force buoyancy = {};         // the part of it that the fluid's load contains
  bool recirculation = false;  // a sink puts grains in again elsewhere, at once or later

  GlobalId count() const { return populations.empty() ? 0 : populations.back().end; }  // number of ids
  std::vector<HeldGrains> held() const;
  bool any_free() const;
  bool any_clumps() const;
  GlobalId first_member(
      GlobalId id) const;  // of the clump of an id, as far as the populations tell; else the id itself
};

struct RunContext {
  PeriodicBox box;
  double until = 0.0;           // s, the end of the run
  bool has_rows = true;         // of the series, after the start, with which observers measure whose `every` is 0
  double ramp = 0.0;            // s in which gravity rises
  Vec3 gravity = Vec3::Zero();  // m/s^2
  std::optional<FluidContext> fluid;
  std::optional<ModelFluidContext> model_fluid;
  std::optional<GrainContext> grains;
};

// The system an observer is made for.
struct RunningSystem {
  MPI_Comm communicator;
  const Decomposition& decomposition;
  double time_step;  // s
};

}  // namespace thalweg::analysis
