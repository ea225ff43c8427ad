// An entrainment as it is recorded: from the ring of a grain to its hinge, torques and arrays.
#pragma once

#include "analysis/tools/hinge.hpp"
#include "core/state/records.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace thalweg::analysis {

struct EntrainedGrain {
  GlobalId id;
  double radius;          // m
  Vec3 rest;              // m, its rest place
  Vec3 weight, buoyancy;  // N, as torques_about() has them
};

struct Entraining {
  std::optional<std::size_t> onset;   // number of the sample; none: the motion began before the first
  std::optional<Hinge> hinge;         // none: it had too few contacts, or there is no onset
  std::vector<HingeTorques> torques;  // of each sample; empty without a hinge

  // Share of the couple in the fluid's torque, sum T_C / sum T_F until the onset; not a number without a hinge, or if
  // the fluid did not push the way the grain went.
  double couple_share() const;
  double largest_torque_ratio() const;  // T_F/T_c until the onset; not a number without a hinge or a T_c above 0

private:
  std::span<const HingeTorques> until_onset() const;
};

Entraining entraining_of(const EntrainedGrain& grain, const GrainRing& ring, double moving_speed);

// The event of this name, at the latest sample, as Entrainment describes it.
Event event_of(const std::string& name, const EntrainedGrain& grain, const GrainRing& ring,
               const Entraining& entraining);

}  // namespace thalweg::analysis
