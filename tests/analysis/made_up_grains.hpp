// Grains whose state follows from their id alone, dealt out to the ranks so that each rank holds another order of them.
#pragma once

#include "core/parallel/mpi_session.hpp"
#include "core/state/snapshot.hpp"

#include <cmath>
#include <functional>
#include <vector>

namespace thalweg::analysis {

struct MadeUpGrain {
  double radius, mass;
  Vec3 velocity, angular_velocity;
  Vec3 position = Vec3::Zero();
};

class MadeUpGrains {
public:
  MadeUpGrains(MPI_Comm communicator, GlobalId count, const std::function<MadeUpGrain(GlobalId)>& grain)
      : decomposition_({40, 20, 10}, 0.5, {true, true, false}, {1, 1, 1}), count_(count) {
    const int ranks = size_of(communicator), rank = rank_of(communicator);
    for (GlobalId id = count - 1; id >= 0; --id) {  // descending, and scattered: never the order of one rank
      if ((id * 7 + id / 3) % ranks != rank) continue;
      const MadeUpGrain made = grain(id);
      id_.push_back(id);
      radius_.push_back(made.radius);
      mass_.push_back(made.mass);
      velocity_.push_back(made.velocity);
      angular_velocity_.push_back(made.angular_velocity);
      position_.push_back(made.position);
    }
  }

  // Makes the last `members` grains members of one clump, which the rank of the first of them owns.
  void bind(GlobalId members, const ClumpState& clump) {
    members_ = members;
    clump_.assign(id_.size(), -1);
    for (std::size_t n = 0; n < id_.size(); ++n) {
      if (id_[n] >= count_ - members) clump_[n] = count_ - members;
      if (id_[n] == count_ - members) clumps_ = {clump};
    }
  }

  // Holds the velocity of some, as of a plate that is driven.
  void hold(const std::function<bool(GlobalId)>& held) {
    for (const GlobalId id : id_) motion_.push_back(held(id) ? 3 : 0);
  }

  Snapshot snapshot(double time) const {  // domain of 20 m x 10 m x 5 m
    Snapshot snapshot;
    snapshot.time = time;
    snapshot.step = std::llround(100.0 * time);  // steps of 0.01 s
    snapshot.decomposition = &decomposition_;
    snapshot.grains.global_count = count_;
    snapshot.grains.id = id_;
    snapshot.grains.radius = radius_;
    snapshot.grains.mass = mass_;
    snapshot.grains.position = position_;
    snapshot.grains.velocity = velocity_;
    snapshot.grains.angular_velocity = angular_velocity_;
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
  GlobalId count_;
  std::vector<GlobalId> id_;
  std::vector<double> radius_, mass_;
  std::vector<Vec3> position_, velocity_, angular_velocity_;
  std::vector<std::uint8_t> motion_;
  GlobalId members_ = 0;
  std::vector<GlobalId> clump_;
  std::vector<ClumpState> clumps_;
};

// The value of a diagnostic by name; fails loudly when there is none.
inline double value_of(const std::vector<Diagnostic>& diagnostics, const std::string& name) {
  for (const Diagnostic& diagnostic : diagnostics)
    if (diagnostic.name == name) return diagnostic.value;
  throw std::out_of_range("no diagnostic " + name);
}

}  // namespace thalweg::analysis
