// Grains whose state follows from their id alone, dealt out to the ranks so that each rank holds another order of them.
#pragma once

#include "core/parallel/decomposition.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/state/snapshot.hpp"
#include "core/state/system.hpp"

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::analysis {

struct MadeUpGrain {
  double radius = 0.5, mass = 1.0;
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
  Vec3 position = Vec3::Zero();  // beyond periodic faces, too
  Vec3 fluid_force = Vec3::Zero(), fluid_torque = Vec3::Zero();
  Vec3 contact_force = Vec3::Zero(), contact_torque = Vec3::Zero();
};

// 20 m x 10 m x 5 m.
inline Decomposition made_up_box(bool periodic_x = true) {
  return {{40, 20, 10}, 0.5, {periodic_x, true, false}, {1, 1, 1}};
}

class MadeUpGrains {
public:
  // grain: of ids below `ids`; none: there is no such grain. turn: with another number grains have other owners.
  MadeUpGrains(MPI_Comm communicator, GlobalId ids, const std::function<std::optional<MadeUpGrain>(GlobalId)>& grain,
               std::int64_t turn = 0, Decomposition decomposition = made_up_box())
      : decomposition_(std::move(decomposition)), end_of_ids_(ids) {
    const int ranks = size_of(communicator), rank = rank_of(communicator);
    for (GlobalId id = ids - 1; id >= 0; --id) {  // descending, and scattered: never the order of one rank
      const std::optional<MadeUpGrain> made = grain(id);
      if (!made) continue;
      ++count_;
      if ((id * 7 + id / 3 + turn) % ranks != rank) continue;
      id_.push_back(id);
      radius_.push_back(made->radius);
      mass_.push_back(made->mass);
      velocity_.push_back(made->velocity);
      angular_velocity_.push_back(made->angular_velocity);
      position_.push_back(decomposition_.box().wrapped_from_afar(made->position));
      fluid_force_.push_back(made->fluid_force);
      fluid_torque_.push_back(made->fluid_torque);
      contact_force_.push_back(made->contact_force);
      contact_torque_.push_back(made->contact_torque);
    }
  }

  // Makes the last `members` grains members of one clump, which the rank of the first of them owns.
  void bind(GlobalId members, const ClumpState& clump) {
    members_ = members;
    clump_.assign(id_.size(), -1);
    for (std::size_t n = 0; n < id_.size(); ++n) {
      if (id_[n] >= end_of_ids_ - members) clump_[n] = end_of_ids_ - members;
      if (id_[n] == end_of_ids_ - members) clumps_ = {clump};
    }
  }

  // Holds the velocity of some, as of a plate that is driven.
  void hold(const std::function<bool(GlobalId)>& held) {
    for (const GlobalId id : id_) motion_.push_back(held(id) ? 3 : 0);
  }

  // A view of these grains. time: s, in steps of `step` s.
  Snapshot snapshot(double time, double step = 0.01) const {
    Snapshot snapshot;
    snapshot.time = time;
    snapshot.step = std::llround(time / step);
    snapshot.decomposition = &decomposition_;
    snapshot.grains.global_count = count_;
    snapshot.grains.id_limit = end_of_ids_;
    snapshot.grains.id = id_;
    snapshot.grains.radius = radius_;
    snapshot.grains.mass = mass_;
    snapshot.grains.position = position_;
    snapshot.grains.velocity = velocity_;
    snapshot.grains.angular_velocity = angular_velocity_;
    snapshot.grains.fluid_force = fluid_force_;
    snapshot.grains.fluid_torque = fluid_torque_;
    snapshot.grains.contact_force = contact_force_;
    snapshot.grains.contact_torque = contact_torque_;
    snapshot.grains.motion = motion_;
    if (members_ == 0) return snapshot;
    snapshot.grains.clump_count = 1;
    snapshot.grains.member_count = members_;
    snapshot.grains.clump = clump_;
    snapshot.grains.clumps = clumps_;
    return snapshot;
  }

private:
  Decomposition decomposition_;
  GlobalId end_of_ids_, count_ = 0;
  std::vector<GlobalId> id_;
  std::vector<double> radius_, mass_;
  std::vector<Vec3> position_, velocity_, angular_velocity_, fluid_force_, fluid_torque_, contact_force_,
      contact_torque_;
  std::vector<std::uint8_t> motion_;
  GlobalId members_ = 0;
  std::vector<GlobalId> clump_;
  std::vector<ClumpState> clumps_;
};

// The value of a diagnostic by name; throws std::bad_optional_access where there is none.
inline double value_of(const std::vector<Diagnostic>& diagnostics, const std::string& name) {
  return find_diagnostic(diagnostics, name).value();
}

}  // namespace thalweg::analysis
