#include "dem/clumps/assemblies.hpp"

#include "core/base/error.hpp"
#include "core/state/whole_dataset.hpp"
#include "dem/motion/cell_grid.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace thalweg::dem {

Assemblies::Assemblies(const std::vector<PrescribedMotion>& motions, std::span<const GrainSeed> seeds)
    : motions_(motions) {
  for (const PrescribedMotion& motion : motions_) check(motion);
  for (const GrainSeed& seed : seeds) {
    if (seed.assembly < 0) continue;
    if (seed.assembly >= static_cast<int>(motions_.size()))
      throw InputError(
          fmt::format("Grain {} is of assembly {}, but there are {}.", seed.id, seed.assembly, motions_.size()));
    if (seed.motion != Motion::fixed)
      throw InputError(fmt::format("Grain {} is of an assembly but not fixed; fix it.", seed.id));
    members_.push_back({seed.id, seed.assembly, seed.position});
  }
  std::sort(members_.begin(), members_.end(), [](const Member& a, const Member& b) { return a.id < b.id; });
  find_largest_speed();
}

void Assemblies::find_largest_speed() {
  largest_speed_ = 0.0;
  for (const Member& member : members_) {
    const PrescribedMotion& motion = motions_[static_cast<std::size_t>(member.assembly)];
    const double distance = motion.axis.cross(member.at_start - motion.centre).norm();
    largest_speed_ = std::max(largest_speed_, motion.largest_speed(distance));
  }
}

void Assemblies::find(const GrainStore& store) {
  owned_.clear();
  auto member = members_.begin();
  for (std::size_t s = 0; s < store.owned && member != members_.end(); ++s) {  // both sorted by id
    while (member != members_.end() && member->id < store.id[s]) ++member;
    if (member != members_.end() && member->id == store.id[s])
      owned_.push_back({static_cast<std::uint32_t>(s), static_cast<std::size_t>(member - members_.begin())});
  }
}

void Assemblies::place(PackedGrainState& grains, const PeriodicBox& box, double time, double time_of_velocity) const {
  for (const OwnedMember& owned : owned_) {
    const Member& member = members_[owned.member];
    const PrescribedMotion& motion = motions_[static_cast<std::size_t>(member.assembly)];
    PackedGrain& grain = grains[owned.slot];
    grain.position = double4(box.wrapped_from_afar(motion.place(member.at_start, time)), grain.position[3]);
    grain.velocity = double4(motion.velocity_of(member.at_start, time_of_velocity));
    grain.spin = double4(motion.spin());
  }
}

void Assemblies::save(ArchiveWriter& archive, const std::string& group, MPI_Comm communicator) const {
  if (motions_.empty()) return;
  std::vector<std::int64_t> numbers;
  std::vector<double> places;
  for (const Member& member : members_) {
    numbers.insert(numbers.end(), {member.id, member.assembly});
    places.insert(places.end(), member.at_start.data(), member.at_start.data() + 3);
  }
  const std::uint64_t rows = members_.size();
  write_whole<std::int64_t>(archive, communicator, group + "/assembly_members", numbers, {rows, 2});
  write_whole<double>(archive, communicator, group + "/assembly_places_at_start", places, {rows, 3});
}

void Assemblies::load(ArchiveReader& archive, const std::string& group) {
  owned_.clear();
  if (motions_.empty()) return;
  if (!archive.has(group + "/assembly_members"))
    throw InputError("The saved grains have no rigid assemblies, but this case has; the populations must be the same.");
  const std::string path = group + "/assembly_members";
  const std::uint64_t rows = archive.shape(path).at(0);
  if (rows == 0) throw damaged_dataset(path, "the file holds no values");
  const auto numbers = read_whole<std::int64_t>(archive, path, {rows, 2});
  const auto places = read_whole<double>(archive, group + "/assembly_places_at_start", {rows, 3});
  members_.clear();
  for (std::size_t m = 0; 2 * m < numbers.size(); ++m) {
    if (numbers[2 * m + 1] >= static_cast<std::int64_t>(motions_.size()))
      throw InputError(
          fmt::format("The saved grains are of more rigid assemblies than this case has, {}.", motions_.size()));
    members_.push_back({numbers[2 * m], numbers[2 * m + 1], Vec3(places.data() + 3 * m)});
  }
  find_largest_speed();
}

void check_whole(const std::vector<PrescribedMotion>& motions, std::span<const GrainSeed> seeds,
                 const PeriodicBox& box) {
  constexpr double rounding = 1e-6;  // of a diameter, between grains that touch
  std::vector<const GrainSeed*> turning;
  std::vector<Vec3> points;
  double largest = 0.0;
  for (const GrainSeed& seed : seeds) {
    if (seed.assembly < 0 || !motions[static_cast<std::size_t>(seed.assembly)].turns()) continue;
    turning.push_back(&seed);
    points.push_back(box.wrapped(seed.position));
    largest = std::max(largest, seed.radius);
  }
  if (turning.empty()) return;
  const CellGrid grid(box, 2.0 * (1.0 + rounding) * largest, points);
  grid.for_each_near_pair([&](std::uint32_t m, std::uint32_t n) {
    const GrainSeed &a = *turning[grid.order()[m]], &b = *turning[grid.order()[n]];
    if (a.assembly != b.assembly) return;
    const Vec3 nearest = box.difference(a.position, b.position);
    if (nearest.norm() > (1.0 + rounding) * (a.radius + b.radius)) return;
    const Vec3 across = a.position - b.position - nearest;  // whole lengths of the box
    const Vec3 torn = across.cross(motions[static_cast<std::size_t>(a.assembly)].axis);
    if (torn.norm() <= rounding * a.radius) return;
    Eigen::Index axis = 0;
    across.cwiseAbs().maxCoeff(&axis);
    const auto [first, second] = std::minmax(a.id, b.id);
    throw InputError(
        fmt::format("Grains {} and {} of a rotating population touch across the periodic face of axis {}, where their "
                    "rotation would tear them apart; move the population clear of this face.",
                    first, second, "xyz"[axis]));
  });
}

}  // namespace thalweg::dem
