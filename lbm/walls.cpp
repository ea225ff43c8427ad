#include "lbm/walls.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::lbm {

namespace {

constexpr const char* face_names[6] = {"x_low", "x_high", "y_low", "y_high", "z_low", "z_high"};
constexpr double smallest_bounced_fraction = 1e-6;   // lets a wall without shear (a start from rest) take hold

// The two axes of a face in ascending order.
int first_axis(int normal) { return normal == 0 ? 1 : 0; }
int second_axis(int normal) { return normal == 2 ? 1 : 2; }

std::ptrdiff_t axis_stride(const CellIndexing& indexing, int axis) {
  return axis == 0 ? 1 : axis == 1 ? indexing.row_stride() : indexing.plane_stride();
}

// The box of a face field in its global dataset: ranks away from the face write nothing.
ArrayBox face_box(const Decomposition& decomposition, const Block& block, int face, bool present) {
  const int u = first_axis(face / 2), v = second_axis(face / 2);
  const auto count = [&](int a) { return static_cast<std::uint64_t>(present ? block.size()[a] : 0); };
  return {{static_cast<std::uint64_t>(decomposition.cells()[v]), static_cast<std::uint64_t>(decomposition.cells()[u])},
          {static_cast<std::uint64_t>(present ? block.lower[v] : 0), static_cast<std::uint64_t>(present ? block.lower[u] : 0)},
          {count(v), count(u)}};
}

}  // namespace

template <typename Real>
Walls<Real>::Walls(const Decomposition& decomposition, int rank, const CellIndexing& indexing,
                   const FaceConditions& faces, const CollisionParameters& parameters)
    : indexing_(indexing),
      faces_(faces),
      viscosity_((parameters.relaxation_time - 0.5) / 3.0),
      eddy_coefficient_(parameters.smagorinsky_constant * parameters.smagorinsky_constant) {
  const Block block = decomposition.block_of(rank);
  for (int axis = 0; axis < 3; ++axis)
    for (const bool high : {false, true}) {
      const int face = face_of(axis, high);
      const bool at_domain_face = high ? block.upper[axis] == decomposition.cells()[axis] : block.lower[axis] == 0;
      present_[face] = at_domain_face && faces[face].type != FaceType::periodic;
      if (present_[face] && faces[face].type == FaceType::law_of_the_wall)
        bounced_[face].resize(indexing.size()[first_axis(axis)], indexing.size()[second_axis(axis)],
                              static_cast<Real>(smallest_bounced_fraction));
    }
}

template <typename Real>
void Walls<Real>::apply(Populations<Real>& populations, const CellMap& cells) const {
  for (int face = 0; face < 6; ++face)
    if (present_[face]) apply_face(populations, cells, face);
}

template <typename Real>
void Walls<Real>::apply_face(Populations<Real>& populations, const CellMap& cells, int face) const {
  const int axis = face / 2, inward = face % 2 == 0 ? 1 : -1;
  for (int o = 1; o < D3Q19::directions; ++o)
    if (D3Q19::c[o][axis] == inward) apply_direction(populations, cells, face, o);
}

