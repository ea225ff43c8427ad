#include "bodies/links/occluded_links.hpp"

#include "core/base/check.hpp"

#include <algorithm>

namespace thalweg::bodies {

using lbm::CellMap;
using lbm::D3Q19;

OccludedLinks::OccludedLinks(const Decomposition& decomposition, const Block& block, const CellMap& cells,
                             const Hydrostatic& rest)
    : decomposition_(decomposition),
      block_(block),
      local_cells_(decomposition, block),
      cells_(cells),
      rest_(rest),
      box_(decomposition.cell_box()) {}

std::size_t OccludedLinks::count() const {
  std::size_t total = 0;
  for (const std::vector<Link>& links : links_) total += links.size();
  return total;
}

void OccludedLinks::update(const BodyMap& map) {
  if (rest_.none()) return;
  links_.resize(map.bodies().size());
  is_stale_.resize(map.bodies().size(), 0);
  for (const CellChange& change : map.changes()) {
    mark(change.before);
    mark(change.now);
    mark_around(change.cell);
  }
  std::sort(stale_.begin(), stale_.end());
  for (const int slot : stale_) {
    rebuild(slot, map.bodies());
    is_stale_[static_cast<std::size_t>(slot)] = 0;
  }
  stale_.clear();
}

void OccludedLinks::mark(std::int32_t slot) {
  if (slot == CellMap::fluid || is_stale_[static_cast<std::size_t>(slot)]) return;
  is_stale_[static_cast<std::size_t>(slot)] = 1;
  stale_.push_back(slot);
}

void OccludedLinks::mark_around(const Index3& local) {
  for (int i = 1; i < D3Q19::directions; ++i) {
    const Index3 at{local[0] + D3Q19::c[i][0], local[1] + D3Q19::c[i][1], local[2] + D3Q19::c[i][2]};
    if (cells_.indexing().in_memory(at)) mark(cells_.body(cells_.indexing().index(at[0], at[1], at[2])));
  }
}

void OccludedLinks::rebuild(int slot, const std::vector<MappedBody>& grains) {
  const MappedBody& grain = grains[static_cast<std::size_t>(slot)];
  links_[static_cast<std::size_t>(slot)].clear();
  if (grain.id < 0) return;
  for (int a = 0; a < 3; ++a) local_cells_.along(a, grain.centre[a], grain.radius, grain.centre[a], 0, cells_along_[a]);
  for (const LocalCell& z : cells_along_[2])
    for (const LocalCell& y : cells_along_[1])
      for (const LocalCell& x : cells_along_[0]) {
        const Index3 local{x.local, y.local, z.local};
        if (cells_.body(cells_.indexing().index(local[0], local[1], local[2])) == slot)
          find_at_cell(slot, local, grains);
      }
}

void OccludedLinks::find_at_cell(int slot, const Index3& local, const std::vector<MappedBody>& grains) {
  const GlobalId clump = grains[static_cast<std::size_t>(slot)].clump;
  const std::ptrdiff_t cell = cells_.indexing().index(local[0], local[1], local[2]);
  for (int i = 1; i < D3Q19::directions; ++i) {
    bool beyond_wall = false;
    Vec3 from;
    for (int a = 0; a < 3; ++a) {
      const int global = block_.lower[a] + local[a] - D3Q19::c[i][a];
      from[a] = global + 0.5;
      beyond_wall =
          beyond_wall || (!decomposition_.periodic()[a] && (global < 0 || global >= decomposition_.cells()[a]));
    }
    const std::int32_t other = beyond_wall ? CellMap::fluid : cells_.body(cell - cells_.indexing().offset(i));
    const bool same_body = clump >= 0 && other >= 0 && grains[static_cast<std::size_t>(other)].clump == clump;
    if (other != slot && !same_body && (other != CellMap::fluid || beyond_wall))
      links_[static_cast<std::size_t>(slot)].push_back({i, from, other});
  }
}

// If grains overlap, x_f can be inside this one too. A line may just miss the surface because the cells belong to a
// slightly different position; its crossing is then the point nearest to the centre.
OccludedLinks::Momentum OccludedLinks::momentum_of(const Link& link, const LinkBody& body) const {
  const Vec3 c = velocity_of(link.direction), from = box_.difference(link.from, body.centre);
  const Sphere sphere{body.radius};
  double met = 0.0;
  if (!sphere.holds(from)) met = sphere.crossing(from, c).value_or(-c.dot(from) / c.squaredNorm());
  const Vec3 along = std::clamp(met, 0.0, 1.0) * c;
  return {2.0 * D3Q19::weight(link.direction) * rest_.deviation(link.from + along) * c, from + along};
}

void OccludedLinks::apply(int solids, std::vector<LinkBody>& bodies, std::vector<FixedTensor>* moments) const {
  CHECK(links_.size() <= bodies.size() && (!moments || moments->size() == bodies.size()));
  for (std::size_t slot = 0; slot < links_.size(); ++slot)
    for (const Link& link : links_[slot]) {
      const Momentum momentum = momentum_of(link, bodies[slot]);
      bodies[slot].force += FixedVec3::from(momentum.value);
      bodies[slot].torque += FixedVec3::from(momentum.arm.cross(momentum.value));
      if (moments) (*moments)[slot].add(momentum.value, momentum.arm);
      if (link.body == CellMap::fluid || link.body >= solids) continue;
      LinkBody& solid = bodies[static_cast<std::size_t>(link.body)];
      solid.force += FixedVec3::from(-momentum.value);
      if (solid.turns)
        solid.torque +=
            FixedVec3::from(-box_.difference(bodies[slot].centre + momentum.arm, solid.centre).cross(momentum.value));
    }
}

int OccludedLinks::face_before(const Link& link) const {
  int face = -1;
  for (int a = 0; a < 3; ++a) {
    if (decomposition_.periodic()[a]) continue;
    if (link.from[a] < 0.0) face = 2 * a;
    if (link.from[a] > decomposition_.cells()[a]) face = 2 * a + 1;
  }
  return face;
}

std::array<FixedVec3, 6> OccludedLinks::wall_forces(const std::vector<LinkBody>& bodies) const {
  std::array<FixedVec3, 6> forces{};
  for (std::size_t slot = 0; slot < links_.size(); ++slot)
    for (const Link& link : links_[slot])
      if (const int face = face_before(link); face >= 0)
        forces[static_cast<std::size_t>(face)] += FixedVec3::from(-momentum_of(link, bodies[slot]).value);
  return forces;
}

}  // namespace thalweg::bodies
