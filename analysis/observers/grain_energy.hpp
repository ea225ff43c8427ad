// Energy and momentum of all grains together, summed with the same bits on any number of ranks:
//
//   E = sum of (1/2) m |v|^2 + (1/2) I |omega|^2,  I = (2/5) m R^2 (spheres);   p = sum of m v.
#pragma once

#include "analysis/observer/observer.hpp"

#include <mpi.h>

namespace thalweg::analysis {

class GrainEnergy : public Observer {
public:
  explicit GrainEnergy(MPI_Comm communicator) : communicator_(communicator) {}

  std::string name() const override { return "grain_energy"; }
  void observe(const Snapshot& snapshot) override;

  // grain_kinetic_energy (J), grain_momentum_x, _y, _z (kg m/s).
  std::vector<Diagnostic> diagnostics() const override;

  void save(ArchiveWriter&) const override {}  // nothing is remembered between measurements
  bool load(ArchiveReader&) override { return true; }

private:
  MPI_Comm communicator_;
  double energy_ = 0.0;
  Vec3 momentum_ = Vec3::Zero();
};

}  // namespace thalweg::analysis
