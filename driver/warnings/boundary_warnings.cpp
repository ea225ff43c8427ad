#include "driver/warnings/boundary_warnings.hpp"

#include "dem/motion/walls.hpp"
#include "driver/bed/bed_flow.hpp"
#include "driver/case/axes.hpp"
#include "driver/estimate/filled_in.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::driver {

namespace {

using lbm::FaceType;

std::size_t opposite(std::size_t face) { return face ^ 1U; }

// m/s, of the fluid that comes in through a velocity_inlet; negative: it leaves.
double inflow(const Case& c, std::size_t face) {
  const double along = c.domain.faces[face].velocity[static_cast<int>(face / 2)];
  return face % 2 == 0 ? along : -along;
}

bool is(const Case& c, std::size_t face, FaceType type) { return c.domain.faces[face].type == type; }

bool any(const Case& c, FaceType type) {
  return std::any_of(c.domain.faces.begin(), c.domain.faces.end(),
                     [type](const coupling::FaceKeys& face) { return face.type == type; });
}

// m^3/s, into the box through all velocity_inlets.
double net_inflow(const Case& c) {
  double net = 0.0;
  for (std::size_t face = 0; face < c.domain.faces.size(); ++face)
    if (is(c, face, FaceType::velocity_inlet))
      net += inflow(c, face) * c.domain.size.prod() / c.domain.size[static_cast<int>(face / 2)];
  return net;
}

std::string sucks(const Case& c, std::size_t face) {
  const Vec3 reversed = -c.domain.faces[face].velocity;
  const bool beside_an_inlet = is(c, opposite(face), FaceType::velocity_inlet) && inflow(c, opposite(face)) > 0.0;
  return fmt::format("The velocity of the velocity_inlet {0} points out of the box, so it removes fluid: consider {1}.",
                     face_key(c.domain, face),
                     beside_an_inlet ? fmt::format("{}: pressure_outlet", face_key(c.domain, face))
                                     : fmt::format("{}.velocity: [{:g}, {:g}, {:g}]", face_key(c.domain, face),
                                                   reversed.x() + 0.0, reversed.y() + 0.0, reversed.z() + 0.0));
}

}  // namespace

std::string face_key(const DomainCase& domain, std::size_t face) {
  const bool by_axis = face < bottom && domain.faces[face] == domain.faces[opposite(face)];
  return fmt::format("domain.boundaries.{}", by_axis ? axis_name[face / 2] : dem::face_names[face]);
}

Warnings swapped_floor(const Case& c) {
  const coupling::FaceKeys floor = c.domain.faces[bottom], lid = c.domain.faces[top];
  if (floor.type != FaceType::free_slip || !(lid.type == FaceType::no_slip || lid.type == FaceType::law_of_the_wall) ||
      gravity_vector(c.gravity).z() >= 0.0)
    return {};
  const char* word = lid.type == FaceType::no_slip ? "no_slip" : "law_of_the_wall";
  const Remedy swapped{
      word_change("domain.boundaries.bottom", word, [lid](Case& other) { other.domain.faces[bottom] = lid; }),
      word_change("domain.boundaries.top", "free_slip", [floor](Case& other) { other.domain.faces[top] = floor; })};
  return {{fmt::format("The bottom is free_slip and the top {}, which look swapped: the fluid slips over the floor and "
                       "sticks to the lid",
                       word),
           {{swapped, {}}},
           "no_slip at the bottom and free_slip at the top"}};
}

