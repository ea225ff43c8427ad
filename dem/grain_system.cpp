#include "dem/grain_system.hpp"

#include "core/state/same_time_step.hpp"
#include "dem/motion/grain_volume.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace thalweg::dem {

namespace {

// The neighbour lists are checked more often than with a fluid step to respect, so that grains may be faster.
constexpr int sub_steps_between_list_checks = 10;

GrainParameters dry_parameters(const GrainSystemParameters& dry) {
  GrainParameters parameters = dry.grains;
  parameters.sub_steps = std::min(parameters.sub_steps, sub_steps_between_list_checks);
  parameters.movable_cuts = true;
  parameters.field = dry.field;
  if (dry.field) parameters.attached_width = dry.field->attached_columns();
  parameters.body_force = [gravity = dry.gravity, density = dry.fluid_density, thickness = dry.grains.disk_thickness](
                              double mass, double radius) {
    return Vec3((mass - density * grain_volume(radius, thickness)) * gravity);
  };
  return parameters;
}

}  // namespace

GrainSystem::GrainSystem(const Decomposition& decomposition, MPI_Comm communicator,
                         const GrainSystemParameters& parameters, GrainSeeds seeds)
    : field_(parameters.field),
      sub_steps_(parameters.grains.sub_steps),
      time_step_(parameters.grains.time_step * sub_steps_),
      wall_names_(parameters.measured_walls),
      rest_(parameters.rest),
      grains_(decomposition, communicator, dry_parameters(parameters), std::move(seeds)),
      lists_(timer_.phase("grain lists")),
      motion_(timer_.phase("grain motion")) {}

void GrainSystem::advance() {
  {
    const auto scope = timer_.measure(lists_);
    grains_.turn_over();
  }
  for (int done = 0; done < sub_steps_;) {
    int now = sub_steps_ - done;
    {
      const auto scope = timer_.measure(lists_);
      now = std::min(now, grains_.prepare_part());
    }
    const auto scope = timer_.measure(motion_);
    grains_.advance(now);
    grains_.refresh_ghosts();
    done += now;
  }
  ++step_;
  if (field_) field_->step_ended(grains_, time());
}

Snapshot GrainSystem::snapshot() const {
  const GrainStore& store = grains_.store();
  const std::size_t owned = store.owned;
  Snapshot snapshot;
  snapshot.time = time();
  snapshot.step = step_;
  snapshot.decomposition = &grains_.decomposition();
  snapshot.contacts = this;
  snapshot.grains.global_count = grains_.global_count();
  snapshot.grains.id_limit = grains_.id_limit();
  snapshot.grains.disk_thickness = grains_.parameters().disk_thickness;
  snapshot.grains.id = {store.id.data(), owned};
  snapshot.grains.radius = {store.radius.data(), owned};
  snapshot.grains.mass = {store.mass.data(), owned};
  snapshot.grains.position = {store.position.data(), owned};
  snapshot.grains.velocity = {store.velocity.data(), owned};
  snapshot.grains.angular_velocity = {store.angular_velocity.data(), owned};
  snapshot.grains.contact_force = {store.contact_force.data(), owned};
  snapshot.grains.contact_torque = {store.contact_torque.data(), owned};
  if (field_) {
    snapshot.grains.fluid_force = {store.load_force.data(), owned};
    snapshot.grains.fluid_torque = {store.load_torque.data(), owned};
  }
  snapshot.grains.motion = grains_.motion();
  grains_.show_clumps(snapshot.grains);
  return snapshot;
}

std::vector<Diagnostic> GrainSystem::diagnostics() const {
  std::vector<Diagnostic> diagnostics{{"contacts", "1", static_cast<double>(grains_.contact_count())},
                                      {"largest_overlap", "diameter", grains_.largest_overlap()},
                                      {largest_speed_diagnostic, "m/s", grains_.largest_free_speed()},
                                      {largest_acceleration_diagnostic, "m/s^2", grains_.largest_acceleration()}};
  if (rest_) {
    const auto restless = static_cast<double>(grains_.restless_count(rest_->speed, rest_->acceleration));
    const auto free = static_cast<double>(std::max<std::int64_t>(1, grains_.free_count()));
    diagnostics.push_back({restless_diagnostic, "1", restless});
    diagnostics.push_back({restless_share_diagnostic, "1", restless / free});
  }
  if (field_)
    for (const Diagnostic& diagnostic : field_->diagnostics(time())) diagnostics.push_back(diagnostic);
  for (const Diagnostic& diagnostic : grains_.turnover_diagnostics()) diagnostics.push_back(diagnostic);
  if (wall_names_.empty() && grains_.parameters().solids.empty()) return diagnostics;
  const std::vector<Vec3> forces = grains_.wall_forces();
  for (std::size_t wall = 0; wall < wall_names_.size(); ++wall)
    add_vector("wall_force_" + wall_names_[wall], "N", forces[wall], diagnostics);
  for (std::size_t solid = 0; solid < grains_.parameters().solids.size(); ++solid)
    add_vector(solid_force_diagnostic(solid), "N", forces[grains_.walls().size() + solid], diagnostics);
  return diagnostics;
}

std::optional<Location> GrainSystem::location_of(const std::string& diagnostic) const {
  if (diagnostic == "largest_overlap") return grains_.place_of_deepest_overlap();
  if (diagnostic == largest_speed_diagnostic) return grains_.place_of_fastest();
  return std::nullopt;
}

void GrainSystem::save(ArchiveWriter& archive) const {
  archive.attribute("system/step", step_);
  archive.attribute("system/time_step", time_step_);
  if (field_) field_->save(archive);
  grains_.save(archive);
}

void GrainSystem::load(ArchiveReader& archive) {
  require_same_time_step(archive, time_step_, sub_steps_);
  step_ = archive.integer_attribute("system/step");
  if (field_) field_->load(archive);
  grains_.load(archive);
}

// Whatever a fluid did to them is over.
void GrainSystem::import_grains(ArchiveReader& archive, double /*spacing*/) {
  grains_.take(archive, "grains", false);
  GrainStore& store = grains_.store();
  std::fill(store.load_force.begin(), store.load_force.end(), Vec3::Zero());
  std::fill(store.load_torque.begin(), store.load_torque.end(), Vec3::Zero());
}

}  // namespace thalweg::dem
