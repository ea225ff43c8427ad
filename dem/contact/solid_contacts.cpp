#include "dem/contact/solid_contacts.hpp"

#include "core/base/error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace thalweg::dem {

namespace {

constexpr double same_corner = 1e-6;  // radii, by which corners at one place may differ

// The position of a grain, wrapped or not, at the end of the box where it was when the list was made.
Vec3 unwrapped(const Vec3& position, const Vec3& listed, const PeriodicBox& box) {
  Vec3 at = position;
  for (int axis = 0; axis < 3; ++axis)
    if (box.periodic[axis]) at[axis] += box.size[axis] * std::round((listed[axis] - at[axis]) / box.size[axis]);
  return at;
}

}  // namespace

SolidDepth depth_in_solids(const Vec3& position, double radius, const PeriodicBox& box,
                           std::span<const PlacedSolid> solids, std::span<const Solid> shapes) {
  SolidDepth deepest{-std::numeric_limits<double>::infinity(), -1};
  std::vector<SurfaceView> views;
  for (std::size_t n = 0; n < solids.size(); ++n)
    for_each_image(solids[n], box, position, radius, [&](const Vec3& shift) {
      const SolidSurface& surface = *shapes[n].surface;
      const Vec3 at = solids[n].in_solid(position - shift);
      views.clear();
      surface.look(surface.parts_near(at, radius), at, radius, views);
      double depth = -std::numeric_limits<double>::infinity();
      for (const SurfaceView& view : views) depth = std::max(depth, radius - view.distance);
      if (surface.holds(at)) depth = std::numeric_limits<double>::infinity();
      if (depth > deepest.depth) deepest = {depth, static_cast<int>(n)};
    });
  return deepest;
}

void check(std::span<const GrainSeed> grains, std::span<const Solid> solids, const PeriodicBox& box,
           double allowed_overlap) {
  std::vector<PlacedSolid> placed;
  for (const Solid& solid : solids) placed.emplace_back(solid, 0.0, 0.0);
  for (const GrainSeed& grain : grains) {
    if (is_fixed(grain.motion)) continue;
    const SolidDepth in = depth_in_solids(grain.position, grain.radius, box, placed, solids);
    if (in.depth <= allowed_overlap * 2.0 * grain.radius) continue;
    const Vec3& x = grain.position;
    throw InputError(fmt::format(
        "Grain {} at ({:g}, {:g}, {:g}) m with radius {:g} m {}; move it away, or place grains with pattern: random, "
        "which keeps clear of solids.",
        grain.id, x[0], x[1], x[2], grain.radius,
        std::isfinite(in.depth) ? fmt::format("reaches {:g} m into solid {}", in.depth, in.solid)
                                : fmt::format("is inside solid {}", in.solid)));
  }
}

std::vector<NearSolid> find_near_solids(const GrainStore& store, const PeriodicBox& box,
                                        std::span<const PlacedSolid> solids, std::span<const Solid> shapes,
                                        double range) {
  std::vector<NearSolid> near;
  for (std::size_t s = 0; s < store.owned; ++s)
    for (std::size_t n = solids.size(); n-- > 0;) {
      NearSolid found{static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(n), store.position[s], {}};
      const double reach = store.radius[s] + range;
      for_each_image(solids[n], box, store.position[s], reach, [&](const Vec3& shift) {
        SolidSurface::Parts parts = shapes[n].surface->parts_near(solids[n].in_solid(store.position[s] - shift), reach);
        if (!parts.empty()) found.images.push_back({shift, std::move(parts)});
      });
      if (!found.images.empty()) near.push_back(std::move(found));
    }
  return near;
}

bool SolidTouches::is_deep(std::span<const NearSolid> near, std::size_t first, std::size_t last, const Vec3& position,
                           double radius) {
  look(near, first, last, position, radius, radius);
  if (!touches_.empty()) return touches_.front().view.distance < 0.5 * radius;
  // Near a surface that does not see it, it is behind it.
  for (std::size_t n = first; n < last; ++n) {
    const SolidSurface& surface = *shapes_[near[n].solid].surface;
    const Vec3 at = unwrapped(position, near[n].listed, box_);
    for (const NearSolid::Image& image : near[n].images) {
      const Vec3 in_solid = solids_[near[n].solid].in_solid(at - image.shift);
      if (surface.distance_to(image.parts, in_solid) < radius && surface.holds(in_solid)) return true;
    }
  }
  return false;
}

void SolidTouches::look(std::span<const NearSolid> near, std::size_t first, std::size_t last, const Vec3& position,
                        double radius, double distance) {
  views_.clear();
  touches_.clear();
  taken_.resize((last - first) * touches_per_solid);
  for (std::size_t n = first; n < last; ++n) {
    const PlacedSolid& solid = solids_[near[n].solid];
    const Vec3 at = unwrapped(position, near[n].listed, box_);
    for (const NearSolid::Image& image : near[n].images) {
      of_image_.clear();
      shapes_[near[n].solid].surface->look(image.parts, solid.in_solid(at - image.shift), distance, of_image_);
      for (SurfaceView& view : of_image_) {
        view.normal = solid.turned_in_space(view.normal);
        view.foot = solid.in_space(view.foot);  // of the solid itself, whose velocity all images have
        for (int c = 0; c < view.corners; ++c) view.corner[c] = solid.in_space(view.corner[c]) + image.shift;
        view.owner = static_cast<std::uint32_t>(n);
        views_.push_back(view);
      }
    }
  }
  keep_contacts(views_, same_corner * radius);
  for (const SurfaceView& view : views_) {
    const auto is_of_entry = [&](const SolidTouch& touch) { return touch.near == view.owner; };
    const auto of_entry = std::count_if(touches_.begin(), touches_.end(), is_of_entry);
    if (static_cast<std::size_t>(of_entry) == touches_per_solid) continue;
    const NearSolid& of = near[view.owner];
    const double rounding = shapes_[of.solid].surface->rounding();
    touches_.push_back({view.owner,
                        0,
                        false,
                        {view.distance, view.normal},
                        solids_[of.solid].velocity_at(view.foot),
                        solids_[of.solid].spin(),
                        rounding > 0.0 ? radius * rounding / (radius + rounding) : radius});
  }
}

}  // namespace thalweg::dem
