// Walls::apply: the rules of walls.hpp, direction by direction, row by row.
#include "lbm/lattice/equilibrium.hpp"
#include "lbm/lattice/face_axes.hpp"
#include "lbm/walls/walls.hpp"

#include <algorithm>

namespace thalweg::lbm {

namespace {

double dot(int direction, const Vec3& v) {
  return D3Q19::c[direction][0] * v.x() + D3Q19::c[direction][1] * v.y() + D3Q19::c[direction][2] * v.z();
}

}  // namespace

template <typename Real>
void Walls<Real>::apply(Populations<Real>& populations, const CellMap& cells, MPI_Comm communicator) {
  for (int face = 0; face < 6; ++face)
    if (present_[face] && !recycled_[face]) apply_face(populations, cells, face);
  for (auto& inflow : recycled_)
    if (inflow) inflow->apply(populations, cells, communicator);
}

template <typename Real>
void Walls<Real>::apply_face(Populations<Real>& populations, const CellMap& cells, int face) {
  const int axis = face / 2, inward = face % 2 == 0 ? 1 : -1;
  if (stress_[face]) {
    stress_[face]->find_layers(cells);
    if (!swept_) stress_[face]->take_populations(populations, cells, half_force_);
    stress_[face]->find(cells);
  }
  for (int o = 1; o < D3Q19::directions; ++o)
    if (D3Q19::c[o][axis] == inward) {
      const IncomingDirection incoming(indexing_, face, o);
      for (int v = 0; v < incoming.nv; ++v) apply_row(populations, cells, incoming, v);
    }
}

template <typename Real>
Walls<Real>::IncomingDirection::IncomingDirection(const CellIndexing& indexing, int from_face, int along)
    : face(from_face), direction(along), axis(from_face / 2) {
  u_axis = first_axis(axis);
  v_axis = second_axis(axis);
  nu = indexing.size()[u_axis];
  nv = indexing.size()[v_axis];
  cu = D3Q19::c[direction][u_axis];
  cv = D3Q19::c[direction][v_axis];
  stride = indexing.stride(u_axis);
  tangential = cu * stride + cv * indexing.stride(v_axis);
}

template <typename Real>
bool Walls<Real>::decides_edge(int face, int other) const {
  return traits_of(faces_[face].type).precedence >= traits_of(faces_[other].type).precedence;
}

template <typename Real>
Real Walls<Real>::with_velocity(const Populations<Real>& populations, int o, std::ptrdiff_t cell,
                                const Vec3& velocity) const {
  const double rho = 1.0 + populations.density_deviation(cell);
  return static_cast<Real>(populations.post_collision(D3Q19::opposite(o), cell) +
                           6.0 * D3Q19::weight(o) * rho * dot(o, velocity));
}

template <typename Real>
Real Walls<Real>::at_outlet(const Populations<Real>& populations, const IncomingDirection& incoming,
                            std::ptrdiff_t cell) const {
  Vec3 momentum = -half_force_;  // a collision leaves the whole force in it; the velocity takes half
  double density = 1.0;
  for (int i = 0; i < D3Q19::directions; ++i) {
    const double f = populations.post_collision(i, cell);
    density += f;
    for (int a = 0; a < 3; ++a) momentum[a] += D3Q19::c[i][a] * f;
  }
  const OutletDensity& outlet = *outlets_[incoming.face];
  Vec3 velocity = momentum / density;
  const double inwards = incoming.face % 2 == 0 ? 1.0 : -1.0;
  double lost = 0.0;  // of the density: that of rho w^2/2
  if (inwards * velocity[incoming.axis] > 0.0) {
    const double speed = outlet.entering_speed();
    velocity = Vec3::Zero();
    velocity[incoming.axis] = inwards * speed;
    lost = 1.5 * speed * speed;
  }
  return static_cast<Real>(equilibrium_deviation(incoming.direction, outlet.deviation() - lost, velocity));
}

// Applies a reflection in loops over plain arrays.
template <typename Real>
void Walls<Real>::reflect_row(Populations<Real>& populations, const CellMap& cells, const RowPart& part,
                              Reflection reflection) const {
  const int axis = part.face / 2, o = part.direction;
  const int cu = D3Q19::c[o][first_axis(axis)], cv = D3Q19::c[o][second_axis(axis)];
  const std::ptrdiff_t stride = part.stride, source = part.first - part.tangential;
  Real* into = &populations.incoming(o, part.first);
  const Real* own = &populations.post_collision(D3Q19::opposite(o), part.first);
  const Real* other = &populations.post_collision(D3Q19::mirror(o, axis), source);
  const std::int32_t* body = cells.bodies() + source;
  switch (reflection) {
    case Reflection::bounce_back:
      for (int u = part.begin; u < part.end; ++u) into[u * stride] = own[u * stride];
      break;
    case Reflection::specular:
      for (int u = part.begin; u < part.end; ++u)
        into[u * stride] = body[u * stride] == CellMap::fluid ? other[u * stride] : own[u * stride];
      break;
    case Reflection::specular_less_shear: {
      if (cu == 0 && cv == 0) {
        for (int u = part.begin; u < part.end; ++u) into[u * stride] = own[u * stride];
        break;
      }
      const Real* stress = stress_[part.face]->row(cu != 0 ? 0 : 1, part.v);
      const Real half = Real(0.5) * static_cast<Real>(cu + cv);  // one of the two is 0
      for (int u = part.begin; u < part.end; ++u)
        into[u * stride] = body[u * stride] == CellMap::fluid ? other[u * stride] - half * stress[u] : own[u * stride];
      break;
    }
    case Reflection::mixed: {
      const Real* r = bounced_[part.face].row(part.v);
      const Real* r_source = bounced_[part.face].row(part.v - cv) - cu;
      for (int u = part.begin; u < part.end; ++u) {
        const Real mixed = r[u] * own[u * stride] + (Real(1) - r_source[u]) * other[u * stride];
        into[u * stride] = body[u * stride] == CellMap::fluid ? mixed : own[u * stride];
      }
      break;
    }
  }
}

// The other face of the edge that this population comes out of, or -1.
template <typename Real>
int Walls<Real>::edge_face(const IncomingDirection& e, int u, int v) const {
  if (e.cu > 0 && u == 0 && present(e.u_axis, false)) return face_of(e.u_axis, false);
  if (e.cu < 0 && u == e.nu - 1 && present(e.u_axis, true)) return face_of(e.u_axis, true);
  if (e.cv > 0 && v == 0 && present(e.v_axis, false)) return face_of(e.v_axis, false);
  if (e.cv < 0 && v == e.nv - 1 && present(e.v_axis, true)) return face_of(e.v_axis, true);
  return -1;
}

// Incoming population of a cell at the edge with another face.
template <typename Real>
Real Walls<Real>::from_edge(const Populations<Real>& populations, const IncomingDirection& incoming,
                            std::ptrdiff_t cell, int other) const {
  if (faces_[incoming.face].type == FaceType::pressure_outlet) {
    const Real own = at_outlet(populations, incoming, cell);
    if (faces_[other].type != FaceType::pressure_outlet) return own;
    return Real(0.5) * (own + at_outlet(populations, {indexing_, other, incoming.direction}, cell));
  }
  Vec3 velocity = Vec3::Zero();
  for (const int face : {std::min(incoming.face, other), std::max(incoming.face, other)})
    if (traits_of(faces_[face].type).has_velocity) velocity += faces_[face].velocity;
  return with_velocity(populations, incoming.direction, cell, velocity);
}

// Incoming population of a cell away from edges, at a face that does not reflect.
template <typename Real>
Real Walls<Real>::from_wall(const Populations<Real>& populations, const IncomingDirection& incoming,
                            std::ptrdiff_t cell) const {
  const FaceCondition& wall = faces_[incoming.face];
  return traits_of(wall.type).has_velocity ? with_velocity(populations, incoming.direction, cell, wall.velocity)
                                           : at_outlet(populations, incoming, cell);
}

// A row is one reflection, except where it meets other faces: at its ends, or along its whole length.
template <typename Real>
void Walls<Real>::apply_row(Populations<Real>& populations, const CellMap& cells, const IncomingDirection& e,
                            int v) const {
  Index3 at{0, 0, 0};
  at[e.axis] = e.face % 2 == 0 ? 0 : indexing_.size()[e.axis] - 1;
  at[e.v_axis] = v;
  const std::ptrdiff_t first = indexing_.index(at[0], at[1], at[2]);
  const bool row_in_edge =
      (e.cv > 0 && v == 0 && present(e.v_axis, false)) || (e.cv < 0 && v == e.nv - 1 && present(e.v_axis, true));
  const int begin = row_in_edge ? e.nu : e.cu > 0 && present(e.u_axis, false) ? 1 : 0;
  const int end = row_in_edge ? e.nu : e.cu < 0 && present(e.u_axis, true) ? e.nu - 1 : e.nu;
  const auto edges = [&](int from, int to) {
    for (int u = from; u < to; ++u) {
      const std::ptrdiff_t cell = first + u * e.stride;
      const int other = edge_face(e, u, v);
      if (decides_edge(e.face, other)) populations.incoming(e.direction, cell) = from_edge(populations, e, cell, other);
    }
  };
  edges(0, begin);
  edges(end, e.nu);
  if (const std::optional<Reflection> reflection = traits_of(faces_[e.face].type).reflection) {
    reflect_row(populations, cells, {e.face, e.direction, v, begin, end, first, e.stride, e.tangential}, *reflection);
    return;
  }
  for (int u = begin; u < end; ++u) {
    const std::ptrdiff_t cell = first + u * e.stride;
    populations.incoming(e.direction, cell) = from_wall(populations, e, cell);
  }
}

template class Walls<float>;
template class Walls<double>;

}  // namespace thalweg::lbm
