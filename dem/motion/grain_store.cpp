#include "dem/motion/grain_store.hpp"

namespace thalweg::dem {

template <typename Visitor>
void GrainStore::for_each_column(Visitor&& visit) {
  visit(id), visit(radius), visit(mass), visit(inertia), visit(inverse_mass), visit(inverse_inertia), visit(motion);
  visit(material), visit(clump), visit(offset);
  visit(position), visit(velocity), visit(angular_velocity);
  visit(contact_force), visit(contact_torque), visit(load_force), visit(load_torque);
}

void GrainStore::clear() {
  owned = 0;
  drop_ghosts();
}

void GrainStore::reserve(std::size_t grains) {
  for_each_column([grains](auto& column) { column.reserve(grains); });
  attached.reserve(grains * attached_width);
}

void GrainStore::append(GlobalId grain, double grain_radius, double grain_mass, Motion grain_motion,
                        const Vec3& grain_position, int grain_material) {
  id.push_back(grain);
  radius.push_back(grain_radius);
  mass.push_back(grain_mass);
  inertia.push_back(shape * grain_mass * grain_radius * grain_radius);
  inverse_mass.push_back(holds_translation(grain_motion) || is_member(grain_motion) ? 0.0 : 1.0 / grain_mass);
  inverse_inertia.push_back(holds_rotation(grain_motion) || is_member(grain_motion) ? 0.0 : 1.0 / inertia.back());
  motion.push_back(grain_motion);
  material.push_back(static_cast<std::uint8_t>(grain_material));
  clump.push_back(-1);
  offset.push_back(Vec3::Zero());
  position.push_back(grain_position);
  for (auto* column : {&velocity, &angular_velocity, &contact_force, &contact_torque, &load_force, &load_torque})
    column->push_back(Vec3::Zero());
  attached.resize(attached.size() + attached_width, 0.0);
}

void GrainStore::drop_ghosts() {
  const std::size_t kept = owned;
  for_each_column(
      [kept](auto& column) { column.erase(column.begin() + static_cast<std::ptrdiff_t>(kept), column.end()); });
  attached.resize(kept * attached_width);
}

}  // namespace thalweg::dem
