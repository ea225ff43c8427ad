// The grains of this rank as bodies: a clump is one, with what acts on its members taken about its centre.
#pragma once

#include "analysis/tools/grain_record.hpp"
#include "core/state/snapshot.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <vector>

namespace thalweg::analysis {

class BodiesHere {
public:
  explicit BodiesHere(const Snapshot& snapshot);  // which it refers to
  BodiesHere(const BodiesHere&) = delete;
  BodiesHere& operator=(const BodiesHere&) = delete;

  std::span<const GlobalId> ids() const { return ids_; }  // of a clump that of its first member
  // Number of the body of a grain of the view.
  std::size_t body_of(std::size_t grain) const { return body_.empty() ? grain : body_[grain]; }
  Vec3 position(std::size_t body) const;  // m, of the centre

  struct State {
    double radius, mass;  // m, of the sphere of its volume; kg
    GrainRecord record;
  };
  State state(std::size_t body) const;

  // m, from the centre of the body to that of the grain: zero, but of members.
  Vec3 from_centre(std::size_t grain) const;

private:
  std::size_t first_grain(std::size_t body) const { return first_.empty() ? body : first_[body]; }

  const Snapshot& snapshot_;
  std::span<const GlobalId> ids_;
  // Empty without clumps:
  std::vector<GlobalId> own_ids_;
  std::vector<std::size_t> body_;   // of each grain
  std::vector<std::size_t> first_;  // grain of each body
  struct Members {
    const ClumpState* state;
    std::vector<std::size_t> grains;
  };
  std::map<GlobalId, Members> clumps_;
};

inline BodiesHere::BodiesHere(const Snapshot& snapshot) : snapshot_(snapshot), ids_(snapshot.grains.id) {
  const GrainView& grains = snapshot.grains;
  if (grains.clump.empty()) return;
  for (const ClumpState& clump : grains.clumps) clumps_[clump.id].state = &clump;
  for (std::size_t n = 0; n < grains.id.size(); ++n) {
    if (grains.is_member(n)) {
      std::vector<std::size_t>& members = clumps_.at(grains.clump[n]).grains;
      members.push_back(n);
      if (members.size() > 1) {
        body_.push_back(body_[members.front()]);
        continue;
      }
    }
    body_.push_back(first_.size());
    first_.push_back(n);
    own_ids_.push_back(grains.is_member(n) ? grains.clump[n] : grains.id[n]);
  }
  ids_ = own_ids_;
}

inline Vec3 BodiesHere::position(std::size_t body) const {
  const std::size_t first = first_grain(body);
  return snapshot_.grains.is_member(first) ? clumps_.at(ids_[body]).state->position : snapshot_.grains.position[first];
}

inline Vec3 BodiesHere::from_centre(std::size_t grain) const {
  const GrainView& grains = snapshot_.grains;
  if (!grains.is_member(grain)) return Vec3::Zero();
  return snapshot_.decomposition->box().difference(grains.position[grain],
                                                   clumps_.at(grains.clump[grain]).state->position);
}

inline BodiesHere::State BodiesHere::state(std::size_t body) const {
  const GrainView& grains = snapshot_.grains;
  const std::size_t first = first_grain(body);
  if (!grains.is_member(first)) return {grains.radius[first], grains.mass[first], record_of(grains, first)};
  const auto& [shown, members] = clumps_.at(ids_[body]);
  const ClumpState& clump = *shown;
  Vec3 by_fluid = Vec3::Zero(), couple = Vec3::Zero(), by_contacts = Vec3::Zero();
  for (const std::size_t n : members) {
    const GrainRecord member = record_of(grains, n);
    by_fluid += member[GrainRecord::fluid_force];
    couple += member[GrainRecord::fluid_couple] + from_centre(n).cross(member[GrainRecord::fluid_force]);
    by_contacts += member[GrainRecord::contact_force];
  }
  State state{std::cbrt(0.75 / std::numbers::pi * clump.volume), clump.mass, {}};
  state.record.id = clump.id;
  state.record.set(GrainRecord::position, clump.position);
  state.record.set(GrainRecord::velocity, clump.velocity);
  state.record.set(GrainRecord::angular_velocity, clump.angular_velocity);
  state.record.set(GrainRecord::fluid_force, by_fluid);
  state.record.set(GrainRecord::fluid_couple, couple);
  state.record.set(GrainRecord::contact_force, by_contacts);
  return state;
}

}  // namespace thalweg::analysis
