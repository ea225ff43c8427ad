#include "dem/rolling_pass.hpp"

#include "dem/contact_motion.hpp"
#include "dem/hertz_mindlin.hpp"
#include "dem/rolling_friction.hpp"
#include "dem/spring_dashpot.hpp"

#include <algorithm>

namespace thalweg::dem {

namespace {

template <typename ContactLaw>
Vec3 moment_on_first(const ContactLaw& law, const ContactMotion& motion, const ContactCoefficients& coefficients,
                     double damping, double damping_ratio, const Vec3& spin, RollingContact& rolling) {
  const double normal = law(motion, coefficients, damping, {}).normal;
  const RollingMoment m = rolling_moment(
      motion, spin[0], spin[1], spin[2], normal, law.normal_spring(motion, coefficients),
      {rolling.friction, damping_ratio, rolling.inertia}, {rolling.spring[0], rolling.spring[1], rolling.spring[2]});
  rolling.spring[0] = m.spring.x, rolling.spring[1] = m.spring.y, rolling.spring[2] = m.spring.z;
  return {m.x, m.y, m.z};
}

template <typename ContactLaw>
void evaluate_with(const ContactLaw& law, MovingGrains& grains, ContactList& list, const PeriodicBox& box,
                   std::span<const Plane> walls, const MaterialTable& materials,
                   std::span<const std::uint8_t> material) {
  for (std::size_t p = 0; p < list.rolling_pairs.size(); ++p) {
    const PairContact& c = list.pairs[p];
    MovingGrain &first = grains[c.first], &second = grains[c.second];
    const Vec3 separation = box.difference(vector_of(first.position), vector_of(second.position));
    const ContactMotion motion = motion_of(body_of(first), body_of(second), separation);
    RollingContact& rolling = list.rolling_pairs[p];
    if (!(motion.overlap > 0.0)) {
      std::fill_n(rolling.spring, 3, 0.0);
      continue;
    }
    const Row moment =
        row_of(moment_on_first(law, motion, materials.pair(material[c.first], material[c.second]).coefficients,
                               c.damping, materials.rolling_damping(), vector_of(first.spin - second.spin), rolling));
    first.torque += moment;
    second.torque -= moment;
  }
  for (std::size_t w = 0; w < list.rolling_walls.size(); ++w) {
    const WallContact& c = list.walls[w];
    MovingGrain& grain = grains[c.grain];
    const ContactMotion motion = motion_of(body_of(grain), walls[c.wall], vector_of(grain.position));
    RollingContact& rolling = list.rolling_walls[w];
    if (!(motion.overlap > 0.0)) {
      std::fill_n(rolling.spring, 3, 0.0);
      continue;
    }
    grain.torque += row_of(moment_on_first(law, motion, materials.wall(material[c.grain]).coefficients, c.damping,
                                           materials.rolling_damping(), vector_of(grain.spin), rolling));
  }
}

}  // namespace

void evaluate_rolling(MovingGrains& grains, ContactList& list, const PeriodicBox& box, std::span<const Plane> walls,
                      const MaterialTable& materials, std::span<const std::uint8_t> material, double time_step) {
  if (list.rolling_pairs.empty() && list.rolling_walls.empty()) return;
  const ContactManner manner = materials.manner(time_step);
  if (materials.law() == Law::linear)
    evaluate_with(SpringDashpotFriction(manner), grains, list, box, walls, materials, material);
  else
    evaluate_with(HertzMindlin(manner), grains, list, box, walls, materials, material);
}

}  // namespace thalweg::dem
