#include "coupling/hidden_patches.hpp"

#include "coupling/grain_map.hpp"
#include "coupling/lattice_vectors.hpp"

namespace thalweg::coupling {

using lbm::CellMap;
using lbm::D3Q19;

HiddenPatches::HiddenPatches(const Decomposition& decomposition, const Block& block, const CellMap& cells)
    : box_{Vec3(decomposition.cells()[0], decomposition.cells()[1], decomposition.cells()[2]),
           decomposition.periodic()},
      cells_(cells) {
  for (int a = 0; a < 3; ++a) {
    wall_below_[a] = !decomposition.periodic()[a] && block.lower[a] == 0;
    wall_above_[a] = !decomposition.periodic()[a] && block.upper[a] == decomposition.cells()[a];
  }
}

void HiddenPatches::cell_changes(const Index3& local, std::int32_t now) {
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
      if (owned) count(holder, other, D3Q19::opposite(i), lines);
      if (other_owned && other >= 0) count(other, holder, i, lines);
    }
  }
}

void HiddenPatches::count(std::int32_t p, std::int32_t q, int direction, int lines) {
  Patch& patch = patches_[key(p, q)];
  const int weight = lines * (3 - D3Q19::length_squared(direction));
  for (std::size_t a = 0; a < 3; ++a) patch.sum[a] += weight * D3Q19::c[direction][a];
  patch.lines += lines;
  if (patch.lines == 0) patches_.erase(key(p, q));
}

Vec3 HiddenPatches::patch(std::int32_t p, std::int32_t q) const {
  const auto found = patches_.find(key(p, q));
  if (found == patches_.end()) return Vec3::Zero();
  const std::array<std::int32_t, 3>& sum = found->second.sum;
  return Vec3(sum[0], sum[1], sum[2]) / 36.0;
}

void HiddenPatches::apply(const std::vector<MappedGrain>& grains, const std::vector<double>& surrounding,
                          double reference, std::vector<lbm::LinkBody>& bodies,
                          std::vector<FixedTensor>* moments) const {
  for (const auto& [pair, patch] : patches_) {
    const auto p = static_cast<std::size_t>(pair >> 32);
    const auto q = static_cast<std::int32_t>(static_cast<std::uint32_t>(pair));
    const GlobalId clump = grains[p].clump;
    if (q >= 0 && clump >= 0 && grains[static_cast<std::size_t>(q)].clump == clump) continue;
    lbm::LinkBody& body = bodies[p];
    double density = surrounding[p];
    Vec3 outward = Vec3::Zero();
    if (q < 0) {
      const int face = wall_of_face(0) - q;
      outward[face / 2] = face % 2 == 0 ? -1.0 : 1.0;
    } else {
      const lbm::LinkBody& other = bodies[static_cast<std::size_t>(q)];
      density += (surrounding[static_cast<std::size_t>(q)] - density) * body.radius / (body.radius + other.radius);
      outward = box_.difference(other.centre, body.centre);
    }
    // Rounded before it is multiplied by the patch, so that the parts of a patch on several ranks add up to the whole.
    const double line = 2.0 * (density - reference) / 36.0;
    const std::int64_t force = LatticeFixed::from(line);
    if (q >= 0) {
      const Vec3 velocity = 0.5 * (body.velocity + bodies[static_cast<std::size_t>(q)].velocity);
      for (int a = 0; a < 3; ++a) body.mass -= LatticeFixed::from(6.0 / 36.0 * velocity[a]) * patch.sum[a];
    }
    body.force += FixedVec3{force * patch.sum[0], force * patch.sum[1], force * patch.sum[2]};
    if (!moments) continue;
    // A pressure has no torque about the centre of a sphere: the symmetric part alone.
    const Vec3 arm = outward * (body.radius / outward.norm());
    std::array<std::int64_t, 3> half;
    for (int b = 0; b < 3; ++b) half[b] = LatticeFixed::from(0.5 * line * arm[b]);
    for (std::size_t k = 0; k < 9; ++k)
      (*moments)[p].sums[k] += half[k % 3] * patch.sum[k / 3] + half[k / 3] * patch.sum[k % 3];
  }
}

}  // namespace thalweg::coupling
