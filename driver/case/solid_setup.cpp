#include "driver/case/solid_setup.hpp"

#include "core/base/error.hpp"
#include "driver/case/axes.hpp"
#include "driver/case/grain_setup.hpp"
#include "io/text/stl_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace thalweg::driver {
namespace {

constexpr double most_boxes_long = 100.0;  // along a periodic axis, where every box more is one more image
constexpr double most_boxes_away = 1e6;

// A sphere in `around` fields of equal angles round the z axis and half as many from pole to pole.
TriangleMesh sphere_surface(const SphereCase& sphere) {
  constexpr int around = 48, rows = around / 2;
  constexpr double step = std::numbers::pi / rows;
  TriangleMesh mesh;
  mesh.points = {sphere.centre - sphere.radius * Vec3::UnitZ(), sphere.centre + sphere.radius * Vec3::UnitZ()};
  const auto corner = [](int row, int k) {
    return row == 0 ? 0 : row == rows ? 1 : 2 + (row - 1) * around + k % around;
  };
  for (int row = 1; row < rows; ++row)
    for (int k = 0; k < around; ++k)
      mesh.points.push_back(sphere.centre + sphere.radius * Vec3(std::sin(row * step) * std::cos(k * step),
                                                                 std::sin(row * step) * std::sin(k * step),
                                                                 -std::cos(row * step)));
  for (int row = 0; row < rows; ++row)
    for (int k = 0; k < around; ++k) {
      if (row > 0) mesh.triangles.push_back({corner(row, k), corner(row, k + 1), corner(row + 1, k + 1)});
      if (row + 1 < rows) mesh.triangles.push_back({corner(row, k), corner(row + 1, k + 1), corner(row + 1, k)});
    }
  return mesh;
}

}  // namespace

std::string shape_key(const Case& c, std::size_t solid) {
  return fmt::format("solids.{}.{}", solid, c.solids[solid].sphere ? "sphere.radius" : "stl");
}

std::string smaller_text(const SolidCase& solid) {
  return solid.sphere ? "give the radius in m"
                      : fmt::format("if the file is in millimetres, give scale: {:g}", 1e-3 * solid.scale);
}

void fill_in_surfaces(Case& c, const io::YamlDocument& document, const Ranks& ranks) {
  for (std::size_t n = 0; n < c.solids.size(); ++n) {
    SolidCase& solid = c.solids[n];
    if (solid.stl.empty()) continue;
    const std::string key = fmt::format("solids.{}.stl", n);
    solid.stl = document.path_beside(solid.stl, key);
    try {
      solid.surface = io::read_stl(solid.stl, ranks);
    } catch (const InputError& error) {
      throw document.error(key, error);
    }
    for (Vec3& point : solid.surface.points) point = point * solid.scale + solid.translate;
  }
}

bodies::Extent extent_of(const SolidCase& solid) {
  if (solid.sphere) return bodies::extent_of(bodies::SolidSphere{solid.sphere->centre, solid.sphere->radius});
  return bodies::extent_of(solid.surface);
}

void check_solid_extents(const Case& c, const io::YamlDocument& document) {
  for (std::size_t n = 0; n < c.solids.size(); ++n) {
    const bodies::Extent extent = extent_of(c.solids[n]);
    for (int axis = 0; axis < 3; ++axis) {
      const double low = extent.lower[axis], high = extent.upper[axis], box = c.domain.size[axis];
      if (periodic_axes(c.domain)[axis] && !(high - low <= most_boxes_long * box))
        throw document.error(
            shape_key(c, n),
            fmt::format("the solid is {:.4g} m long along {}, {:.6g} times the periodic box of {:g} m; {}", high - low,
                        axis_name[axis], (high - low) / box, box, smaller_text(c.solids[n])));
      if (!(std::max(std::abs(low), std::abs(high)) <= most_boxes_away * box))
        throw document.error(
            shape_key(c, n),
            fmt::format("the solid extends from {:.4g} to {:.4g} m along {}, and the box from 0 to {:g} m; give it a "
                        "place and a size in m that fit the box",
                        low, high, axis_name[axis], box));
    }
  }
}

