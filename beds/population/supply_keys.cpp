#include "beds/population/supply_keys.hpp"

namespace thalweg::beds {

// Where grains come in, and how fast.
static void describe_entrance(SectionVisitor& visit, RegionKeys& region, std::optional<Vec3>& velocity,
                              std::int64_t& seed, const char* velocity_meaning) {
  visit.section(
      "region", region,
      {.meaning = "where the centres of the grains come in, each at a random free place; without one they wait",
       .required = true});
  visit.vec3("velocity", velocity, {.unit = "m/s", .meaning = velocity_meaning, .example = 0.0});
  visit.integer("seed", seed, {.meaning = "seed of the random places", .at_least = 0});
}

static void describe(SectionVisitor& visit, AboveBedKeys& range) {
  visit.real("lower", range.lower, {.unit = "m", .meaning = "lowest height", .at_least = 0.0});
  visit.real("upper", range.upper, {.unit = "m", .meaning = "greatest height", .required = true, .example = 0.01});
  visit.require(range.lower <= range.upper, "upper", "give a height in m that is not below lower");
}

void describe(SectionVisitor& visit, SupplyKeys& supply) {
  visit.integer(
      "population", supply.population,
      {.meaning = "population, by its number in grains, that gives sizes, shape, density and contact", .at_least = 0});
  visit.real("rate", supply.rate, {.unit = "1/s", .meaning = "grains per second", .above = 0.0, .example = 20.0});
  visit.real("mass_rate", supply.mass_rate,
             {.unit = "kg/s", .meaning = "in place of rate", .above = 0.0, .example = 1e-3});
  visit.real("transport_rate", supply.transport_rate,
             {.meaning = "q* over the width of the box, in place of rate", .above = 0.0, .example = 0.1});
  visit.require(supply.rate.has_value() + supply.mass_rate.has_value() + supply.transport_rate.has_value() == 1, "rate",
                "give exactly one of rate in grains/s, mass_rate in kg/s and transport_rate (q*)");
  visit.real("from", supply.from, {.unit = "s", .meaning = "start of the supply", .at_least = 0.0});
  visit.real("until", supply.until,
             {.unit = "s", .meaning = "end of the supply; default: end of the run", .above = 0.0, .example = 10.0});
  visit.require(!supply.until || *supply.until > supply.from, "until",
                "the supply ends before it begins; give a time in s after from");
  describe_entrance(visit, supply.region, supply.velocity, supply.seed,
                    "of the grains that come in; default: that of the fluid there, without a fluid zero");
  visit.section("above_bed", supply.above_bed,
                {.meaning = "height of the centre above the highest grain that lies or rolls, wall or solid below it, "
                            "within the region; default: all of the region"});
}

static void describe(SectionVisitor& visit, RecirculationKeys& recirculation) {
  visit.real("delay", recirculation.delay, {.unit = "s", .meaning = "time until they come in again", .at_least = 0.0});
  describe_entrance(visit, recirculation.region, recirculation.velocity, recirculation.seed,
                    "of the grains that come in; default: that with which they left if they come in at the height at "
                    "which they left, otherwise as for a supply");
}

void describe(SectionVisitor& visit, SinkKeys& sink) {
  visit.section("region", sink.region,
                {.meaning = "every free grain whose centre enters it leaves the box", .required = true});
  visit.section("recirculation", sink.recirculation,
                {.meaning = "grains that leave come in again elsewhere; default: they are removed"});
}

}  // namespace thalweg::beds
