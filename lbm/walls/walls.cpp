#include "lbm/walls/walls.hpp"

#include "core/base/error.hpp"
#include "lbm/lattice/face_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace thalweg::lbm {

namespace {

constexpr const char* face_names[6] = {"x_low", "x_high", "y_low", "y_high", "z_low", "z_high"};
constexpr double smallest_bounced_fraction = 1e-6;  // lets a wall without shear (a start from rest) take hold

void check(const FaceCondition& wall, int axis, const char* name) {
  if (wall.type == FaceType::moving && wall.velocity[axis] != 0.0)
    throw InputError(
        fmt::format("The moving wall at {} has a velocity of {} cells per step across its own plane; give it zero "
                    "there, or make the face a velocity inlet.",
                    name, wall.velocity[axis]));
  if (wall.type == FaceType::navier_slip && !(wall.slip_length >= 0.0))
    throw InputError(
        fmt::format("The slip length at {} is {} cells; it must not be negative.", name, wall.slip_length));
  if (wall.type == FaceType::slip_law_of_the_wall && !(wall.slip_coefficient > 0.0))
    throw InputError(
        fmt::format("The slip coefficient at {} is {}; it must be positive.", name, wall.slip_coefficient));
}

// The law looks at cells of the rank at the wall alone.
void check_depth(const Decomposition& decomposition, int face, const char* name) {
  constexpr int layers = WallStress<float>::layers;
  const int axis = face / 2;
  Index3 at{0, 0, 0};
  if (face % 2 == 1) at[axis] = decomposition.layout()[axis] - 1;
  const int cells = decomposition.block_of(decomposition.rank_at(at)).size()[axis];
  if (cells < layers && cells < decomposition.cells()[axis])
    throw InputError(fmt::format(
        "The law of the wall at {} takes the velocity of cell {} from the wall, but a rank there has only {} "
        "cells across it; use fewer ranks along {} (--layout).",
        name, layers, cells, name[0]));
}

// The box of a face field in its global dataset: ranks away from the face write nothing.
ArrayBox face_box(const Decomposition& decomposition, const Block& block, int face, bool present) {
  const int u = first_axis(face / 2), v = second_axis(face / 2);
  const auto count = [&](int a) { return static_cast<std::uint64_t>(present ? block.size()[a] : 0); };
  return {{static_cast<std::uint64_t>(decomposition.cells()[v]), static_cast<std::uint64_t>(decomposition.cells()[u])},
          {static_cast<std::uint64_t>(present ? block.lower[v] : 0),
           static_cast<std::uint64_t>(present ? block.lower[u] : 0)},
          {count(v), count(u)}};
}

// The arrays of WallStress::state().
std::string state_name(int face, int n) {
  constexpr std::array names{"stress_u", "stress_v", "stress_before_u", "stress_before_v"};
  return fmt::format("fluid/wall_{}_{}", names.at(n), face_names[face]);
}

std::string outlet_name(int face) { return fmt::format("fluid/outlet_{}", face_names[face]); }

}  // namespace

template <typename Real>
Walls<Real>::Walls(const Decomposition& decomposition, int rank, const CellIndexing& indexing,
                   const FaceConditions& faces, const CollisionParameters& parameters)
    : indexing_(indexing),
      faces_(faces),
      viscosity_((parameters.relaxation_time - 0.5) / 3.0),
      subgrid_(parameters.subgrid) {
  const Block block = decomposition.block_of(rank);
  for (int axis = 0; axis < 3; ++axis)
    for (const bool high : {false, true}) {
      const int face = face_of(axis, high);
      check(faces[face], axis, face_names[face]);
      const bool at_domain_face = high ? block.upper[axis] == decomposition.cells()[axis] : block.lower[axis] == 0;
      present_[face] = at_domain_face && faces[face].type != FaceType::periodic;
      if (present_[face] && traits_of(faces[face].type).slips())
        bounced_[face].resize(indexing.size()[first_axis(axis)], indexing.size()[second_axis(axis)],
                              static_cast<Real>(bounced_fraction(face, 0.0)));
    }
  for (int face = 0; face < 6; ++face) {
    if (faces[face].type == FaceType::pressure_outlet)
      outlets_[face].emplace(faces[face].density_deviation, decomposition.cells()[face / 2]);
    if (faces[face].type == FaceType::velocity_inlet && faces[face].recycling_plane)
      recycled_[face].emplace(decomposition, rank, indexing, face, *faces[face].recycling_plane,
                              (face % 2 == 0 ? 1.0 : -1.0) * faces[face].velocity[face / 2]);
    if (has_stress(face)) {
      check_depth(decomposition, face, face_names[face]);
      if (present_[face]) stress_[face].emplace(indexing, face, present_, decomposition.cells()[face / 2], viscosity_);
    }
  }
}

