// The cells of the fluid that an output shows: the whole box, a box in it, or a layer, all of them or every n-th.
#pragma once

#include "core/base/types.hpp"
#include "core/keys/section_visitor.hpp"
#include "core/parallel/decomposition.hpp"
#include "io/text/box_keys.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace thalweg::io {

enum class FluidRegion { whole, slice_x, slice_y, slice_z };  // a slice: the middle layer of cells across that axis

enum class Axis { x, y, z };

// The layer of cells across an axis that the plane lies in.
struct FluidPlaneKeys {
  Axis axis = Axis::z;
  double at = 0.0;  // m
  bool operator==(const FluidPlaneKeys&) const = default;
};

struct FluidRegionKeys {
  FluidRegion region = FluidRegion::whole;
  std::optional<BoxKeys> box;           // in its place: the cells with their centre in it
  std::optional<FluidPlaneKeys> plane;  // in its place
  std::int64_t stride = 1;              // every n-th cell along each axis along which there are several
  bool operator==(const FluidRegionKeys&) const = default;
};
void describe_region(SectionVisitor& visit, FluidRegionKeys& keys);

// Throws KeyError where a plane or box lies outside a domain of this size (m), or shows no cell. spacing: m.
void check(const FluidRegionKeys& keys, const Vec3& box_size, double spacing);

// The cells shown, in a coarser lattice of which a cell is stride cells wide and has the first of them in its middle.
struct ShownCells {
  Block region;         // from which they are taken; in global coordinates
  Index3 stride;        // cells
  Block coarse;         // of the coarser lattice
  Vec3 origin;          // m, of the coarser lattice
  Vec3 coarse_spacing;  // m

  // The coarse cells that stand for cells of this block.
  Block part_in(const Block& block) const;
};
// cells: of the domain; spacing: m.
ShownCells shown_cells(const FluidRegionKeys& keys, const Index3& cells, double spacing);

}  // namespace thalweg::io
