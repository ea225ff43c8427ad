#include "io/vtk/fluid_region.hpp"

#include "core/geometry/layer_at.hpp"
#include "core/geometry/periodic_box.hpp"
#include "core/keys/key_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

// Functions named describe are static rather than in an unnamed namespace, where argument-dependent lookup from the
// visitor's templates would not find them.
namespace thalweg::io {

static void describe(SectionVisitor& visit, FluidPlaneKeys& plane) {
  visit.choice<Axis>("axis", plane.axis, {{Axis::x, "x"}, {Axis::y, "y"}, {Axis::z, "z"}},
                     {.meaning = "across the plane", .required = true});
  visit.real(
      "at", plane.at,
      {.unit = "m", .meaning = "along the axis; its layer of cells is shown", .required = true, .example = 0.01});
}

void describe_region(SectionVisitor& visit, FluidRegionKeys& keys) {
  visit.choice<FluidRegion>("region", keys.region,
                            {{FluidRegion::whole, "whole"},
                             {FluidRegion::slice_x, "slice_x"},
                             {FluidRegion::slice_y, "slice_y"},
                             {FluidRegion::slice_z, "slice_z"}},
                            {.meaning = "the whole box, or the middle layer of cells across an axis"});
  visit.section("box", keys.box, {.meaning = "the cells whose centre is in it, in place of a region"});
  visit.section("plane", keys.plane, {.meaning = "a layer of cells, in place of a region"});
  visit.integer("stride", keys.stride, {.meaning = "shows every n-th cell along each axis", .at_least = 1});
  const int ways = (keys.region != FluidRegion::whole) + keys.box.has_value() + keys.plane.has_value();
  visit.require(ways <= 1, keys.box ? "box" : "plane", "give only one of region, box and plane");
}

namespace {

int axis_of(FluidRegion slice) { return slice == FluidRegion::slice_x ? 0 : slice == FluidRegion::slice_y ? 1 : 2; }

Block layer(const Index3& cells, int axis, int number) {
  Block block{{0, 0, 0}, cells};
  block.lower[axis] = number;
  block.upper[axis] = number + 1;
  return block;
}

// A centre on a corner of the box counts as inside in spite of rounding.
constexpr double rounding = 1e-9;  // cells

Block block_of(const FluidRegionKeys& keys, const Index3& cells, double spacing) {
  if (keys.plane) {
    const int axis = static_cast<int>(keys.plane->axis);
    return layer(cells, axis, std::clamp(layer_at(keys.plane->at, spacing), 0, cells[axis] - 1));
  }
  if (keys.box) {
    Block block;
    for (int axis = 0; axis < 3; ++axis) {
      const double most = cells[axis], from = std::ceil(keys.box->lower[axis] / spacing - 0.5 - rounding);
      const double to = std::floor(keys.box->upper[axis] / spacing - 0.5 + rounding) + 1.0;
      block.lower[axis] = static_cast<int>(std::clamp(from, 0.0, most));
      block.upper[axis] = static_cast<int>(std::clamp(to, 0.0, most));
    }
    return block;
  }
  if (keys.region == FluidRegion::whole) return {{0, 0, 0}, cells};
  const int axis = axis_of(keys.region);
  return layer(cells, axis, cells[axis] / 2);
}

int divided_up(int number, int by) { return (number + by - 1) / by; }

}  // namespace

void check(const FluidRegionKeys& keys, const Vec3& box_size, double spacing) {
  if (keys.plane) {
    const int axis = static_cast<int>(keys.plane->axis);
    if (!(keys.plane->at >= 0.0 && keys.plane->at <= (1.0 + whole_number_tolerance) * box_size[axis]))
      throw KeyError("plane.at", fmt::format("the plane is outside the domain; give a place in m between 0 and {:g}",
                                             box_size[axis]));
  }
  if (!keys.box) return;
  check_in_domain(*keys.box, box_size);
  Index3 cells;
  for (int axis = 0; axis < 3; ++axis) cells[axis] = static_cast<int>(std::lround(box_size[axis] / spacing));
  for (const int n : block_of(keys, cells, spacing).size())
    if (n < 1)
      throw KeyError("box", fmt::format("no cell has its centre in the box; give corners that are at least one spacing "
                                        "of {:g} m apart along every axis",
                                        spacing));
}

ShownCells shown_cells(const FluidRegionKeys& keys, const Index3& cells, double spacing) {
  ShownCells shown;
  shown.region = block_of(keys, cells, spacing);
  const Index3 size = shown.region.size();
  for (int axis = 0; axis < 3; ++axis) {
    const int stride = static_cast<int>(std::min<std::int64_t>(keys.stride, size[axis])),
              first = shown.region.lower[axis];
    shown.stride[axis] = stride;
    const int lower = first / stride;  // in strides
    shown.coarse.lower[axis] = lower;
    shown.coarse.upper[axis] = lower + divided_up(size[axis], stride);
    shown.coarse_spacing[axis] = stride * spacing;
    shown.origin[axis] = spacing * (first + 0.5 - stride * (lower + 0.5));
  }
  return shown;
}

Block ShownCells::part_in(const Block& block) const {
  const Block fine = intersection(block, region);
  if (fine.volume() == 0) return {};
  Block part;
  for (int axis = 0; axis < 3; ++axis) {
    part.lower[axis] = coarse.lower[axis] + divided_up(fine.lower[axis] - region.lower[axis], stride[axis]);
    part.upper[axis] = coarse.lower[axis] + divided_up(fine.upper[axis] - region.lower[axis], stride[axis]);
  }
  return part;
}

}  // namespace thalweg::io
