#include "analysis/observers/entrainment_event.hpp"

#include <cmath>
#include <limits>

namespace thalweg::analysis {

namespace {

void add(std::vector<double>& values, const Vec3& v) { values.insert(values.end(), v.data(), v.data() + 3); }

Profile vectors(const std::string& name, const std::string& unit, const std::string& axis) {
  return {name, unit, {axis}, {"x", "y", "z"}, {0, 3}, {}};
}

void set_length(Profile& array) { array.shape[0] = array.values.size() / 3; }

void add_states(Event& event, const GrainRing& ring) {
  Profile time{"time", "s", {"time"}, {}, {ring.size()}, {}};
  for (const GrainSample& sample : ring) time.values.push_back(sample.time);
  event.arrays.push_back(std::move(time));
  for (int q = 0; q < GrainRecord::quantities; ++q) {
    const auto& [name, unit] = recorded_quantities[static_cast<std::size_t>(q)];
    Profile array = vectors(name, unit, "time");
    for (const GrainSample& sample : ring) add(array.values, sample[static_cast<GrainRecord::Quantity>(q)]);
    set_length(array);
    event.arrays.push_back(std::move(array));
  }
}

void add_contacts(Event& event, const GrainRing& ring) {
  WholeNumbers number{"contact_sample", "contact", {}}, partner{"contact_partner", "contact", {}},
      member{"contact_member", "contact", {}};
  Profile point = vectors("contact_point", "m", "contact"), place = vectors("contact_partner_position", "m", "contact"),
          force = vectors("contact_force_each", "N", "contact");
  for (std::size_t n = 0; n < ring.size(); ++n)
    for (const Touch& touch : ring[n].touches) {
      const Vec3 centre = ring[n][GrainRecord::position];
      number.values.push_back(static_cast<std::int64_t>(n));
      partner.values.push_back(touch.partner);
      if (touch.member >= 0) member.values.push_back(touch.member);
      add(point.values, centre + touch.point());
      add(place.values, touch.partner_position(centre));
      add(force.values, touch.force);
    }
  event.numbers.push_back(std::move(number));
  event.numbers.push_back(std::move(partner));
  if (!member.values.empty()) event.numbers.push_back(std::move(member));
  for (Profile* array : {&point, &place, &force}) {
    set_length(*array);
    event.arrays.push_back(std::move(*array));
  }
}

void add_hinge(Event& event, const Hinge& hinge, const std::vector<HingeTorques>& torques) {
  event.numbers.push_back({"hinge_partners", "hinge_partner", {hinge.partners[0], hinge.partners[1]}});
  Profile points = vectors("hinge_points", "m", "hinge_partner"), axis{"hinge_axis", "1", {}, {"x", "y", "z"}, {3}, {}};
  for (const Vec3& point : hinge.points) add(points.values, point);
  set_length(points);
  add(axis.values, hinge.axis);
  event.arrays.push_back(std::move(points));
  event.arrays.push_back(std::move(axis));
  const auto of = [&](const char* name, double HingeTorques::*torque) {
    Profile array{name, "N m", {"time"}, {}, {torques.size()}, {}};
    for (const HingeTorques& t : torques) array.values.push_back(t.*torque);
    event.arrays.push_back(std::move(array));
  };
  of("fluid_torque", &HingeTorques::fluid);
  of("couple_torque", &HingeTorques::couple);
  of("critical_torque", &HingeTorques::critical);
}

}  // namespace

std::span<const HingeTorques> Entraining::until_onset() const {
  return std::span(torques).first(torques.empty() ? 0 : *onset + 1);
}

double Entraining::couple_share() const {
  double couple = 0.0, fluid = 0.0;
  for (const HingeTorques& t : until_onset()) {
    couple += t.couple;
    fluid += t.fluid;
  }
  return fluid > 0.0 ? couple / fluid : std::numeric_limits<double>::quiet_NaN();
}

double Entraining::largest_torque_ratio() const {
  double largest = std::numeric_limits<double>::quiet_NaN();
  for (const HingeTorques& t : until_onset())
    if (t.critical > 0.0) largest = std::fmax(largest, t.fluid / t.critical);
  return largest;
}

Entraining entraining_of(const EntrainedGrain& grain, const GrainRing& ring, double moving_speed) {
  Entraining found{onset_of(ring, moving_speed), std::nullopt, {}};
  if (!found.onset) return found;
  found.hinge = hinge_of(ring, *found.onset, ring.back()[GrainRecord::position] - grain.rest);
  if (found.hinge)
    for (const GrainSample& sample : ring)
      found.torques.push_back(torques_about(*found.hinge, sample, grain.weight, grain.buoyancy));
  return found;
}

Event event_of(const std::string& name, const EntrainedGrain& grain, const GrainRing& ring,
               const Entraining& entraining) {
  Event event{name, ring.back().time, {}, {}, {}};
  event.diagnostics = {{"onset_time", "s", entraining.onset ? ring[*entraining.onset].time : std::nan("")},
                       {"radius", "m", grain.radius},
                       {"couple_share", "1", entraining.couple_share()},
                       {"largest_torque_ratio", "1", entraining.largest_torque_ratio()}};
  event.numbers.push_back({"id", "id", {grain.id}});
  Profile rest{"rest_position", "m", {}, {"x", "y", "z"}, {3}, {}},
      weight{"submerged_weight", "N", {}, {"x", "y", "z"}, {3}, {}};
  add(rest.values, grain.rest);
  add(weight.values, grain.weight);
  event.arrays = {rest, weight};
  add_states(event, ring);
  if (entraining.hinge) add_hinge(event, *entraining.hinge, entraining.torques);
  add_contacts(event, ring);
  return event;
}

}  // namespace thalweg::analysis