template <typename Real>
bool Walls<Real>::follows_shear(int face) const {
  return faces_[face].type == FaceType::slip_law_of_the_wall ||
         (faces_[face].type == FaceType::navier_slip && subgrid_.viscosity_in_shear(1.0) > 0.0);
}

template <typename Real>
double Walls<Real>::bounced_fraction(int face, double shear_rate) const {
  const FaceCondition& wall = faces_[face];
  const double viscosity = viscosity_ + subgrid_.viscosity_in_shear(shear_rate);
  const double scale = 3.0 * viscosity;  // tau - 1/2
  if (wall.type == FaceType::navier_slip) return scale / (scale + wall.slip_length);
  // Slip length A nu/u_tau, multiplied through by u_tau, which is zero in fluid at rest.
  const double friction_velocity = std::sqrt(viscosity * shear_rate);
  const double coefficient =
      wall.slip_of_first_cell ? slip_coefficient_at(0.5 * friction_velocity / viscosity_) : wall.slip_coefficient;
  return std::max(smallest_bounced_fraction,
                  scale * friction_velocity / (scale * friction_velocity + coefficient * viscosity));
}

template <typename Real>
int Walls<Real>::depth() const {
  const bool law = std::any_of(stress_.begin(), stress_.end(), [](const auto& face) { return face.has_value(); });
  return law ? WallStress<Real>::layers : 1;
}

template <typename Real>
bool Walls<Real>::wants_shear(int y, int z) const {
  // The sweep with shear rates may round differently in the last bit, so which cells go through it must not depend on
  // the ranks: with such a wall across x, all rows of all ranks do.
  const auto wanted = [&](int face) { return present_[face] && follows_shear(face); };
  return follows_shear(0) || follows_shear(1) || (y == 0 && wanted(2)) || (y == indexing_.size()[1] - 1 && wanted(3)) ||
         (z == 0 && wanted(4)) || (z == indexing_.size()[2] - 1 && wanted(5));
}

template <typename Real>
void Walls<Real>::update_bounced_cell(int face, int x, int y, int z, double shear_rate, const CellMap& cells) {
  const int u = face / 2 == 0 ? y : x, v = face / 2 == 2 ? y : z;
  const bool fluid = cells.is_fluid(indexing_.index(x, y, z));
  bounced_[face].at(u, v) = static_cast<Real>(bounced_fraction(face, fluid ? shear_rate : 0.0));
}

template <typename Real>
void Walls<Real>::update_bounced(int y, int z, const RowShear<Real>& shear, const CellMap& cells) {
  const Index3& n = indexing_.size();
  for (int face = 0; face < 6; ++face) {
    if (!present_[face] || !follows_shear(face)) continue;
    const int axis = face / 2, wall_cell = face % 2 == 0 ? 0 : n[axis] - 1;
    if (axis == 0)
      update_bounced_cell(face, wall_cell, y, z, shear.normal_to[0][wall_cell], cells);
    else if ((axis == 1 ? y : z) == wall_cell)
      for (int x = 0; x < n[0]; ++x) update_bounced_cell(face, x, y, z, shear.normal_to[axis][x], cells);
  }
}

template <typename Real>
bool Walls<Real>::wants_moments(int y, int z) const {
  return std::any_of(stress_.begin(), stress_.end(), [=](const auto& face) { return face && face->wants(y, z); });
}

template <typename Real>
void Walls<Real>::take_moments(int y, int z, const RowMoments<Real>& moments, const CellMap& cells,
                               const Vec3& half_force) {
  for (auto& stress : stress_)
    if (stress && stress->wants(y, z)) stress->take_row(y, z, moments, cells, half_force);
}

template <typename Real>
void Walls<Real>::end_sweep() {
  for (auto& stress : stress_)
    if (stress) stress->end_sweep();
  swept_ = true;
}

template <typename Real>
bool Walls<Real>::recycles() const {
  return std::any_of(recycled_.begin(), recycled_.end(), [](const auto& face) { return face.has_value(); });
}

