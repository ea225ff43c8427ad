// Contacts of grains with solids (solid.hpp): which grains are near which parts of which surfaces until the list is
// made anew, and what a grain touches of them at a moment.
//
// A grain may touch a solid in several places at once, at most `touches_per_solid`, each with a history of its own. A
// place has no name: it wanders over triangles, edges and corners as the grain rolls. So a contact keeps the normal of
// its last evaluation among its history, and in the next one its history goes on at the place whose normal is nearest.
#pragma once

#include "core/geometry/periodic_box.hpp"
#include "dem/contact/solid.hpp"
#include "dem/motion/grain_seed.hpp"
#include "dem/motion/grain_store.hpp"
#include "dem/motion/walls.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::dem {

inline constexpr std::size_t touches_per_solid = 8;

// A grain and a solid that is near.
struct NearSolid {
  // An image of the solid on the periodic axes.
  struct Image {
    Vec3 shift;  // m, of the image from the solid
    SolidSurface::Parts parts;
  };
  std::uint32_t grain, solid;  // slot; number
  Vec3 listed;                 // m, of the grain when the list was made
  std::vector<Image> images;
};

// Depth (m) of a sphere in the solids, and the number of the solid. Depth is the radius less the distance of the
// centre from the nearest surface, infinite if the centre is inside, negative if the sphere is clear. Number -1: none
// is near.
struct SolidDepth {
  double depth;  // m
  int solid;
};
SolidDepth depth_in_solids(const Vec3& position, double radius, const PeriodicBox& box,
                           std::span<const PlacedSolid> solids, std::span<const Solid> shapes);

// Throws InputError where a grain that can move is inside a solid at the start, or reaches into it by more than this
// (in diameters).
void check(std::span<const GrainSeed> grains, std::span<const Solid> solids, const PeriodicBox& box,
           double allowed_overlap);

// All owned grains with solids whose surface is closer than `range` (m) to theirs, sorted by id, then from the last
// solid to the first.
std::vector<NearSolid> find_near_solids(const GrainStore& store, const PeriodicBox& box,
                                        std::span<const PlacedSolid> solids, std::span<const Solid> shapes,
                                        double range);

// A place in which a grain touches a solid, or is within the range of their law.
struct SolidTouch {
  std::size_t near;  // number of its NearSolid
  std::size_t row;   // 0 .. touches_per_solid - 1: which of the histories of the grain and the solid is its
  bool goes_on;      // true if that history is its own from the last evaluation, not that of another touch
  WallView view;
  Vec3 velocity;            // m/s, of the solid there
  Vec3 spin;                // rad/s, of the solid
  double effective_radius;  // m, R1 R2/(R1 + R2)
};

class SolidTouches {
public:
  SolidTouches(const PeriodicBox& box, std::span<const PlacedSolid> solids, std::span<const Solid> shapes)
      : box_(box), solids_(solids), shapes_(shapes) {}

  // Calls visit(first, last) for the entries of the list from first to last - 1 that are of one grain.
  template <typename Visit>
  static void for_each_grain(std::span<const NearSolid> near, Visit visit) {
    for (std::size_t first = 0, last = 0; first < near.size(); first = last) {
      while (last < near.size() && near[last].grain == near[first].grain) ++last;
      visit(first, last);
    }
  }

  // Touches of a grain at a position (m), with its radius and the range of the law (m), with its own entries.
  // normal_of(number of the entry, row): normal at the last evaluation; zero if the row has no history.
  template <typename NormalOf>
  std::span<const SolidTouch> of(std::span<const NearSolid> near, std::size_t first, std::size_t last,
                                 const Vec3& position, double radius, double range, NormalOf normal_of) {
    look(near, first, last, position, radius, radius + range);
    match(first, normal_of);
    return touches_;
  }
  // True if a row of an entry was given to one of these touches.
  bool taken(std::size_t first, std::size_t number, std::size_t row) const {
    return taken_[(number - first) * touches_per_solid + row] != 0;
  }

  // True if such a grain is inside one of these solids, or at least half its radius deep in one.
  bool is_deep(std::span<const NearSolid> near, std::size_t first, std::size_t last, const Vec3& position,
               double radius);

private:
  void look(std::span<const NearSolid> near, std::size_t first, std::size_t last, const Vec3& position, double radius,
            double distance);

  // First every touch takes the row whose normal is nearest, if one is near enough, then any that is left.
  template <typename NormalOf>
  void match(std::size_t first, NormalOf normal_of) {
    std::fill(taken_.begin(), taken_.end(), 0);
    const auto taken = [&](const SolidTouch& touch, std::size_t row) -> char& {
      return taken_[(touch.near - first) * touches_per_solid + row];
    };
    for (SolidTouch& touch : touches_) {
      double nearest = same_place;
      for (std::size_t row = 0; row < touches_per_solid; ++row) {
        const double cosine = normal_of(touch.near, row).dot(touch.view.normal);
        if (taken(touch, row) || !(cosine > nearest)) continue;
        touch.row = row;
        touch.goes_on = true;
        nearest = cosine;
      }
      if (touch.goes_on) taken(touch, touch.row) = 1;
    }
    for (SolidTouch& touch : touches_) {
      if (touch.goes_on) continue;
      for (touch.row = 0; taken(touch, touch.row); ++touch.row) {
      }
      taken(touch, touch.row) = 1;
    }
  }

  static constexpr double same_place = 0.7;  // cosine, of 45 degrees

  PeriodicBox box_;
  std::span<const PlacedSolid> solids_;
  std::span<const Solid> shapes_;
  std::vector<SurfaceView> views_, of_image_;
  std::vector<SolidTouch> touches_;
  std::vector<char> taken_;
};

}  // namespace thalweg::dem
