// Solids that grains meet: surfaces that stand still, or move as a given function of time (prescribed_motion.hpp). SI
// units.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/periodic_box.hpp"
#include "dem/contact/solid_surface.hpp"
#include "dem/motion/prescribed_motion.hpp"

#include <cmath>
#include <memory>

namespace thalweg::dem {

struct Solid {
  std::shared_ptr<const SolidSurface> surface;
  double friction = 0.0;          // against grains
  double rolling_friction = 0.0;  // against grains
  PrescribedMotion motion;
};

// Throws InputError where there is no surface, a friction is negative or the motion is impossible.
void check(const Solid& solid);

// A solid where it is at one time, with the velocity of another.
class PlacedSolid {
public:
  PlacedSolid(const Solid& solid, double time, double time_of_velocity);  // s

  Vec3 in_solid(const Vec3& point) const;  // m, from where it is to where the surface was at the start
  Vec3 in_space(const Vec3& point) const;  // m, the other way
  Vec3 turned_in_space(const Vec3& direction) const { return turns_ ? Vec3(turn_ * direction) : direction; }
  Vec3 velocity_at(const Vec3& point) const {  // m/s, of the solid at a point in space
    return turns_ ? Vec3(velocity_ + spin_.cross(point - centre_)) : velocity_;
  }
  const Vec3& spin() const { return spin_; }  // rad/s
  // Bounds (m) of its coordinates, widened if it turns.
  const Vec3& lower() const { return lower_; }
  const Vec3& upper() const { return upper_; }
  // No point of the surface has moved by more than this from one place to the other, m.
  double moved_since(const PlacedSolid& earlier) const;

private:
  bool turns_;
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();
  double angle_ = 0.0;    // rad
  Vec3 pivot_, centre_;   // m, a point of the axis: at the start, and now
  Vec3 velocity_, spin_;  // m/s, of that point; rad/s
  double reach_ = 0.0;    // m, of the surface from the axis' point
  Vec3 lower_, upper_;
};

// m/s, that no point of the surface exceeds.
double largest_speed_of(const Solid& solid);

// Calls visit(shift) for every image of a solid on the periodic axes that is within a distance (m) of a point, in
// order: the image is the solid moved by shift (m).
template <typename Visit>
void for_each_image(const PlacedSolid& solid, const PeriodicBox& box, const Vec3& point, double distance, Visit visit) {
  int first[3] = {0, 0, 0}, last[3] = {0, 0, 0};
  for (int a = 0; a < 3; ++a) {
    if (box.periodic[a]) {
      first[a] = static_cast<int>(std::ceil((point[a] - distance - solid.upper()[a]) / box.size[a]));
      last[a] = static_cast<int>(std::floor((point[a] + distance - solid.lower()[a]) / box.size[a]));
    } else if (point[a] + distance < solid.lower()[a] || point[a] - distance > solid.upper()[a]) {
      return;
    }
  }
  for (int k = first[2]; k <= last[2]; ++k)
    for (int j = first[1]; j <= last[1]; ++j)
      for (int i = first[0]; i <= last[0]; ++i) visit(Vec3(i * box.size[0], j * box.size[1], k * box.size[2]));
}

}  // namespace thalweg::dem