template <typename Real>
bool Walls<Real>::has_outlet() const {
  return std::any_of(outlets_.begin(), outlets_.end(), [](const auto& face) { return face.has_value(); });
}

// Sums of integers, so that the mean does not depend on the ranks.
template <typename Real>
void Walls<Real>::update_outlets(const Populations<Real>& populations, const CellMap& cells, MPI_Comm communicator) {
  std::array<std::int64_t, 12> sums{};  // of each face: of the momentum out of the box, and the number of cells
  for (int face = 0; face < 6; ++face) {
    if (!outlets_[face] || !present_[face]) continue;
    const int axis = face / 2, u_axis = first_axis(axis), v_axis = second_axis(axis);
    const double outward = face % 2 == 0 ? -1.0 : 1.0;
    Index3 at{0, 0, 0};
    at[axis] = face % 2 == 0 ? 0 : indexing_.size()[axis] - 1;
    for (at[v_axis] = 0; at[v_axis] < indexing_.size()[v_axis]; ++at[v_axis])
      for (at[u_axis] = 0; at[u_axis] < indexing_.size()[u_axis]; ++at[u_axis]) {
        const std::ptrdiff_t cell = indexing_.index(at[0], at[1], at[2]);
        if (!cells.is_fluid(cell)) continue;
        double momentum = -half_force_[axis];
        for (int i = 1; i < D3Q19::directions; ++i)
          if (D3Q19::c[i][axis] != 0)
            momentum += D3Q19::c[i][axis] * static_cast<double>(populations.post_collision(i, cell));
        sums[2 * face] = exact_sum(sums[2 * face], LatticeFixed::from(outward * momentum));
        ++sums[2 * face + 1];
      }
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_INT64_T, MPI_SUM, communicator);
  for (int face = 0; face < 6; ++face)
    if (outlets_[face] && sums[2 * face + 1] > 0)
      outlets_[face]->update(LatticeFixed::to_double(sums[2 * face]) / static_cast<double>(sums[2 * face + 1]));
}

// Ranks away from a face take part with nothing.
template <typename Real>
void Walls<Real>::save(ArchiveWriter& archive, const Decomposition& decomposition, const Block& block) const {
  for (int face = 0; face < 6; ++face) {
    if (outlets_[face]) outlets_[face]->save(archive, outlet_name(face));
    const ArrayBox box = face_box(decomposition, block, face, present_[face]);
    for (int n = 0; n < WallStress<Real>::arrays && has_stress(face) && swept_; ++n)
      archive.write(state_name(face, n),
                    stress_[face] ? std::as_const(*stress_[face]).state(n) : std::span<const Real>(), box);
    if (!traits_of(faces_[face].type).slips()) continue;
    std::vector<Real> values;
    for (int v = 0; v < bounced_[face].nv; ++v)
      for (int u = 0; u < bounced_[face].nu; ++u) values.push_back(bounced_[face].at(u, v));
    archive.write(std::string("fluid/bounced_fraction_") + face_names[face], std::span<const Real>(values), box);
  }
}

// A state that no sweep has left has no stress. Fractions that do not follow the shear are those of this run's slip
// length and viscosity, whatever the state's were.
template <typename Real>
void Walls<Real>::load(ArchiveReader& archive, const Decomposition& decomposition, const Block& block) {
  for (int face = 0; face < 6; ++face) {
    if (outlets_[face]) outlets_[face]->load(archive, outlet_name(face));
    const ArrayBox box = face_box(decomposition, block, face, present_[face]);
    for (int n = 0; n < WallStress<Real>::arrays && has_stress(face) && archive.has(state_name(face, n)); ++n) {
      archive.read(state_name(face, n), stress_[face] ? stress_[face]->state(n) : std::span<Real>(), box);
      swept_ = true;
    }
    if (!follows_shear(face)) continue;
    std::vector<Real> values(box.shape[0] * box.shape[1]);
    archive.read(std::string("fluid/bounced_fraction_") + face_names[face], std::span<Real>(values), box);
    std::size_t next = 0;
    for (int v = 0; v < bounced_[face].nv; ++v)
      for (int u = 0; u < bounced_[face].nu; ++u) bounced_[face].at(u, v) = values[next++];
  }
}

template class Walls<float>;
template class Walls<double>;

}  // namespace thalweg::lbm
