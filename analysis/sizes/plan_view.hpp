// What is seen of the grains from straight above. The plan of the box is divided into pixels, and a pixel shows the
// grain whose surface is highest over its centre, in whose plan area it then counts. The pixels are a grid of points on
// the bed, and their shares of sizes are those by volume of the material at the surface (grid by number: Kellerhals &
// Bray, J. Hydraul. Div. ASCE 97 (1971) 1165), to be compared with a sieve curve.
//
// Each rank looks at a strip of pixels across x, for which it gets all spheres over it, so that no rank has the whole
// picture. The same pixels on any number of ranks: which grain is highest, and of two as high the one with the lower
// id, does not depend on who looks.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/periodic_box.hpp"

#include <mpi.h>

#include <cstdint>
#include <vector>

namespace thalweg::analysis {

struct SeenSphere {
  GlobalId id;
  double x, y, z;  // m, of its centre, inside the box
  double radius;   // m
  int kind;        // of its pixels; -1: it hides what is below it, but counts nowhere
};

class PlanView {
public:
  // pixel: its side, m, changed so that a whole number fills the box along each axis. disks: they lie along y, and the
  // plan is a single row.
  PlanView(MPI_Comm communicator, const PeriodicBox& box, double pixel, bool disks);

  // Number of pixels that show a sphere of each kind, 0 ... kinds - 1, of the spheres of all ranks. Collective.
  std::vector<std::int64_t> pixels_of(const std::vector<SeenSphere>& spheres, int kinds) const;

  std::int64_t pixels() const { return columns_ * rows_; }  // of the whole plan

private:
  struct Range {
    std::int64_t first,
        last;  // columns or rows, which on a periodic axis may lie outside the box; none if first > last
  };
  // Of the pixels of this axis (0: columns, 1: rows) whose centres lie within `reach` (m) of a place (m).
  Range covered(int axis, double place, double reach) const;
  double offset(int axis, std::int64_t pixel, double place) const;  // m, from a place to the pixel's centre
  std::int64_t inside(std::int64_t pixel, std::int64_t count) const { return (pixel % count + count) % count; }
  int home_of(std::int64_t column) const { return static_cast<int>(inside(column, columns_) / share_); }
  std::vector<SeenSphere> spheres_over_my_strip(const std::vector<SeenSphere>& spheres) const;

  MPI_Comm communicator_;
  PeriodicBox box_;
  bool disks_;
  std::int64_t columns_, rows_;
  std::int64_t share_;  // columns of a strip
};

}  // namespace thalweg::analysis