Warnings inlets(const Case& c) {
  Warnings found;
  for (std::size_t face = 0; face < c.domain.faces.size(); ++face) {
    if (!is(c, face, FaceType::velocity_inlet)) continue;
    if (inflow(c, face) < 0.0) found.push_back(sucks(c, face));
    if (inflow(c, face) == 0.0)
      found.push_back(
          fmt::format("The velocity of the velocity_inlet {0} has no component into the box, so no fluid comes in: "
                      "consider another {0}.velocity in m/s, or {0}.type: moving.",
                      face_key(c.domain, face)));
  }
  constexpr double rounding = 1e-6;  // of what comes in and leaves
  double most = 0.0;
  for (std::size_t face = 0; face < c.domain.faces.size(); ++face)
    if (is(c, face, FaceType::velocity_inlet))
      most =
          std::max(most, std::abs(inflow(c, face)) * c.domain.size.prod() / c.domain.size[static_cast<int>(face / 2)]);
  const double net = net_inflow(c);
  if (!any(c, FaceType::pressure_outlet) && std::abs(net) > rounding * most)
    found.push_back(
        fmt::format("A velocity_inlet {} the box and no face lets the fluid {}, so its pressure {} without limit: "
                    "consider a pressure_outlet.",
                    net > 0.0 ? "fills" : "empties", net > 0.0 ? "out" : "in", net > 0.0 ? "rises" : "falls"));
  return found;
}

namespace {

// The change of the pressures of all outlets by this (Pa).
Remedy pressures_changed(const Case& c, double by) {
  Remedy changes;
  for (std::size_t face = 0; face < c.domain.faces.size(); ++face) {
    if (!is(c, face, FaceType::pressure_outlet)) continue;
    const std::string key = face_key(c.domain, face) + ".pressure";
    if (!changes.empty() && changes.back().key == key) continue;  // both faces of an axis
    const bool both = face < bottom && c.domain.faces[face] == c.domain.faces[opposite(face)];
    changes.push_back(exact_change(key, c.domain.faces[face].pressure + by, 9, [face, both](Case& other, double to) {
      other.domain.faces[face].pressure = to;
      if (both) other.domain.faces[opposite(face)].pressure = to;
    }));
  }
  return changes;
}

}  // namespace

Warnings outlet_pressures(const Case& c) {
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;  // Pa
  for (const coupling::FaceKeys& face : c.domain.faces) {
    if (face.type != FaceType::pressure_outlet) continue;
    lowest = std::min(lowest, face.pressure);
    highest = std::max(highest, face.pressure);
  }
  if (!(lowest <= highest)) return {};
  const double common = lowest > 0.0 ? lowest : highest < 0.0 ? highest : 0.0;
  constexpr double limit_rounding = 1e-9;
  const double compression = 3.0 * largest_outlet_pressure(c) / units_of(c).stress();
  const bool compresses = compression * (1.0 - limit_rounding) > largest_compression;
  std::vector<Advice> advice;
  if (common != 0.0) advice.push_back({pressures_changed(c, -common), {}});
  if (compresses)
    advice.push_back(
        {{fluid_step_change(fluid_time_step(c) * std::sqrt(largest_compression / compression), 2, Rounding::down)},
         {}});
  if (std::abs(common) > highest - lowest)
    return {{fmt::format("All outlets are {:g} Pa {} the pressure at which the fluid starts, which changes its density "
                         "by {:.2g} % and drives nothing",
                         std::abs(common), common > 0.0 ? "above" : "below",
                         100.0 * 3.0 * std::abs(common) / units_of(c).stress()),
             advice}};
  if (!compresses) return {};
  return {{fmt::format("The pressure of an outlet changes the density of the fluid by {:.2g} %", 100.0 * compression),
           advice, "a shorter step"}};
}

Warnings outlets(const Case& c) {
  Warnings found;
  if (any(c, FaceType::velocity_inlet)) return found;
  for (std::size_t face = 0; face < c.domain.faces.size(); ++face)
    if (is(c, face, FaceType::pressure_outlet) && !is(c, opposite(face), FaceType::pressure_outlet))
      found.push_back(
          fmt::format("Fluid may leave by the pressure_outlet {}, but no face brings any in, so none flows there: "
                      "consider a velocity_inlet opposite to it.",
                      face_key(c.domain, face)));
  return found;
}

