#include "driver/warnings/solid_warnings.hpp"

#include "driver/bed/bed_flow.hpp"
#include "driver/bed/solid_cells.hpp"
#include "driver/case/axes.hpp"
#include "driver/case/solid_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace thalweg::driver {

namespace {

constexpr double suspiciously_long = 10.0;  // boxes; a file in millimetres is a thousand times too large

bool is_outside(const Case& c, const SolidCase& solid, int axis) {
  const bodies::Extent extent = extent_of(solid);
  return !periodic_axes(c.domain)[static_cast<std::size_t>(axis)] &&
         (extent.upper[axis] <= 0.0 || extent.lower[axis] >= c.domain.size[axis]);
}

// True if other warnings say already that the solid is too large, or elsewhere.
bool is_misplaced(const Case& c, const SolidCase& solid) {
  const bodies::Extent extent = extent_of(solid);
  if ((extent.upper - extent.lower).cwiseQuotient(c.domain.size).maxCoeff() > suspiciously_long) return true;
  return is_outside(c, solid, 0) || is_outside(c, solid, 1) || is_outside(c, solid, 2);
}

std::string other_place(const Case& c, std::size_t n) {
  return c.solids[n].sphere ? fmt::format("another solids.{0}.sphere.centre or radius in m", n)
                            : fmt::format("another solids.{0}.translate in m or solids.{0}.scale", n);
}

// "The solid solids.0", "The solids".
std::string the_solids(const Case& c) { return c.solids.size() == 1 ? "The solid solids.0" : "The solids together"; }

std::string verb(const Case& c, const char* word) { return word + std::string(c.solids.size() == 1 ? "s" : ""); }

// m: below it no free grain lies at the start.
double lowest_grain(const Case& c) {
  double lowest = c.domain.size.z();
  for (const std::size_t p : free_populations(c)) {
    const beds::PlacementKeys& placement = c.grains[p].placement;
    double low = placement.region ? placement.region->lower.z() : 0.0;
    if (!placement.positions.empty()) {
      low = c.domain.size.z();
      for (const Vec3& position : placement.positions) low = std::min(low, position.z());
    }
    lowest = std::min(lowest, low);
  }
  return lowest;
}

// True if above every point of the floor a solid lies over a place for grains, and water over the solid; else it is a
// lid on the flow.
bool lie_over_the_grains(const Case& c, const SolidCells& cells) {
  const double lowest = lowest_grain(c);
  bool water_above = false;
  for (int i = 0; i < cells.size()[0]; ++i)
    for (int j = 0; j < cells.size()[1]; ++j) {
      bool place = false, covered = false;
      for (int k = 0; k < cells.size()[2]; ++k) {
        const bool solid = cells.covered({i, j, k});
        water_above = water_above || (covered && !solid);
        covered = covered || (place && solid);
        place = place || (cells.height(k) > lowest && !solid);
      }
      if (!covered) return false;
    }
  return water_above;
}

}  // namespace

Warnings large_solids(const Case& c) {
  Warnings found;
  for (std::size_t n = 0; n < c.solids.size(); ++n) {
    const SolidCase& solid = c.solids[n];
    if (solid.stl.empty()) continue;
    const bodies::Extent extent = extent_of(solid);
    const Vec3 boxes = (extent.upper - extent.lower).cwiseQuotient(c.domain.size);
    int axis = 0;
    if (boxes.maxCoeff(&axis) <= suspiciously_long) continue;
    found.push_back(
        fmt::format("The surface solids.{0} is {1:.4g} m long along {2}, {3:.3g} times the box: if its file is in "
                    "millimetres, consider solids.{0}.scale: {4:.9g}.",
                    n, extent.upper[axis] - extent.lower[axis], axis_name[axis], boxes[axis], 1e-3 * solid.scale));
  }
  return found;
}

