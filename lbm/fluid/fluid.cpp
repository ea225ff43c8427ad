#include "lbm/fluid/fluid.hpp"

#include "core/base/check.hpp"
#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/sums/wide_sums_over_ranks.hpp"
#include "lbm/fluid/fluid_survey.hpp"
#include "lbm/fluid/mean_momentum.hpp"
#include "lbm/lattice/equilibrium.hpp"
#include "lbm/lattice/for_each_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thalweg::lbm {

namespace {

const CollisionParameters& checked(const CollisionParameters& parameters) {
  if (!(parameters.relaxation_time > 0.5))
    throw InputError(
        fmt::format("The relaxation time is {}, but a fluid needs more than 1/2; raise the viscosity or the "
                    "time step.",
                    parameters.relaxation_time));
  if (parameters.with_bulk() && !(parameters.bulk_relaxation_time > 0.5))
    throw InputError(fmt::format(
        "The bulk relaxation time is {}, but a fluid needs more than 1/2; raise it, or give 0 for that of shear.",
        parameters.bulk_relaxation_time));
  return parameters;
}

const Decomposition& checked(const Decomposition& decomposition, MPI_Comm communicator, const FaceConditions& faces) {
  if (decomposition.ranks() != size_of(communicator))
    throw InputError(fmt::format("The decomposition is one for {} ranks, and there are {}; make one for them.",
                                 decomposition.ranks(), size_of(communicator)));
  for (int face = 0; face < 6; ++face) {
    const bool periodic = faces[static_cast<std::size_t>(face)].type == FaceType::periodic;
    if (periodic != decomposition.periodic()[static_cast<std::size_t>(face / 2)])
      throw InputError(fmt::format("Face {} is {}periodic, and its axis in the decomposition is {}; make them agree.",
                                   face, periodic ? "" : "not ", periodic ? "not" : "periodic"));
  }
  return decomposition;
}

// Walls around this block's cells.
WallPositions wall_positions(const Decomposition& decomposition, const Block& block, const FaceConditions& faces) {
  WallPositions walls;
  for (int axis = 0; axis < 3; ++axis) {
    const auto is_wall = [&](bool high) {
      const FaceType type = faces[static_cast<std::size_t>(face_of(axis, high))].type;
      return type != FaceType::periodic && !is_open(type);
    };
    if (is_wall(false)) walls.lower[axis] = -block.lower[axis];
    if (is_wall(true)) walls.upper[axis] = decomposition.cells()[axis] - block.lower[axis];
  }
  return walls;
}

}  // namespace

template <typename Real>
Fluid<Real>::Fluid(const Decomposition& decomposition, MPI_Comm communicator, const CollisionParameters& parameters,
                   const FaceConditions& faces)
    : decomposition_(checked(decomposition, communicator, faces)),
      communicator_(communicator),
      parameters_(checked(parameters)),
      block_(decomposition.block_of(rank_of(communicator))),
      populations_(CellIndexing(block_.size(), pack_width<Real>())),
      cells_(populations_.indexing(), wall_positions(decomposition, block_, faces)),
      tiles_(block_.size(), D3Q19::directions * sizeof(Real) * populations_.indexing().row_stride()),
      walls_(decomposition, rank_of(communicator), populations_.indexing(), faces, parameters),
      halo_(decomposition, communicator, populations_, walls_) {
  const int row_size = populations_.indexing().packs_per_row() * populations_.indexing().pack();
  for (auto& row : shear_rows_) row.resize(row_size);
  for (auto& row : moment_rows_) row.resize(row_size);
  carry_force();
}

template <typename Real>
void Fluid<Real>::initialise(const std::function<FluidState(const Vec3&)>& state) {
  const Vec3& force = carried_force_;
  populations_.set_arrangement(Arrangement::swapped);
  walls_.forget_sweep();
  for_each_cell(indexing(), [&](std::ptrdiff_t cell, const Index3& at) {
    const FluidState s =
        state(Vec3(block_.lower[0] + at[0] + 0.5, block_.lower[1] + at[1] + 0.5, block_.lower[2] + at[2] + 0.5));
    for (int i = 0; i < D3Q19::directions; ++i) {
      const double along = D3Q19::c[i][0] * force.x() + D3Q19::c[i][1] * force.y() + D3Q19::c[i][2] * force.z();
      populations_.post_collision(i, cell) =
          static_cast<Real>(equilibrium_deviation(i, s.density_deviation, s.velocity) + 1.5 * D3Q19::weight(i) * along);
    }
  });
}

template <typename Real>
void Fluid<Real>::exchange_halo() {
  halo_.start();
  halo_.finish();
}

