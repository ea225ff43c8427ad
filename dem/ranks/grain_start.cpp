#include "dem/ranks/grain_start.hpp"

#include <algorithm>

namespace thalweg::dem {

namespace {

struct IdOrder {
  bool operator()(const Clump& clump, GlobalId id) const { return clump.id < id; }
  bool operator()(GlobalId id, const Clump& clump) const { return id < clump.id; }
};

}  // namespace

double largest_radius_of(const std::vector<GrainSeed>& seeds, const std::vector<ClumpSeed>& clumps) {
  double largest = 0.0;
  for (const GrainSeed& seed : seeds) largest = std::max(largest, seed.radius);
  for (const ClumpSeed& clump : clumps)
    for (const PlacedSphere& member : clump.shape->members) largest = std::max(largest, member.radius);
  return largest;
}

double largest_offset_of(const std::vector<ClumpSeed>& clumps) {
  double largest = 0.0;
  for (const ClumpSeed& clump : clumps)
    for (const PlacedSphere& member : clump.shape->members) largest = std::max(largest, member.position.norm());
  return largest;
}

GrainRow row_of(const GrainSeed& seed, const PeriodicBox& box) {
  const Vec3 x = box.wrapped(seed.position), &v = seed.velocity, &w = seed.angular_velocity, &r = seed.offset;
  GrainRow row{seed.id,       static_cast<std::int64_t>(seed.motion),
               seed.material, seed.radius,
               seed.mass(),   {},
               seed.clump,    {r[0], r[1], r[2]}};
  row.value[GrainRow::position] = {x[0], x[1], x[2]};
  row.value[GrainRow::velocity] = {v[0], v[1], v[2]};
  row.value[GrainRow::angular_velocity] = {w[0], w[1], w[2]};
  return row;
}

GrainBatch batch_of(const std::vector<GrainSeed>& seeds, const std::vector<Clump>& clumps,
                    const Decomposition& decomposition, int rank, int width) {
  const PeriodicBox box = decomposition.box();
  const auto mine = [&](const GrainSeed& seed, const Vec3& x) {
    if (seed.clump < 0) return decomposition.owner_of(x) == rank;
    return std::binary_search(clumps.begin(), clumps.end(), seed.clump, IdOrder());
  };
  GrainBatch batch;
  for (const GrainSeed& seed : seeds)
    if (mine(seed, box.wrapped(seed.position))) batch.rows.push_back(row_of(seed, box));
  std::sort(batch.rows.begin(), batch.rows.end(), [](const GrainRow& a, const GrainRow& b) { return a.id < b.id; });
  batch.attached.assign(batch.rows.size() * width, 0.0);
  return batch;
}

std::vector<Clump> clumps_of(const std::vector<ClumpSeed>& seeds, const Decomposition& decomposition, int rank) {
  std::vector<Clump> clumps;
  for (const ClumpSeed& seed : seeds) {
    const Clump clump = clump_of(seed, decomposition.box());
    if (decomposition.owner_of(clump.centre) == rank) clumps.push_back(clump);
  }
  std::sort(clumps.begin(), clumps.end(), [](const Clump& a, const Clump& b) { return a.id < b.id; });
  return clumps;
}

}  // namespace thalweg::dem