// Such a solid does nothing, unless it moves into the box.
Warnings absent_solids(const Case& c) {
  Warnings found;
  for (std::size_t n = 0; n < c.solids.size(); ++n) {
    if (c.solids[n].motion) continue;
    const bodies::Extent extent = extent_of(c.solids[n]);
    for (int axis = 0; axis < 3; ++axis) {
      if (!is_outside(c, c.solids[n], axis)) continue;
      found.push_back(fmt::format(
          "The solid solids.{} lies outside the box, from {:.4g} to {:.4g} m along {} where the box reaches "
          "from 0 to {:g} m, and does nothing: consider {}.",
          n, extent.lower[axis], extent.upper[axis], axis_name[axis], c.domain.size[axis],
          c.solids[n].sphere ? fmt::format("another solids.{}.sphere.centre in m", n)
                             : fmt::format("solids.{0}.translate in m, or another solids.{0}.scale", n)));
      break;
    }
  }
  return found;
}

namespace {

// Between the centres of the cells.
std::vector<std::string> thin_solids(const Case& c) {
  std::vector<std::string> found;
  for (std::size_t n = 0; n < c.solids.size(); ++n)
    if (!c.solids[n].motion && !is_misplaced(c, c.solids[n]) && !covers_a_cell(c, c.solids[n]))
      found.push_back(fmt::format(
          "The solid solids.{} covers the centre of no cell of {:g} m, so the fluid does not meet it: consider {}.", n,
          c.domain.spacing, other_place(c, n)));
  return found;
}

// Of two that cover the same, the later one. What moves may come out.
std::vector<std::string> hidden_solids(const Case& c) {
  std::vector<std::string> found;
  const auto hides = [&](std::size_t outer, std::size_t inner) {
    const SolidCase &around = c.solids[outer], &solid = c.solids[inner];
    return outer != inner && !around.motion && !solid.motion && !is_misplaced(c, around) && !is_misplaced(c, solid) &&
           lies_within(c, solid, around);
  };
  for (std::size_t n = 0; n < c.solids.size(); ++n)
    for (std::size_t other = 0; other < c.solids.size(); ++other) {
      if (!hides(other, n) || (other > n && hides(n, other))) continue;
      found.push_back(
          fmt::format("The solid solids.{} lies within solids.{}, where neither fluid nor grains meet it: "
                      "remove it, or consider {}.",
                      n, other, other_place(c, n)));
      break;
    }
  return found;
}

// Sentence on what solids leave to the flow; empty: enough.
std::string closed_channel(const Case& c) {
  const auto blocks = [&](const SolidCase& solid) { return !solid.motion && !is_misplaced(c, solid); };
  if (!std::all_of(c.solids.begin(), c.solids.end(), blocks)) return {};
  const std::string remedy =
      c.solids.size() == 1 ? other_place(c, 0) : std::string("other places or sizes of solids in m");
  const SolidCells cells(c);
  const double bed = c.grains.empty() ? 0.0 : settled_height(c);
  if (drives_flow(c, 0) && bed < c.domain.size.z() && !cells.opens_along_x(bed))
    return fmt::format("{} {} the channel, so no water passes along x{}: consider {}.", the_solids(c), verb(c, "block"),
                       bed > 0.0 ? " above the bed" : "", remedy);
  if (c.system == SystemKind::resolved && gravity_vector(c.gravity).z() < 0.0 && !c.grains.empty() &&
      lie_over_the_grains(c, cells))
    return fmt::format("{} {} all of the bed, so the flow does not reach the grains beneath: consider {}.",
                       the_solids(c), verb(c, "cover"), remedy);
  return {};
}

}  // namespace

std::vector<std::string> solids_in_the_lattice(const Case& c) {
  if (!has_fluid(c) || c.solids.empty()) return {};
  std::vector<std::string> found = thin_solids(c);
  for (std::string& sentence : hidden_solids(c)) found.push_back(std::move(sentence));
  if (const std::string closed = closed_channel(c); !closed.empty()) found.insert(found.begin(), closed);
  return found;
}

}  // namespace thalweg::driver