template <typename Real>
void Fluid<Real>::set_force(const Vec3& force) {
  parameters_.force = force;
}

template <typename Real>
void Fluid<Real>::carry_force() {
  carried_force_ = parameters_.force;
  walls_.set_carried_force(carried_force_);
}

template <typename Real>
void Fluid<Real>::apply_walls() {
  CHECK(!halo_.under_way());  // walls read the halo
  walls_.apply(populations_, cells_, communicator_);
}

template <typename Real>
void Fluid<Real>::control_flow(const FlowTarget& target) {
  CHECK(target.axis >= 0 && target.axis < 3);
  control_.emplace(target);
  parameters_.force[target.axis] = control_->force();
  carry_force();
}

template <typename Real>
void Fluid<Real>::begin_control_of(const ArchiveReader& archive, double unit) {
  if (!control_) return;
  const std::optional<FlowControl::Force> force = FlowControl::saved_force(archive, control_->target().axis);
  if (!force) return;
  control_->begin_with({unit * force->whole, unit * force->held});
  parameters_.force[control_->target().axis] = control_->force();
  carry_force();
}

// The populations are post-collision and contain the whole force of that collision.
template <typename Real>
void Fluid<Real>::update_force() {
  const int axis = control_->target().axis;
  if (control_->due()) control_->update(mean_momentum(*this, axis) - 0.5 * carried_force_[axis]);
  parameters_.force[axis] = control_->force();
}

template <typename Real>
std::array<Vec3, 6> Fluid<Real>::wall_forces(double reference, std::vector<FixedVec3>* sides_by_height) {
  exchange_halo();
  apply_walls();
  const std::array<FixedVec3, 6> mine = walls_.forces(populations_, cells_, reference, sides_by_height);
  const std::vector<Vec3> sums = vectors_over_ranks(communicator_, mine);
  std::array<Vec3, 6> forces;
  std::copy(sums.begin(), sums.end(), forces.begin());
  return forces;
}

// Ends the step once all rows are swept: the populations are in the other arrangement and carry the force of this
// collision.
template <typename Real>
void Fluid<Real>::end_step() {
  populations_.set_arrangement(populations_.arrangement() == Arrangement::swapped ? Arrangement::moved
                                                                                  : Arrangement::swapped);
  walls_.end_sweep();
  carry_force();
  if (walls_.has_outlet()) walls_.update_outlets(populations_, cells_, communicator_);
}

// A row takes the same variant of the sweep on every rank: the one that stores shear rates may round differently.
template <typename Real>
void Fluid<Real>::sweep(int y, int z) {
  const RowShear<Real> shear{{shear_rows_[0].data(), shear_rows_[1].data(), shear_rows_[2].data()}};
  const RowMoments<Real> moments{moment_rows_[0].data(),
                                 {moment_rows_[1].data(), moment_rows_[2].data(), moment_rows_[3].data()}};
  RowOutput<Real> output;
  if (walls_.wants_shear(y, z)) output.shear = &shear;
  if (walls_.wants_moments(y, z)) output.moments = &moments;
  sweep_row<Real>(populations_, cells_, parameters_, y, z, output);
  if (output.shear) walls_.update_bounced(y, z, shear, cells_);
  if (output.moments) walls_.take_moments(y, z, moments, cells_, 0.5 * parameters_.force);
}

template <typename Real>
void Fluid<Real>::stream_and_collide() {
  CHECK(!halo_.under_way());
  if (control_) update_force();
  const Index3& n = indexing().size();
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y) sweep(y, z);
  end_step();
}

// The sweep follows one plane and one row behind.
template <typename Real>
void Fluid<Real>::stream_and_collide(const std::function<void(int)>& before_tile) {
  CHECK(!halo_.under_way());
  if (control_) update_force();
  const int planes = tiles_.planes();
  for (int block = 0; block < tiles_.blocks(); ++block) {
    const bool last = block + 1 == tiles_.blocks();
    const int first_row = block == 0 ? 0 : tiles_.first_row(block) - 1;
    const int end_row = tiles_.end_row(block) - (last ? 0 : 1);
    for (int z = -1; z < planes; ++z) {
      if (z + 1 < planes) before_tile(block * planes + z + 1);
      for (int y = first_row; z >= 0 && y < end_row; ++y) sweep(y, z);
    }
  }
  end_step();
}

