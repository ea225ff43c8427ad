// Solids in the fluid: the motion of those that move, the mass they owe the fluid, and the loads on every solid for
// reports and checkpoints.
#pragma once

#include "bodies/bodies.hpp"
#include "core/base/archive.hpp"
#include "core/base/units.hpp"
#include "core/state/system.hpp"
#include "core/sums/fixed_point.hpp"
#include "dem/motion/prescribed_motion.hpp"

#include <mpi.h>

#include <vector>

namespace thalweg::coupling {

template <typename Real>
class SolidBodies {
public:
  // motions: SI, of the first solids; the others stand still. The bodies, which must outlive it, have the solids where
  // they are at the start.
  SolidBodies(MPI_Comm communicator, bodies::Bodies<Real>& bodies, const Units& units,
              const std::vector<dem::PrescribedMotion>& motions);

  bool any_moves() const { return !moving_.empty(); }

  // Moves those that move to where they are at a time (s), between begin_step() and settle() of the bodies.
  void move(double time);
  // Settles, at the end of a step, the mass that moving solids have taken; it comes back in the next steps. Collective.
  void settle_masses();
  double mass_owed() const;  // to the fluid, lattice units; the same on every rank

  // Force and torque of the fluid on every solid in the last step, lattice units. Collective.
  struct Loads {
    std::vector<Vec3> forces, torques;  // torques: about the point of the axis; zero of solids that do not turn
  };
  Loads loads() const;
  // solid_<n>_force_x, _y, _z (N), and of solids that turn solid_<n>_torque_x, _y, _z (N m). Collective.
  std::vector<Diagnostic> diagnostics() const;

  void save(ArchiveWriter& archive) const;
  // Until forget_loaded(), the loads are those of the checkpoint. Throws InputError where the archive does not hold as
  // many solids, or as many that move.
  void load(ArchiveReader& archive);
  void forget_loaded() { loaded_ = {}; }

private:
  struct Moving {
    int solid;
    dem::PrescribedMotion motion;
    Vec3 pivot;       // of its motion and torque, lattice units
    Vec3 from_point;  // to it from the point of the axis, lattice units
    bodies::MassDebt debt;
    bodies::MassReturn returned;
  };

  // Sums over the links of every solid.
  struct LoadSums {
    std::vector<FixedVec3> forces, torques;
  };

  static constexpr std::uint64_t debt_width = 7;  // numbers that a checkpoint keeps of each that moves

  LoadSums sums() const;  // of the last step, over all ranks
  void save_debts(ArchiveWriter& archive) const;
  void load_debts(ArchiveReader& archive);

  MPI_Comm communicator_;
  bodies::Bodies<Real>& bodies_;
  Units units_;
  std::vector<Moving> moving_;
  LoadSums loaded_;  // of the checkpoint; empty after the first step
};

}  // namespace thalweg::coupling