std::vector<bodies::SolidShape> solid_shapes(const Case& c) {
  const double spacing = c.domain.spacing;
  std::vector<bodies::SolidShape> shapes;
  for (const SolidCase& solid : c.solids) {
    if (solid.sphere) {
      shapes.push_back(bodies::SolidSphere{solid.sphere->centre / spacing, solid.sphere->radius / spacing});
      continue;
    }
    TriangleMesh mesh = solid.surface;
    for (Vec3& point : mesh.points) point /= spacing;
    shapes.push_back(std::move(mesh));
  }
  return shapes;
}

dem::PrescribedMotion motion_of(const SolidCase& solid) {
  return solid.motion ? prescribed_motion(*solid.motion) : dem::PrescribedMotion();
}

bool any_solid_moves(const Case& c) {
  return std::any_of(c.solids.begin(), c.solids.end(), [](const SolidCase& solid) { return motion_of(solid).moves(); });
}

std::set<double> solid_frames_every(const Case& c) {
  std::set<double> intervals;
  if (!c.grains.empty()) {
    intervals.insert(c.output.grains.every);
    for (const io::NamedGrainOutputKeys& part : c.output.grain_parts) intervals.insert(part.every);
  }
  if (has_fluid(c)) {
    intervals.insert(c.output.fluid.every);
    for (const io::NamedFluidOutputKeys& part : c.output.fluid_parts) intervals.insert(part.every);
  }
  intervals.erase(0.0);
  return intervals;
}

namespace {

void add_image(TriangleMesh& mesh, const TriangleMesh& of, const Vec3& shift) {
  const int first = static_cast<int>(mesh.points.size());
  for (const Vec3& point : of.points) mesh.points.push_back(point + shift);
  for (const std::array<int, 3>& corners : of.triangles)
    mesh.triangles.push_back({first + corners[0], first + corners[1], first + corners[2]});
}

// A surface with its middle in the box and, where it crosses a periodic face, what comes in at the other end. One as
// long as the box has no image along that axis.
TriangleMesh brought_into(const PeriodicBox& box, TriangleMesh mesh) {
  const bodies::Extent extent = bodies::extent_of(mesh);
  const Vec3 middle = 0.5 * (extent.lower + extent.upper), shift = box.wrapped_from_afar(middle) - middle;
  for (Vec3& point : mesh.points) point += shift;
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = extent.lower[axis] + shift[axis], upper = extent.upper[axis] + shift[axis];
    if (!box.periodic[axis] || upper - lower >= box.size[axis]) continue;
    const TriangleMesh one_end = mesh;
    if (lower < 0.0) add_image(mesh, one_end, box.size[axis] * Vec3::Unit(axis));
    if (upper > box.size[axis]) add_image(mesh, one_end, -box.size[axis] * Vec3::Unit(axis));
  }
  return mesh;
}

}  // namespace

std::vector<TriangleMesh> solid_surfaces(const Case& c, double time) {
  std::vector<TriangleMesh> surfaces;
  for (const SolidCase& solid : c.solids) {
    TriangleMesh surface = solid.sphere ? sphere_surface(*solid.sphere) : solid.surface;
    const dem::PrescribedMotion motion = motion_of(solid);
    for (Vec3& point : surface.points) point = motion.place(point, time);
    surfaces.push_back(motion.moves() ? brought_into(grain_box(c), std::move(surface)) : std::move(surface));
  }
  return surfaces;
}

double reach_from_axis(const SolidCase& solid) {
  const dem::PrescribedMotion motion = motion_of(solid);
  const auto from_axis = [&](const Vec3& point) { return motion.axis.cross(point - motion.centre).norm(); };
  if (solid.sphere) return from_axis(solid.sphere->centre) + solid.sphere->radius;
  double reach = 0.0;
  for (const Vec3& point : solid.surface.points) reach = std::max(reach, from_axis(point));
  return reach;
}

double largest_speed(const SolidCase& solid) {
  const dem::PrescribedMotion motion = motion_of(solid);
  return motion.largest_speed(motion.turns() ? reach_from_axis(solid) : 0.0);
}

}  // namespace thalweg::driver
