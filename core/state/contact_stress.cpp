#include "core/state/contact_stress.hpp"

#include <map>
#include <numbers>
#include <utility>

namespace thalweg {

namespace {

// Moments of the forces that one of the source's loops visits.
std::vector<Mat3> moments_of(const Snapshot& snapshot,
                             void (ContactSource::*for_each)(const ContactSource::ContactVisitor&) const) {
  std::vector<Mat3> moments(snapshot.grains.id.size(), Mat3::Zero());
  if (snapshot.contacts)
    (snapshot.contacts->*for_each)(
        [&](std::size_t grain, const Vec3& arm, const Vec3& force) { moments[grain] += force * arm.transpose(); });
  return moments;
}

}  // namespace

std::vector<Mat3> contact_moments(const Snapshot& snapshot) {
  return moments_of(snapshot, &ContactSource::for_each_contact);
}

std::vector<Mat3> lubrication_moments(const Snapshot& snapshot) {
  return moments_of(snapshot, &ContactSource::for_each_lubrication);
}

std::vector<Mat3> contact_stresses(const Snapshot& snapshot) {
  const GrainView& grains = snapshot.grains;
  std::vector<Mat3> stresses = contact_moments(snapshot);
  std::map<GlobalId, Mat3> of_clump;
  for (std::size_t i = 0; i < stresses.size(); ++i) {
    if (grains.is_member(i)) {
      of_clump.try_emplace(grains.clump[i], Mat3::Zero()).first->second += stresses[i];
      continue;
    }
    const double r = grains.radius[i], thickness = grains.disk_thickness;
    stresses[i] /= std::numbers::pi * r * r * (thickness > 0.0 ? thickness : 4.0 / 3.0 * r);
  }
  for (const ClumpState& clump : grains.clumps) of_clump.at(clump.id) /= clump.volume;
  for (std::size_t i = 0; i < stresses.size(); ++i)
    if (grains.is_member(i)) stresses[i] = of_clump.at(grains.clump[i]);
  return stresses;
}

}  // namespace thalweg
