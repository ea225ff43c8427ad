#include "dem/supply/travelling_body.hpp"

#include "core/parallel/ranks.hpp"
#include "dem/ranks/grain_start.hpp"

#include <algorithm>
#include <utility>

namespace thalweg::dem {

namespace {

void set(const Vec3& from, double (&to)[3]) { std::copy(from.data(), from.data() + 3, to); }

}  // namespace

Vec3 TravellingBody::arm(std::size_t r) const {
  if (!clump) return Vec3::Zero();
  const double(&q)[4] = clump->orientation;
  return rotation_matrix({q[0], q[1], q[2], q[3]}) * Vec3(rows[r].offset.data());
}

double TravellingBody::reach() const {
  double reach = 0.0;
  for (const GrainRow& row : rows) reach = std::max(reach, Vec3(row.offset.data()).norm() + row.radius);
  return reach;
}

void TravellingBody::renumber(GlobalId first_id) {
  GlobalId next = first_id;
  for (GrainRow& row : rows) {
    row.id = next++;
    if (clump) row.clump = first_id;
  }
  if (clump) clump->id = first_id;
}

void TravellingBody::place(const Vec3& centre, const PeriodicBox& box) {
  for (std::size_t r = 0; r < rows.size(); ++r) {
    auto& value = rows[r].value;
    value[GrainRow::position] = plain(box.wrapped(centre + arm(r)));
    for (const auto force :
         {GrainRow::contact_force, GrainRow::contact_torque, GrainRow::load_force, GrainRow::load_torque})
      value[force] = {};
  }
  if (clump) set(box.wrapped(centre), clump->centre);
}

void TravellingBody::set_velocity(const Vec3& velocity) {
  // A member holds what its clump holds.
  const bool keeps_spin = holds_rotation(static_cast<Motion>(rows.front().motion));
  const Vec3 spin = keeps_spin ? Vec3(rows.front().value[GrainRow::angular_velocity].data()) : Vec3::Zero();
  for (std::size_t r = 0; r < rows.size(); ++r) {
    rows[r].value[GrainRow::velocity] = plain(velocity + spin.cross(arm(r)));
    rows[r].value[GrainRow::angular_velocity] = plain(spin);
  }
  if (!clump) return;
  set(velocity, clump->velocity);
  if (keeps_spin) return;
  set(Vec3::Zero(), clump->angular_momentum);
  set(Vec3::Zero(), clump->angular_velocity);
}

std::vector<TravellingBody> bodies_of(const GrainSeeds& seeds, const PeriodicBox& box) {
  std::vector<GrainRow> rows;
  for (const GrainSeed& seed : with_members(seeds.grains, seeds.clumps, box)) rows.push_back(row_of(seed, box));
  std::vector<ClumpRow> clumps;
  for (const ClumpSeed& seed : seeds.clumps) clumps.push_back(row_of(clump_of(seed, box)));
  return bodies_of(std::move(rows), std::move(clumps));
}

std::vector<TravellingBody> bodies_of(std::vector<GrainRow> rows, std::vector<ClumpRow> clumps) {
  const auto by_id = [](const auto& a, const auto& b) { return a.id < b.id; };
  std::sort(rows.begin(), rows.end(), by_id);
  std::sort(clumps.begin(), clumps.end(), by_id);
  std::vector<TravellingBody> bodies;
  auto clump = clumps.cbegin();
  for (const GrainRow& row : rows) {
    if (row.clump < 0 || row.id == row.clump) bodies.emplace_back();
    bodies.back().rows.push_back(row);
    if (row.clump >= 0 && row.id == row.clump) bodies.back().clump = *clump++;
  }
  return bodies;
}

std::vector<TravellingBody> gathered_bodies(std::vector<GrainRow> rows, std::vector<ClumpRow> clumps,
                                            MPI_Comm communicator) {
  const Ranks ranks(communicator);
  return bodies_of(ranks.gathered(std::move(rows)), ranks.gathered(std::move(clumps)));
}

}  // namespace thalweg::dem
