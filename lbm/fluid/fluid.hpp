// The lattice fluid of one rank: populations, walls, halo and sweep, in the order a step calls them. Lattice units
// throughout; densities as deviations rho - 1.
//
// A step without bodies is advance(), which sweeps the rows inside while the halo is on its way. With bodies, the
// coupling calls the parts and lets the links of each tile of rows go first:
//   exchange_halo(), apply_walls(), stream_and_collide(links of a tile).
#pragma once

#include "core/base/archive.hpp"
#include "core/parallel/decomposition.hpp"
#include "core/sums/fixed_point.hpp"
#include "lbm/collision/collision.hpp"
#include "lbm/fluid/flow_control.hpp"
#include "lbm/fluid/halo.hpp"
#include "lbm/lattice/cell_map.hpp"
#include "lbm/lattice/populations.hpp"
#include "lbm/lattice/row_tiles.hpp"
#include "lbm/walls/boundary.hpp"
#include "lbm/walls/walls.hpp"

#include <functional>
#include <optional>

namespace thalweg::lbm {

struct FluidState {
  double density_deviation = 0.0;
  Vec3 velocity = Vec3::Zero();
};

// Sums over all fluid cells of the domain, however many: exact but for 2^-37 of rounding a cell, in any order.
struct FluidTotals {
  double mass_deviation = 0.0;   // sum of rho - 1
  Vec3 momentum = Vec3::Zero();  // sum of rho u after the collision: sum over c_i f_i^c
  std::int64_t cells = 0;
};

template <typename Real>
class Fluid {
public:
  // The decomposition must outlive the fluid. Throws InputError if a relaxation time is not above 1/2, if the
  // decomposition is not one for as many ranks as the communicator has, or if the faces of an axis are not as periodic
  // as it is.
  Fluid(const Decomposition& decomposition, MPI_Comm communicator, const CollisionParameters& parameters,
        const FaceConditions& faces);

  // Sets every cell to the equilibrium of the given state, with half of carried_force(), as a collision leaves it; the
  // argument is the cell's centre in global lattice units.
  void initialise(const std::function<FluidState(const Vec3&)>& state);

  // The force density of the collisions to come, the same everywhere. A caller who changes it in time must set it again
  // after load(), and then carry_force().
  void set_force(const Vec3& force);
  // The force density of the last collision: the populations carry half of it beyond rho u, whatever is set for the
  // next one. Walls and readers of velocities from post-collision populations account for it.
  const Vec3& carried_force() const { return carried_force_; }
  // Declares the present force that of the last collision, for a state that was set up or loaded.
  void carry_force();
  // Hands the force along one axis to a controller, which begins with none; its state is part of the checkpoint.
  void control_flow(const FlowTarget& target);
  // Lets the controller, if there is one, begin with the force of a saved flow, controlled or given. unit: of an
  // acceleration of the saved lattice, dx/dt^2, over that of this one.
  void begin_control_of(const ArchiveReader& archive, double unit);

  // exchange_halo() in two halves, so that the caller can work meanwhile; no population may be written in between.
  void start_halo_exchange() { halo_.start(); }
  void finish_halo_exchange() { halo_.finish(); }
  void exchange_halo();
  void apply_walls();
  // Sweep all rows. before_tile: called with every tile of tiles() in order, before any row is swept that touches the
  // tile's rows or a neighbour of them.
  void stream_and_collide();
  void stream_and_collide(const std::function<void(int)>& before_tile);
  void advance();  // a whole step without bodies; collective

  const Decomposition& decomposition() const { return decomposition_; }
  MPI_Comm communicator() const { return communicator_; }
  const Block& block() const { return block_; }
  const CellIndexing& indexing() const { return populations_.indexing(); }
  const RowTiles& tiles() const { return tiles_; }
  const CollisionParameters& parameters() const { return parameters_; }
  Populations<Real>& populations() { return populations_; }
  const Populations<Real>& populations() const { return populations_; }
  CellMap& cells() { return cells_; }
  const CellMap& cells() const { return cells_; }

  FluidState state_at(std::ptrdiff_t cell) const;  // density and velocity (with the half force) of a cell
  FluidTotals totals() const;                      // those of survey_of(*this) (fluid_survey.hpp); collective

  // Force on each face (lattice units) in the step to come, without that of a fluid at rest with rho = 1 + reference.
  // Fills halo and walls, which every step does anew. sides_by_height: of this rank, as in Walls::forces. Collective.
  std::array<Vec3, 6> wall_forces(double reference = 0.0, std::vector<FixedVec3>* sides_by_height = nullptr);

  // Post-collision populations of every owned cell, zero in solid ones, and the walls' state. Collective.
  void save(ArchiveWriter& archive) const;
  void load(ArchiveReader& archive);  // reads populations, as load_populations(), and the walls' state
  // The populations alone, of a fluid in the same box with whatever walls and force. Throws InputError where the box or
  // the precision differs.
  void load_populations(ArchiveReader& archive);

private:
  ArrayBox array_box() const;
  void sweep(int y, int z);  // a row, and the shear rates and moments its walls want
  void end_step();
  void advance_behind_halo();
  void update_force();

  const Decomposition& decomposition_;
  MPI_Comm communicator_;
  CollisionParameters parameters_;
  Block block_;
  Populations<Real> populations_;
  CellMap cells_;
  RowTiles tiles_;
  Walls<Real> walls_;
  Halo<Real> halo_;
  std::optional<FlowControl> control_;
  Vec3 carried_force_ = Vec3::Zero();
  std::array<std::vector<Real>, 3> shear_rows_;
  std::array<std::vector<Real>, 4> moment_rows_;
};

}  // namespace thalweg::lbm
