// Sums of the stress balance and their state; what they come to is in stress_profiles.cpp.
#include "analysis/observers/stress_balance.hpp"

#include "analysis/tools/sphere_in_layer.hpp"
#include "core/base/check.hpp"
#include "core/geometry/symmetric_pairs.hpp"
#include "core/state/contact_stress.hpp"
#include "core/state/whole_dataset.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>

namespace thalweg::analysis {

// The grains as the sums take them; the members of a clump all have what the clump has.
class BalancedBodies {
public:
  struct Body {
    double spheres = 0.0;                           // m^3, of all that share what follows: one, or the members
    double volume = 0.0, mass = 0.0, radius = 0.0;  // m^3, kg, m, of the sphere of the volume
    Vec3 velocity = Vec3::Zero();                   // m/s, of the centre
    double lowest = std::numeric_limits<double>::infinity();                            // m, height of its lowest point
    Vec3 by_fluid = Vec3::Zero(), by_contacts = Vec3::Zero();                           // N
    Mat3 contacts = Mat3::Zero(), of_fluid = Mat3::Zero(), lubrication = Mat3::Zero();  // N m, about the centre
  };

  explicit BalancedBodies(const Snapshot& snapshot)
      : grains_(snapshot.grains), contacts_(contact_moments(snapshot)), lubrication_(lubrication_moments(snapshot)) {
    CHECK(grains_.fluid_stress.size() == grains_.id.size());  // needs_grain_stress()
    std::map<GlobalId, Vec3> centres;
    for (const ClumpState& state : grains_.clumps) {
      Body& clump = clumps_[state.id];
      clump.volume = state.volume;
      clump.mass = state.mass;
      clump.radius = std::cbrt(0.75 / std::numbers::pi * state.volume);
      clump.velocity = state.velocity;
      centres[state.id] = state.position;
    }
    for (std::size_t i = 0; i < grains_.id.size(); ++i) {
      if (!grains_.is_member(i)) continue;
      const Body member = alone(i);
      Body& clump = clumps_.at(grains_.clump[i]);
      const Vec3 arm = snapshot.decomposition->box().difference(grains_.position[i], centres.at(grains_.clump[i]));
      clump.spheres += member.spheres;
      clump.lowest = std::min(clump.lowest, member.lowest);
      clump.by_fluid += member.by_fluid;
      clump.by_contacts += member.by_contacts;
      clump.of_fluid += member.of_fluid + member.by_fluid * arm.transpose();
      clump.contacts += member.contacts;  // whose arms are from the centre of the clump
      clump.lubrication += member.lubrication;
    }
  }

  Body operator[](std::size_t i) const { return grains_.is_member(i) ? clumps_.at(grains_.clump[i]) : alone(i); }

private:
  Body alone(std::size_t i) const {
    const double volume = volume_of(grains_.radius[i], 0.0);
    Body body{volume, volume, grains_.mass[i], grains_.radius[i], grains_.velocity[i]};
    body.lowest = grains_.position[i].z() - grains_.radius[i];
    body.by_fluid = grains_.fluid_force[i];
    body.by_contacts = grains_.contact_force[i];
    body.contacts = contacts_[i];
    body.of_fluid = volume * grains_.fluid_stress[i];
    body.lubrication = lubrication_[i];
    return body;
  }

