// Energy and momentum of all grains together, summed with the same bits on any number of ranks:
//
//   E = sum of (1/2) m |v|^2 + (1/2) I |omega|^2,  I = (2/5) m R^2 (spheres);   p = sum of m v.
#pragma once

#include "analysis/observer/latest_values.hpp"
#include "analysis/observer/observer.hpp"

#include <mpi.h>

#include <vector>

namespace thalweg::analysis {

class GrainEnergy : public Observer {
public:
  explicit GrainEnergy(MPI_Comm communicator) : communicator_(communicator) {}

  std::string name() const override { return "grain_energy"; }
  void observe(const Snapshot& snapshot) override;

  // grain_kinetic_energy (J), grain_momentum_x, _y, _z (kg m/s).
  std::vector<Diagnostic> diagnostics() const override { return diagnostics_; }

  void save(ArchiveWriter& archive) const override { save_latest(archive, name(), diagnostics_); }
  bool load(ArchiveReader& archive) override {
    load_latest(archive, name(), diagnostics_);
    return true;
  }

private:
  MPI_Comm communicator_;
  std::vector<Diagnostic> diagnostics_{{"grain_kinetic_energy", "J", 0.0},
                                       {"grain_momentum_x", "kg m/s", 0.0},
                                       {"grain_momentum_y", "kg m/s", 0.0},
                                       {"grain_momentum_z", "kg m/s", 0.0}};
};

}  // namespace thalweg::analysis
