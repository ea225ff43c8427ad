// The height of the bed in a snapshot, by thin layers of the box (bed_height.hpp).
#pragma once

#include "analysis/bed/bed_height.hpp"
#include "analysis/bed/obstacle_grains.hpp"
#include "analysis/observer/run_context.hpp"
#include "core/geometry/periodic_box.hpp"
#include "core/state/snapshot.hpp"
#include "core/sums/reproducible_sum.hpp"

#include <mpi.h>

#include <map>
#include <vector>

namespace thalweg::analysis {

class BedLayers {
public:
  // window: m, the height over which the solid fraction is averaged. disk_thickness: m, 0: spheres. Obstacles are the
  // bed where there are no other grains, and so are grains that float.
  BedLayers(MPI_Comm communicator, const PeriodicBox& box, double window, double disk_thickness = 0.0,
            const BedObstacles& obstacles = {});

  struct Bed {
    double height;           // m, above the floor of the box; 0 without grains
    double solid_fraction;   // of the bulk
    double obstacles_above;  // m^3, of obstacles above that height
  };
  Bed bed(const Snapshot& snapshot) const;  // the same bits on any ranks; collective
  double width() const { return width_; }   // m, of the bed
  // Of each grain here, whether it is none of the bed: it floats over it, or is an obstacle in it. Empty where there is
  // no such grain. Collective.
  std::vector<char> not_of_the_bed(const Snapshot& snapshot) const;
  bool obstacles_are_the_bed(const Snapshot& snapshot) const { return obstacles_.are_the_bed(snapshot); }

private:
  std::vector<char> floating(const Snapshot& snapshot) const;
  std::vector<double> grains_below(const Snapshot& snapshot) const;
  void give_volumes(const GrainView& grains, const std::map<GlobalId, double>& shares,
                    const std::vector<char>& floating, const TermTaker& take) const;
  std::vector<double> spheres_below(const Snapshot& snapshot) const;

  MPI_Comm communicator_;
  PeriodicBox box_;
  int layers_;        // thin ones
  double thickness_;  // m, of a thin layer
  double width_;
  ObstacleGrains obstacles_;
  std::vector<double> solids_below_;  // m^3, at the heights of the layers; empty: there are none
  double floating_density_;           // kg/m^3, as BedObstacles has it
};

}  // namespace thalweg::analysis