template <typename Real>
void Walls<Real>::apply_direction(Populations<Real>& populations, const CellMap& cells, int face, int o) const {
  const int axis = face / 2, u_axis = first_axis(axis), v_axis = second_axis(axis);
  const int nu = indexing_.size()[u_axis], nv = indexing_.size()[v_axis];
  const int cu = D3Q19::c[o][u_axis], cv = D3Q19::c[o][v_axis];
  const int opposite = D3Q19::opposite(o), mirror = D3Q19::mirror(o, axis);
  const std::ptrdiff_t stride = axis_stride(indexing_, u_axis);
  const std::ptrdiff_t to_source = -(cu * stride + cv * axis_stride(indexing_, v_axis));
  const FaceType type = faces_[face].type;

  for (int v = 0; v < nv; ++v) {
    Index3 at{0, 0, 0};
    at[axis] = face % 2 == 0 ? 0 : indexing_.size()[axis] - 1;
    at[v_axis] = v;
    const std::ptrdiff_t first = indexing_.index(at[0], at[1], at[2]);
    Real* into = &populations.incoming(o, first);
    const Real* own = &populations.post_collision(opposite, first);
    const Real* other = &populations.post_collision(mirror, first + to_source);
    const std::int32_t* source_body = cells.bodies() + first + to_source;

    // Cells whose population comes out of the edge with another wall bounce it back.
    const bool row_in_edge =
        (cv > 0 && v == 0 && present(v_axis, false)) || (cv < 0 && v == nv - 1 && present(v_axis, true));
    int begin = 0, end = nu;
    if (type == FaceType::no_slip || row_in_edge) begin = end = nu;
    if (cu > 0 && present(u_axis, false)) begin = std::max(begin, 1);
    if (cu < 0 && present(u_axis, true)) end = std::min(end, nu - 1);
    for (int u = 0; u < std::min(begin, nu); ++u) into[u * stride] = own[u * stride];
    if (type == FaceType::free_slip) {
      for (int u = begin; u < end; ++u)
        into[u * stride] = source_body[u * stride] == CellMap::fluid ? other[u * stride] : own[u * stride];
    } else if (begin < end) {
      const Real* r = bounced_[face].row(v);
      const Real* r_source = bounced_[face].row(v - cv) - cu;
      for (int u = begin; u < end; ++u) {
        const Real mixed = r[u] * own[u * stride] + (Real(1) - r_source[u]) * other[u * stride];
        into[u * stride] = source_body[u * stride] == CellMap::fluid ? mixed : own[u * stride];
      }
    }
    for (int u = std::max(begin, end); u < nu; ++u) into[u * stride] = own[u * stride];
  }
}

template <typename Real>
bool Walls<Real>::wants_shear(int y, int z) const {
  // The sweep with shear rates may round differently in the last bit, so which cells go through it must not depend on the
  // ranks: with such a wall across x, all rows of all ranks do.
  const auto across_x = [&](int face) { return faces_[face].type == FaceType::law_of_the_wall; };
  const auto wanted = [&](int face) { return !bounced_[face].values.empty(); };
  return across_x(0) || across_x(1) || (y == 0 && wanted(2)) || (y == indexing_.size()[1] - 1 && wanted(3)) ||
         (z == 0 && wanted(4)) || (z == indexing_.size()[2] - 1 && wanted(5));
}

template <typename Real>
void Walls<Real>::take_cell(int face, int x, int y, int z, double shear_rate, const CellMap& cells) {
  double r = smallest_bounced_fraction;
  if (cells.is_fluid(indexing_.index(x, y, z))) {
    const double friction_velocity = std::sqrt((eddy_coefficient_ * shear_rate + viscosity_) * shear_rate);
    r = std::max(r, 3.0 * friction_velocity / (3.0 * friction_velocity + faces_[face].slip_coefficient));
  }
  const int u = face / 2 == 0 ? y : x, v = face / 2 == 2 ? y : z;
  bounced_[face].at(u, v) = static_cast<Real>(r);
}

template <typename Real>
void Walls<Real>::take_shear(int y, int z, const RowShear<Real>& shear, const CellMap& cells) {
  const Index3& n = indexing_.size();
  for (int face = 0; face < 6; ++face) {
    if (bounced_[face].values.empty()) continue;
    const int axis = face / 2, wall_cell = face % 2 == 0 ? 0 : n[axis] - 1;
    if (axis == 0) take_cell(face, wall_cell, y, z, shear.normal_to[0][wall_cell], cells);
    else if ((axis == 1 ? y : z) == wall_cell)
      for (int x = 0; x < n[0]; ++x) take_cell(face, x, y, z, shear.normal_to[axis][x], cells);
  }
}

template <typename Real>
void Walls<Real>::save(ArchiveWriter& archive, const Decomposition& decomposition, const Block& block) const {
  for (int face = 0; face < 6; ++face) {
    if (faces_[face].type != FaceType::law_of_the_wall) continue;
    const ArrayBox box = face_box(decomposition, block, face, present_[face]);
    std::vector<Real> values;
    for (int v = 0; v < bounced_[face].nv; ++v)
      for (int u = 0; u < bounced_[face].nu; ++u) values.push_back(bounced_[face].at(u, v));
    archive.write(std::string("fluid/bounced_fraction_") + face_names[face], std::span<const Real>(values), box);
  }
}

template <typename Real>
void Walls<Real>::load(ArchiveReader& archive, const Decomposition& decomposition, const Block& block) {
  for (int face = 0; face < 6; ++face) {
    if (faces_[face].type != FaceType::law_of_the_wall) continue;
    const ArrayBox box = face_box(decomposition, block, face, present_[face]);
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
