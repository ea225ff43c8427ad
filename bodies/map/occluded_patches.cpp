#include "bodies/map/occluded_patches.hpp"

#include "core/base/check.hpp"

#include <algorithm>

namespace thalweg::bodies {

using lbm::CellMap;
using lbm::D3Q19;

namespace {

// The reverse of wall_of_face().
int face_of_wall(std::int32_t wall) { return OccludedPatches::wall_of_face(0) - wall; }

}  // namespace

OccludedPatches::OccludedPatches(const Decomposition& decomposition, const Block& block, const CellMap& cells)
    : box_(decomposition.cell_box()), cells_(cells) {
  for (int a = 0; a < 3; ++a) {
    wall_below_[a] = !decomposition.periodic()[a] && block.lower[a] == 0;
    wall_above_[a] = !decomposition.periodic()[a] && block.upper[a] == decomposition.cells()[a];
  }
}

void OccludedPatches::cell_changes(const Index3& local, std::int32_t now) {
  const lbm::CellIndexing& indexing = cells_.indexing();
  const std::ptrdiff_t cell = indexing.index(local[0], local[1], local[2]);
  const Index3& n = indexing.size();
  const std::int32_t before = cells_.body(cell);
  const bool owned = indexing.owned(local[0], local[1], local[2]);
  for (int i = 1; i < D3Q19::directions; ++i) {
    bool in_memory = true, other_owned = true;
    std::int32_t wall = CellMap::fluid;
    for (int a = 0; a < 3; ++a) {
      const int at = local[a] + D3Q19::c[i][a];
      in_memory = in_memory && at >= -1 && at <= n[a];
      other_owned = other_owned && at >= 0 && at < n[a];
      if (at < 0 && wall_below_[a]) wall = wall_of_face(2 * a);
      if (at >= n[a] && wall_above_[a]) wall = wall_of_face(2 * a + 1);
    }
    if (!in_memory) continue;
    const std::int32_t other = wall != CellMap::fluid ? wall : cells_.body(cell + indexing.offset(i));
    if (other == CellMap::fluid) continue;
    for (const std::int32_t holder : {before, now}) {
      if (holder == CellMap::fluid || holder == other) continue;
      const int lines = holder == now ? 1 : -1;
      if (owned) count({holder, other}, D3Q19::opposite(i), lines);
      if (other_owned && other >= 0) count({other, holder}, i, lines);
    }
  }
}

void OccludedPatches::count(const Pair& pair, int direction, int lines) {
  const auto [found, is_new] = place_of_.try_emplace(key(pair), patches_.size());
  const std::size_t place = found->second;
  if (is_new) patches_.push_back({pair, {}});
  Patch& patch = patches_[place].patch;
  const int weight = lines * (3 - D3Q19::length_squared(direction));
  for (std::size_t a = 0; a < 3; ++a) patch.sum[a] += weight * D3Q19::c[direction][a];
  patch.lines += lines;
  if (patch.lines == 0) erase(place);
}

void OccludedPatches::erase(std::size_t place) {
  place_of_.erase(key(patches_[place].pair));
  if (place + 1 < patches_.size()) {
    patches_[place] = patches_.back();
    place_of_[key(patches_[place].pair)] = place;
  }
  patches_.pop_back();
}

Vec3 OccludedPatches::patch(std::int32_t p, std::int32_t q) const {
  const auto found = place_of_.find(key({p, q}));
  if (found == place_of_.end()) return Vec3::Zero();
  return to_vec3(patches_[found->second].patch);
}

std::vector<std::array<std::int64_t, 3>> OccludedPatches::by_solids(std::size_t slots, int solids) const {
  std::vector<std::array<std::int64_t, 3>> sums(slots, std::array<std::int64_t, 3>{});
  for (const auto& [pair, patch] : patches_) {
    if (pair.p < solids || pair.q < 0 || pair.q >= solids) continue;
    for (std::size_t a = 0; a < 3; ++a) sums[static_cast<std::size_t>(pair.p)][a] += patch.sum[a];
  }
  return sums;
}

Vec3 OccludedPatches::to_vec3(const Patch& patch) { return Vec3(patch.sum[0], patch.sum[1], patch.sum[2]) / 36.0; }

// Out of p, towards q.
Vec3 OccludedPatches::direction(const Pair& pair, const std::vector<LinkBody>& bodies) const {
  if (pair.q >= 0)
    return box_.difference(bodies[static_cast<std::size_t>(pair.q)].centre,
                           bodies[static_cast<std::size_t>(pair.p)].centre);
  const int face = face_of_wall(pair.q);
  Vec3 outward = Vec3::Zero();
  outward[face / 2] = face % 2 == 0 ? -1.0 : 1.0;
  return outward;
}

// Rounds before it multiplies by the patch, so that the parts of a patch on several ranks add up to the whole.
FixedVec3 OccludedPatches::force(const Patch& patch, double excess) {
  const std::int64_t line = LatticeFixed::from(2.0 * excess / 36.0);
  return {exact_product(line, patch.sum[0]), exact_product(line, patch.sum[1]), exact_product(line, patch.sum[2])};
}

// Rounds as force() does.
void OccludedPatches::press(const Patch& patch, const Vec3& arm, double excess, LinkBody& body, FixedTensor* moment) {
  body.force += force(patch, excess);
  if (!moment) return;
  const double line = 2.0 * excess / 36.0;
  std::array<std::int64_t, 3> half;
  for (int b = 0; b < 3; ++b) half[b] = LatticeFixed::from(0.5 * line * arm[b]);
  for (std::size_t k = 0; k < 9; ++k)
    moment->add(static_cast<int>(k),
                exact_sum(exact_product(half[k % 3], patch.sum[k / 3]), exact_product(half[k / 3], patch.sum[k % 3])));
}

// Adds the opposite force to a solid, along a line through the centre of the sphere.
void OccludedPatches::press_solid(const Patch& patch, double excess, const LinkBody& sphere, LinkBody& solid) const {
  press(patch, Vec3::Zero(), excess, solid, nullptr);
  if (!solid.turns) return;
  const Vec3 arm = (2.0 * excess / 36.0) * box_.difference(sphere.centre, solid.centre);
  const auto product = [&](int a, int b) {
    return exact_product(LatticeFixed::from(arm[a]), patch.sum[static_cast<std::size_t>(b)]);
  };
  solid.torque += {exact_sum(product(1, 2), -product(2, 1)), exact_sum(product(2, 0), -product(0, 2)),
                   exact_sum(product(0, 1), -product(1, 0))};
}

Vec3 OccludedPatches::velocity_beside(const LinkBody& solid, const LinkBody& sphere) const {
  return solid.velocity + solid.angular_velocity.cross(box_.difference(sphere.centre, solid.centre));
}

void OccludedPatches::give_mass(const Patch& patch, const Vec3& velocity, LinkBody& body) {
  for (int a = 0; a < 3; ++a)
    body.mass = exact_sum(body.mass, -exact_product(LatticeFixed::from(6.0 / 36.0 * velocity[a]), patch.sum[a]));
}

void OccludedPatches::apply(const std::vector<MappedBody>& mapped, int solids, const std::vector<double>& surrounding,
                            double reference, std::vector<LinkBody>& bodies, std::vector<FixedTensor>* moments) const {
  CHECK(mapped.size() == bodies.size() && surrounding.size() == bodies.size());
  CHECK(!moments || moments->size() == bodies.size());
  for (const auto& [pair, patch] : patches_) {
    const auto p = static_cast<std::size_t>(pair.p), q = static_cast<std::size_t>(pair.q);
    const bool q_is_sphere = pair.q >= solids;
    if (pair.p < solids) {  // the opposite of what the other one feels
      if (!q_is_sphere) continue;
      press_solid(patch, surrounding[q] - reference, bodies[q], bodies[p]);
      give_mass(patch, velocity_beside(bodies[p], bodies[q]), bodies[p]);
      continue;
    }
    if (q_is_sphere && mapped[p].clump >= 0 && mapped[q].clump == mapped[p].clump) continue;
    double density = surrounding[p];
    if (q_is_sphere) {
      density += (surrounding[q] - density) * bodies[p].radius / (bodies[p].radius + bodies[q].radius);
      give_mass(patch, 0.5 * (bodies[p].velocity + bodies[q].velocity), bodies[p]);
    } else if (pair.q >= 0) {
      give_mass(patch, velocity_beside(bodies[q], bodies[p]), bodies[p]);
    }
    const bool is_solid = pair.q >= 0 && !q_is_sphere;
    const Vec3 outward = is_solid ? Vec3::Zero() : direction(pair, bodies);
    const Vec3 arm = outward * (bodies[p].radius / std::max(outward.norm(), 1e-30));
    press(patch, arm, density - reference, bodies[p], moments && !is_solid ? &(*moments)[p] : nullptr);
  }
}

std::array<FixedVec3, 6> OccludedPatches::wall_forces(int solids, const std::vector<double>& surrounding,
                                                      double reference) const {
  std::array<FixedVec3, 6> forces{};
  for (const auto& [pair, patch] : patches_) {
    if (pair.p < solids || pair.q >= 0) continue;
    const FixedVec3 of_grain = force(patch, surrounding[static_cast<std::size_t>(pair.p)] - reference);
    forces[static_cast<std::size_t>(face_of_wall(pair.q))] += {-of_grain.x, -of_grain.y, -of_grain.z};
  }
  return forces;
}

}  // namespace thalweg::bodies
