#include "beds/population/supply_keys.hpp"

namespace thalweg::beds {

// Where grains come in, and how fast.
static void describe_entrance(SectionVisitor& visit, RegionKeys& region, std::optional<Vec3>& velocity,
                              std::int64_t& seed, const char* velocity_meaning) {
  visit.section(
      "region", region,
      {.meaning = "where they come in: their centres, each at a random free place; where none is free they wait",
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
  visit.integer("population", supply.population,
                {.meaning = "number of the population, in grains, that they are like: sizes, shape, density, contact",
                 .at_least = 0});
  visit.real("rate", supply.rate, {.unit = "1/s", .meaning = "grains a second", .above = 0.0, .example = 20.0});
  visit.real("mass_rate", supply.mass_rate,
             {.unit = "kg/s", .meaning = "in place of rate", .above = 0.0, .example = 1e-3});
  visit.real("transport_rate", supply.transport_rate,
             {.meaning = "q* over the width of the box, in place of rate", .above = 0.0, .example = 0.1});
  visit.require(supply.rate.has_value() + supply.mass_rate.has_value() + supply.transport_rate.has_value() == 1, "rate",
                "give one of rate in grains/s, mass_rate in kg/s and transport_rate, which is q*");
  visit.real("from", supply.from, {.unit = "s", .meaning = "time of the beginning", .at_least = 0.0});
  visit.real("until", supply.until,
             {.unit = "s", .meaning = "time of the end; default: that of the run", .above = 0.0, .example = 10.0});
  visit.require(!supply.until || *supply.until > supply.from, "until",
                "the supply ends before it begins; give a time in s after from");
  describe_entrance(visit, supply.region, supply.velocity, supply.seed,
                    "with which they come in; default: that of the fluid there, else zero");
  visit.section(
      "above_bed", supply.above_bed,
      {.meaning =
           "only where the centre is so high, within the region, above the highest of the grains that lie or roll, "
           "walls and solids below; default: in all of the region"});
}

static void describe(SectionVisitor& visit, RecirculationKeys& recirculation) {
  visit.real("delay", recirculation.delay, {.unit = "s", .meaning = "until they come in again", .at_least = 0.0});
  describe_entrance(
      visit, recirculation.region, recirculation.velocity, recirculation.seed,
      "with which they come in; default: the one they had if they come in at the height at which they left, "
      "else as of a supply");
}

void describe(SectionVisitor& visit, SinkKeys& sink) {
  visit.section("region", sink.region,
                {.meaning = "every free grain whose centre enters it leaves the box", .required = true});
  visit.section("recirculation", sink.recirculation,
                {.meaning = "they come in again elsewhere; default: they are gone"});
}

}  // namespace thalweg::beds