  const GrainView& grains_;
  std::vector<Mat3> contacts_, lubrication_;
  std::map<GlobalId, Body> clumps_;
};

StressBalance::StressBalance(MPI_Comm communicator, const Decomposition& decomposition, double layer,
                             const StressBalanceKeys& keys, const BalanceScales& scales, std::vector<HeldGrains> held,
                             std::vector<GlobalId> obstacles)
    : MeanObserver(communicator, StressBalanceKeys::section, keys.from, keys.every),
      n_(decomposition.cells()),
      spacing_(decomposition.spacing()),
      layers_(n_[2], spacing_, keys.layer.value_or(layer)),
      scales_(scales),
      held_(std::move(held)),
      obstacles_(std::move(obstacles)),
      fluid_(static_cast<std::size_t>(n_[2]) * fluid_columns, 0.0),
      grains_(static_cast<std::size_t>(layers_.count()) * grain_columns, 0.0),
      given_(static_cast<std::size_t>(2 * n_[2] + 1), 0.0),
      sides_(given_.size(), 0.0),
      held_up_(static_cast<std::size_t>(2 * layers_.count() + 2), 0.0),
      holding_(static_cast<std::size_t>(layers_.count()), 0.0),
      driving_(static_cast<std::size_t>(n_[2] + 1), 0.0) {
  if (decomposition.periodic()[2]) throw std::logic_error("a stress balance needs a top and a bottom");
}

bool StressBalance::measure(const Snapshot& snapshot, bool /*counts*/) { return snapshot.momentum != nullptr; }

void StressBalance::add(const Snapshot& snapshot) {
  add_fluid(*snapshot.momentum);
  add_grains(snapshot);
  add_grains_at_walls(snapshot);
}

void StressBalance::add_fluid(const MomentumBudget& budget) {
  for (std::size_t z = 0; z < budget.planes.size(); ++z) {
    const PlaneMomentum& plane = budget.planes[z];
    double* sums = fluid_.data() + z * fluid_columns;
    const auto cells_here = static_cast<double>(plane.cells);
    sums[cells] += cells_here;
    sums[density] += plane.density;
    for (int a = 0; a < 3; ++a) sums[flow + a] += plane.flow[a];
    for (std::size_t p = 0; p < 6; ++p) {
      sums[flow_flux + p] += plane.flow_flux[p];
      sums[viscous + p] += plane.viscous[p];
      sums[subgrid + p] += plane.subgrid[p];
    }
    driving_[z] += budget.driving.x() * cells_here;
  }
  driving_.back() += budget.on_top.x();
  for (std::size_t h = 0; h < given_.size(); ++h) {
    given_[h] += budget.on_grains[h].x();
    sides_[h] += budget.on_sides[h].x() + budget.on_solids[h].x();
  }
}

void StressBalance::add_grains(const Snapshot& snapshot) {
  if (snapshot.grains.global_count == 0) return;
  const BalancedBodies bodies(snapshot);
  const std::vector<double> sums =
      reproducible_sums_by_bin(communicator(), layers_.count(), grain_columns,
                               [&](const TermTaker& take) { give_parts(snapshot, bodies, take); });
  for (std::size_t s = 0; s < sums.size(); ++s) grains_[s] += sums[s];
  if (!held_.empty()) add_holding(snapshot, bodies);
}

// Obstacles that are all the grains are the bed (BedLayers).
void StressBalance::add_holding(const Snapshot& snapshot, const BalancedBodies& bodies) {
  const GrainView& grains = snapshot.grains;
  const bool obstacles_are_the_bed = static_cast<std::int64_t>(obstacles_.size()) == grains.global_count;
  const auto is_obstacle = [&](GlobalId id) {
    return !obstacles_are_the_bed && std::binary_search(obstacles_.begin(), obstacles_.end(), id);
  };
  const auto give_forces = [&](const TermTaker& take) {
    for (std::size_t i = 0; i < grains.id.size(); ++i) {
      if (!is_held(held_, grains.id[i])) continue;
      const BalancedBodies::Body body = bodies[i];
      const double radius = grains.radius[i], lowest = grains.position[i].z() - radius;
      const double force = -(body.by_fluid.x() + body.by_contacts.x()) / body.spheres;
      const int first = is_obstacle(grains.id[i]) ? 0 : layers_.at(body.lowest);
      for (int layer = first; layer < layers_.at(lowest + 2.0 * radius); ++layer)
        take(layer, std::array{force * volume_between(radius, 0.0, layers_.bottom(layer + 1) - lowest, 2.0 * radius)});
    }
  };
  const std::vector<double> sums = reproducible_sums_by_bin(communicator(), layers_.count(), 1, give_forces);
  const std::vector<Vec3> none, &by_height = obstacles_are_the_bed ? none : snapshot.momentum->on_obstacles;
  for (std::size_t l = 0; l < sums.size(); ++l) {
    holding_[l] += sums[l];
    const auto from = static_cast<std::size_t>(2 * layers_.first_plane(static_cast<int>(l) + 1) + 1);
    for (std::size_t h = from; h < by_height.size(); ++h) holding_[l] += by_height[h].x();
  }
}

// A row of grain_columns of each grain's part in each layer.
void StressBalance::give_parts(const Snapshot& snapshot, const BalancedBodies& bodies, const TermTaker& take) const {
  const GrainView& grains = snapshot.grains;
  for (std::size_t i = 0; i < grains.id.size(); ++i) {
    const BalancedBodies::Body body = bodies[i];
    const double radius = grains.radius[i], lowest = grains.position[i][2] - radius, whole = body.spheres;
    const Vec3 &v = body.velocity, &by_fluid = body.by_fluid, &by_contacts = body.by_contacts;
    const double outer = is_held(held_, grains.id[i]) ? -(by_fluid.x() + by_contacts.x())
                                                      : scales_.body_force(body.mass, body.radius).x() +
                                                            body.volume * snapshot.momentum->driving_of_grains.x();
    for (int layer = layers_.at(lowest); layer <= layers_.at(lowest + 2.0 * radius); ++layer) {
      const double from = layers_.bottom(layer) - lowest, height = layers_.height(layer), to = from + height;
      const double part = volume_between(radius, 0.0, from, to), share = part / whole, m = share * body.mass;
      const double height_moment = sphere_moment_below(radius, to) - sphere_moment_below(radius, from) - from * part;
      // Forces act inside the box, so that what a held grain has above the top acts there.
      const double above = layer + 1 == layers_.count() ? volume_between(radius, 0.0, to, 2.0 * radius) : 0.0;
      const double acting = (part + above) / whole, lever = (height_moment + above * height) / whole;
      std::array<double, grain_columns> row{grains.is_member(i) ? share * body.volume : part, m, m * v[0], m * v[1],
                                            m * v[2]};
      double* term = row.data() + momentum_flux;
      for (const auto& [a, b] : symmetric_pairs) *term++ = m * v[a] * v[b];
      for (const Mat3* moment : {&body.contacts, &body.of_fluid, &body.lubrication})
        for (int k = 0; k < 9; ++k) *term++ = share * (*moment)(k / 3, k % 3);
      for (const double value :
           {acting * by_fluid[0], acting * by_fluid[1], acting * by_fluid[2], acting * by_contacts[0], acting * outer,
            lever * by_fluid[0], lever * by_contacts[0], lever * outer})
        *term++ = value;
      take(layer, row);
    }
  }
}

// Walls by the height at which they act, of which the floor's is 0; the top, to which a held grain may also be on the
// outside, has a row of its own after the layers.
void StressBalance::add_grains_at_walls(const Snapshot& snapshot) {
  const GrainView& grains = snapshot.grains;
  if (grains.global_count == 0) return;
  const double top = n_[2] * spacing_;
  const auto give_forces = [&](const TermTaker& take) {
    snapshot.contacts->for_each_wall_force([&](std::size_t grain, const ContactEnd& end) {
      const Vec3& towards = end.to_partner;
      const double height = std::clamp(grains.position[grain].z() + end.arm.z(), 0.0, top);
      const bool of_top =
          std::abs(towards.z()) >= std::hypot(towards.x(), towards.y()) && height > top - 1e-6 * spacing_;
      const int layer = layers_.at(height);
      take(of_top ? layers_.count() : layer,
           std::array{end.force.x(), end.force.x() * (height - layers_.bottom(layer))});
    });
  };
  const std::vector<double> sums = reproducible_sums_by_bin(communicator(), layers_.count() + 1, 2, give_forces);
  for (std::size_t s = 0; s < sums.size(); ++s) held_up_[s] += sums[s];
}

std::size_t StressBalance::stored_size() const {
  std::size_t size = 0;
  for (const auto sums : stored) size += (this->*sums).size();
  return size;
}

void StressBalance::save_sums(ArchiveWriter& archive, const std::string& group) const {
  save_count(archive, group);
  archive.attribute(group + "/layers", static_cast<std::int64_t>(layers_.count()));
  std::vector<double> all;
  for (const auto sums : stored) all.insert(all.end(), (this->*sums).begin(), (this->*sums).end());
  write_whole(archive, communicator(), group + "/sums", all);
}

bool StressBalance::load_sums(ArchiveReader& archive, const std::string& group) {
  const auto all = read_whole_if_alike<double>(archive, group + "/sums", {stored_size()});
  if (!all || archive.integer_attribute(group + "/layers") != layers_.count()) return false;
  load_count(archive, group);
  auto next = all->begin();
  for (const auto sums : stored) {
    std::copy_n(next, (this->*sums).size(), (this->*sums).begin());
    next += static_cast<std::ptrdiff_t>((this->*sums).size());
  }
  return true;
}

void describe(SectionVisitor& visit, StressBalanceKeys& keys) {
  describe_from(visit, keys.from);
  describe_every(visit, keys.every);
  visit.real("layer", keys.layer,
             {.unit = "m",
              .meaning = "height of a layer, rounded to whole cells; default: a quarter of the smallest diameter",
              .above = 0.0,
              .example = 1.25e-3});
}

void check(const StressBalanceKeys& keys, const RunContext& run) {
  require_grains(run, "share the stress");
  if (run.box.periodic[2])
    throw KeyError("",
                   "stress is summed from the top down, but z is periodic; remove the section or give "
                   "domain.boundaries bottom and top");
  require_layer_in_box(run, keys.layer);
  require_full_gravity_from(run, keys.from);
}

std::unique_ptr<Observer> make_observer(const StressBalanceKeys& keys, const RunContext& run,
                                        const RunningSystem& system) {
  const BalanceScales scales{run.fluid->density, run.fluid->density * run.fluid->kinematic_viscosity,
                             run.grains->reference_diameter, run.grains->body_force,
                             run.fluid->velocity_unit / std::sqrt(3.0)};
  return std::make_unique<StressBalance>(system.communicator, system.decomposition,
                                         0.25 * run.grains->smallest_diameter, keys, scales, run.grains->held(),
                                         run.grains->obstacles.spheres);
}

}  // namespace thalweg::analysis