namespace {

// Depths from an inlet within which eddies meet their own copies, and from an outlet within which it is felt.
constexpr double from_inlet = 3.0, from_outlet = 1.0;

// m, from an inlet at this side to the nearest place where grains of the population may be at the start.
double gap_at(const Case& c, const beds::Population& grains, std::size_t side) {
  const int axis = static_cast<int>(side / 2);
  const double length = c.domain.size[axis];
  const auto from_face = [&](double place) { return side % 2 == 0 ? place : length - place; };
  const beds::PlacementKeys& placement = grains.placement;
  if (placement.region) return from_face((side % 2 == 0 ? placement.region->lower : placement.region->upper)[axis]);
  double gap = placement.positions.empty() ? 0.0 : length;
  for (const Vec3& position : placement.positions)
    gap = std::min(gap, from_face(position[axis]) - 0.5 * grains.largest_extent());
  return gap;
}

// m, of the bed that the grains of a population make over the region, or the box.
double height_over_region(const Case& c, const beds::Population& grains) {
  const beds::RegionKeys region = region_of(c, grains);
  const Vec3 plan = region.upper - region.lower;
  return grains.volume() / (settled_fraction(c) * plan.x() * plan.y());
}

// Free grains make way, and single ones that are held do no harm.
bool held_bed_reaches(const Case& c, std::size_t side) {
  constexpr double thinnest = 0.25, nearest = 1.0 - 1e-6;  // diameters
  return std::any_of(c.grains.begin(), c.grains.end(), [&](const beds::Population& grains) {
    return grains.held() && height_over_region(c, grains) >= thinnest * grains.diameter &&
           gap_at(c, grains, side) < nearest * grains.diameter;
  });
}

// The plane where it is best; none: the box is too short for one.
std::vector<Advice> plane_advice(const Case& c, std::size_t face, double depth) {
  const double length = c.domain.size[static_cast<int>(face / 2)];
  if (!(length >= (from_inlet + from_outlet) * depth)) return {};
  const double best = face % 2 == 0 ? from_inlet * depth : length - from_inlet * depth;
  return {{{exact_change(face_key(c.domain, face) + ".recycling_plane", best, 3,
                         [face](Case& other, double to) { other.domain.faces[face].recycling_plane = to; })},
           {}}};
}

}  // namespace

Warnings recycling(const Case& c) {
  Warnings found;
  const double depth = c.domain.size.z() - settled_height(c);
  for (std::size_t face = x_low; face <= y_high; ++face) {
    const coupling::FaceKeys& inlet = c.domain.faces[face];
    if (inlet.type != FaceType::velocity_inlet || !inlet.recycling_plane) continue;
    const double length = c.domain.size[static_cast<int>(face / 2)], plane = *inlet.recycling_plane;
    const double before = face % 2 == 0 ? plane : length - plane, behind = length - before;
    if (before >= from_inlet * depth && behind >= from_outlet * depth) continue;
    found.push_back(
        {fmt::format("The recycling plane of {} is {:.3g} depths of the water from the inlet and {:.3g} from "
                     "the outlet; eddies need {:g} and {:g}",
                     face_key(c.domain, face), before / depth, behind / depth, from_inlet, from_outlet),
         plane_advice(c, face, depth), "a longer box"});
  }
  return found;
}

Warnings beds_at_inlets(const Case& c) {
  Warnings found;
  const double depth = c.domain.size.z() - settled_height(c);
  for (std::size_t face = x_low; face <= y_high; ++face) {
    if (!is(c, face, FaceType::velocity_inlet) || c.domain.faces[face].recycling_plane || !held_bed_reaches(c, face))
      continue;
    found.push_back({fmt::format("Held grains reach the velocity_inlet {}, whose velocity, the same all over the face, "
                                 "drives fluid into their pores, too: the run may break down",
                                 face_key(c.domain, face)),
                     plane_advice(c, face, depth), "grains that begin two diameters from the inlet"});
  }
  return found;
}

}  // namespace thalweg::driver