// A sweep of a cell touches the 19 slots of the cell and no other. Those of cells further from the block's faces than
// the margin are neither filled by the halo or a wall, nor read by a wall, which looks at all that the cells next to it
// send out.
// Along x a block that is its own neighbour has copied its halo when start() returns, so that whole rows can be swept.
template <typename Real>
void Fluid<Real>::advance_behind_halo() {
  const int margin = walls_.depth() + 1;
  const Index3& n = indexing().size();
  const auto inside = [&](int y, int z) {
    return z >= margin && z < n[2] - margin && y >= margin && y < n[1] - margin;
  };
  if (control_) update_force();
  halo_.start();
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      if (inside(y, z)) sweep(y, z);
  halo_.finish();
  apply_walls();
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      if (!inside(y, z)) sweep(y, z);
  end_step();
}

// The halo does not overlap with the sweep if rows end at another rank or at a wall: sweeping the ends of all rows
// separately costs more (measured: a fifth of the step) than the wait.
template <typename Real>
void Fluid<Real>::advance() {
  const bool whole_rows = decomposition_.layout()[0] == 1 && decomposition_.periodic()[0];
  if (halo_.has_other_ranks() && whole_rows && !walls_.recycles()) return advance_behind_halo();
  exchange_halo();
  apply_walls();
  stream_and_collide();
}

template <typename Real>
FluidState Fluid<Real>::state_at(std::ptrdiff_t cell) const {
  FluidState s;
  Vec3 momentum = Vec3::Zero();
  for (int i = 0; i < D3Q19::directions; ++i) {
    const double f = populations_.post_collision(i, cell);
    s.density_deviation += f;
    for (int a = 0; a < 3; ++a) momentum[a] += D3Q19::c[i][a] * f;
  }
  // A collision adds the whole force to the momentum; the velocity is the one half-way.
  for (int a = 0; a < 3; ++a) s.velocity[a] = (momentum[a] - 0.5 * carried_force_[a]) / (1.0 + s.density_deviation);
  return s;
}

template <typename Real>
FluidTotals Fluid<Real>::totals() const {
  return survey_of(*this).totals;
}

template <typename Real>
ArrayBox Fluid<Real>::array_box() const {
  ArrayBox box;
  for (int a = 2; a >= 0; --a) {
    box.global_shape.push_back(decomposition_.cells()[a]);
    box.offset.push_back(block_.lower[a]);
    box.shape.push_back(block_.size()[a]);
  }
  return box;
}

template <typename Real>
void Fluid<Real>::save(ArchiveWriter& archive) const {
  CHECK(!halo_.under_way());
  const Index3& n = indexing().size();
  std::vector<Real> values(static_cast<std::size_t>(n[0]) * n[1] * n[2]);
  for (int i = 0; i < D3Q19::directions; ++i) {
    std::fill(values.begin(), values.end(), Real(0));
    for_each_fluid_cell(cells_, [&](std::ptrdiff_t cell, const Index3& at) {
      values[index_in_block(indexing(), at)] = populations_.post_collision(i, cell);
    });
    archive.write(fmt::format("fluid/populations_{:02d}", i), std::span<const Real>(values), array_box());
  }
  walls_.save(archive, decomposition_, block_);
  if (control_) return control_->save(archive);
  for (int a = 0; a < 3; ++a) archive.attribute(FlowControl::name_of_force(a), carried_force_[a]);
}

template <typename Real>
void Fluid<Real>::load_populations(ArchiveReader& archive) {
  CHECK(!halo_.under_way());
  const Index3& n = indexing().size();
  const std::vector<std::uint64_t> saved = archive.shape("fluid/populations_00"), here = array_box().global_shape;
  if (saved != here)
    throw InputError(
        fmt::format("the state has {} x {} x {} cells, but here are {} x {} x {}; use the same domain.size "
                    "and domain.spacing.",
                    saved.at(2), saved.at(1), saved.at(0), here[2], here[1], here[0]));
  populations_.set_arrangement(Arrangement::swapped);
  walls_.forget_sweep();
  std::vector<Real> values(static_cast<std::size_t>(n[0]) * n[1] * n[2]);
  for (int i = 0; i < D3Q19::directions; ++i) {
    archive.read(fmt::format("fluid/populations_{:02d}", i), std::span<Real>(values), array_box());
    for_each_cell(indexing(), [&](std::ptrdiff_t cell, const Index3& at) {
      populations_.post_collision(i, cell) = values[index_in_block(indexing(), at)];
    });
  }
}

template <typename Real>
void Fluid<Real>::load(ArchiveReader& archive) {
  load_populations(archive);
  walls_.load(archive, decomposition_, block_);
  if (control_ && archive.has(FlowControl::name_of_force(control_->target().axis))) {  // none has controlled it so far
    begin_control_of(archive, 1.0);
  } else if (control_) {
    control_->load(archive);
    parameters_.force[control_->target().axis] = control_->force();
  }
  carry_force();
}

template class Fluid<float>;
template class Fluid<double>;

}  // namespace thalweg::lbm
