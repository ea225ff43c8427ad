#include "analysis/sizes/plan_view.hpp"

#include "core/parallel/mpi_session.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::analysis {

namespace {

std::int64_t pixels_along(double length, double pixel) {
  return std::max<std::int64_t>(1, std::llround(length / pixel));
}

// The uppermost surface over a pixel, and whose it is.
struct Top {
  double height = -std::numeric_limits<double>::infinity();  // m
  GlobalId id = -1;
  int kind = -1;
};

}  // namespace

PlanView::PlanView(MPI_Comm communicator, const PeriodicBox& box, double pixel, bool disks)
    : communicator_(communicator),
      box_(box),
      disks_(disks),
      columns_(pixels_along(box.size.x(), pixel)),
      rows_(disks ? 1 : pixels_along(box.size.y(), pixel)) {
  const std::int64_t ranks = size_of(communicator);
  share_ = (columns_ + ranks - 1) / ranks;
}

double PlanView::offset(int axis, std::int64_t pixel, double place) const {
  const std::int64_t count = axis == 0 ? columns_ : rows_;
  return (static_cast<double>(pixel) + 0.5) * (box_.size[axis] / static_cast<double>(count)) - place;
}

PlanView::Range PlanView::covered(int axis, double place, double reach) const {
  const std::int64_t count = axis == 0 ? columns_ : rows_;
  if (axis == 1 && disks_) return {0, 0};
  const double width = box_.size[axis] / static_cast<double>(count);
  Range range{static_cast<std::int64_t>(std::ceil((place - reach) / width - 0.5)),
              static_cast<std::int64_t>(std::floor((place + reach) / width - 0.5))};
  if (box_.periodic[static_cast<std::size_t>(axis)])
    range.last = std::min(range.last, range.first + count - 1);
  else
    range = {std::max<std::int64_t>(range.first, 0), std::min(range.last, count - 1)};
  return range;
}

// Each sphere goes to the ranks at whose columns it may be seen.
std::vector<SeenSphere> PlanView::spheres_over_my_strip(const std::vector<SeenSphere>& spheres) const {
  std::vector<SeenSphere> sent;
  std::vector<int> to;
  for (const SeenSphere& sphere : spheres) {
    const Range columns = covered(0, sphere.x, sphere.radius);
    int latest = -1;
    for (std::int64_t column = columns.first; column <= columns.last; ++column) {
      const int home = home_of(column);
      if (home == latest) continue;
      sent.push_back(sphere);
      to.push_back(latest = home);
    }
  }
  return exchange_rows(communicator_, std::move(sent), to);
}

std::vector<std::int64_t> PlanView::pixels_of(const std::vector<SeenSphere>& spheres, int kinds) const {
  const int rank = rank_of(communicator_);
  std::vector<Top> tops(static_cast<std::size_t>(share_ * rows_));
  for (const SeenSphere& sphere : spheres_over_my_strip(spheres)) {
    const Range columns = covered(0, sphere.x, sphere.radius);
    for (std::int64_t column = columns.first; column <= columns.last; ++column) {
      if (home_of(column) != rank) continue;
      const double dx = offset(0, column, sphere.x);
      const double across = sphere.radius * sphere.radius - dx * dx;
      if (across < 0.0) continue;
      const Range rows = covered(1, sphere.y, std::sqrt(across));
      Top* strip = tops.data() + (inside(column, columns_) - rank * share_) * rows_;
      for (std::int64_t row = rows.first; row <= rows.last; ++row) {
        const double dy = disks_ ? 0.0 : offset(1, row, sphere.y);
        const Top seen{sphere.z + std::sqrt(std::max(0.0, across - dy * dy)), sphere.id, sphere.kind};
        Top& top = strip[inside(row, rows_)];
        if (seen.height > top.height || (seen.height == top.height && seen.id < top.id)) top = seen;
      }
    }
  }
  std::vector<std::int64_t> counts(static_cast<std::size_t>(kinds), 0);
  for (const Top& top : tops)
    if (top.kind >= 0) ++counts[static_cast<std::size_t>(top.kind)];
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), kinds, MPI_INT64_T, MPI_SUM, communicator_);
  return counts;
}

}  // namespace thalweg::analysis
