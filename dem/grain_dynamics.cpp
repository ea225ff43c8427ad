#include "dem/grain_dynamics.hpp"

#include "dem/contact/contact_forces.hpp"
#include "dem/motion/grain_volume.hpp"

namespace thalweg::dem {

void GrainDynamics::compute_body_forces() {
  kept_body_force_.clear();
  if (kept_strength_ != strength_) compute_body_forces(kept_strength_, kept_body_force_);
  compute_body_forces(strength_, body_force_);
}

void GrainDynamics::compute_body_forces(const BodyForceStrength& strength, std::vector<Vec3>& forces) {
  const auto force = [&](double mass, double radius) -> Vec3 {
    const Vec3 on_volume = grain_volume(radius, parameters_.disk_thickness) * strength.density;
    if (!parameters_.body_force) return on_volume;
    return strength.factor * parameters_.body_force(mass, radius) + on_volume;
  };
  forces.assign(store_.owned, Vec3::Zero());
  for (std::size_t s = 0; s < store_.owned; ++s)
    if (store_.clump[s] < 0) forces[s] = force(store_.mass[s], store_.radius[s]);
  clumps_.compute_body_forces(force);
  clumps_.share_body_force(forces);
}

void GrainDynamics::set_body_force_factor(double factor) {
  if (factor == strength_.factor) return;
  strength_.factor = factor;
  compute_body_forces();
}

void GrainDynamics::set_force_density(const Vec3& density) {
  if (density == strength_.density) return;
  strength_.density = density;
  compute_body_forces();
}

void GrainDynamics::keep_body_force() {
  kept_strength_ = strength_;
  kept_body_force_.clear();
}

void GrainDynamics::evaluate_forces(double time_step) {
  const auto scope = timer_.measure(forces_phase_);
  evaluate_contacts(moving_, list_, surroundings(), materials_, store_.material, time_step);
  if (parameters_.lubrication)
    add_lubrication(moving_, list_, surroundings(),
                    clump_count_ > 0 ? std::span<const GlobalId>(store_.clump) : std::span<const GlobalId>(),
                    *parameters_.lubrication);
  if (parameters_.field) parameters_.field->act(moving_, store_, clumps_, body_force_);
  if (rough_floor_) hold_on_rough_floor();
}

void GrainDynamics::hold_on_rough_floor() {
  for_each_held([this](std::size_t s) { return touches_rough_floor(moving_[s].position[2], moving_[s].position[3]); },
                [this](std::size_t s) { moving_.stop_along_floor(s); },
                [this](std::size_t n) { clumps_.stop_along_floor(n, moving_); });
}

void GrainDynamics::place_walls(double time, double time_of_velocity) {
  for (std::size_t w = 0; w < planes_.size(); ++w)
    if (parameters_.walls[w].changes()) planes_[w] = parameters_.walls[w].at(time, time_of_velocity);
}

void GrainDynamics::place_solids(double time, double time_of_velocity) {
  solids_.clear();
  for (const Solid& solid : parameters_.solids) solids_.emplace_back(solid, time, time_of_velocity);
}

void GrainDynamics::place_prescribed(double time, double time_of_velocity) {
  if (walls_change_) place_walls(time, time_of_velocity);
  if (solids_change_) place_solids(time, time_of_velocity);
  assemblies_.place(moving_, box_, time, time_of_velocity);
}

void GrainDynamics::advance(int sub_steps) {
  if (sub_steps < 1) return;
  {
    const auto scope = timer_.measure(motion_phase_);
    moving_.gather_from(store_, body_force_);
    clumps_.gather_loads(store_);
  }
  advance_by_verlet(sub_steps);
  const auto scope = timer_.measure(motion_phase_);
  moving_.scatter_to(store_);
}

void GrainDynamics::keep_acting_state() {
  acting_.grains.resize(moving_.size());
  for (std::size_t s = 0; s < moving_.size(); ++s)
    acting_.grains[s] = {vector_of(moving_[s].velocity), vector_of(moving_[s].spin)};
  acting_.walls = planes_;
  acting_.solids = solids_;
}

template <typename Work>
void GrainDynamics::timed(int phase, Work&& work) {
  const auto scope = timer_.measure(phase);
  work();
}

void GrainDynamics::advance_by_verlet(int sub_steps) {
  const double dt = parameters_.time_step;
  const auto drift_clumps = [&] {
    clumps_.drift(dt);
    clumps_.place(moving_, box_);
  };
  timed(motion_phase_, [&] {
    clumps_.half_kicks(moving_, dt, 1);  // before the others, whose drift forgets the forces
    moving_.half_kick(dt);
    moving_.drift(dt);
    drift_clumps();
  });
  for (int s = 0;; ++s) {
    ++steps_done_;
    // Forces see velocities of the middle of the step, so those of what is prescribed are taken there as well.
    place_prescribed(time(), time() - 0.5 * dt);
    timed(messages_phase_, [&] { ghosts_.refresh(moving_); });
    list_.grains_moved(dt * moving_.speed_bound(!clumps_.empty() || !parameters_.assemblies.empty()));
    if (s + 1 == sub_steps) timed(motion_phase_, [&] { keep_acting_state(); });
    evaluate_forces(dt);
    if (s + 1 == sub_steps) break;
    timed(motion_phase_, [&] {
      clumps_.half_kicks(moving_, dt, 2);
      moving_.two_half_kicks_and_drift(dt);
      drift_clumps();
    });
  }
  timed(motion_phase_, [&] {
    clumps_.half_kicks(moving_, dt, 1);
    moving_.half_kick(dt);
    clumps_.place(moving_, box_);
  });
  place_prescribed(time(), time());
}

void GrainDynamics::refresh_ghosts() {
  wrap_positions();
  const auto scope = timer_.measure(messages_phase_);
  ghosts_.refresh(store_);
}

void GrainDynamics::refresh_ghost_attached(std::size_t first, std::size_t count) {
  ghosts_.refresh_attached(store_, first, count);
}

}  // namespace thalweg::dem
