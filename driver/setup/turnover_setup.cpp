#include "driver/setup/turnover_setup.hpp"

#include "beds/supplies.hpp"
#include "driver/bed/supplied_grains.hpp"

namespace thalweg::driver {

void add_turnover(const Case& c, const PeriodicBox& box, dem::GrainParameters& parameters) {
  for (const beds::SupplyKeys& supply : c.supplies)
    parameters.supplies.push_back(beds::supply_of(supply, c.grains, box.size, unit_rate(c)));
  for (const beds::SinkKeys& sink : c.sinks)
    parameters.sinks.push_back(beds::sink_of(sink, c.disks.has_value(), box.size));
}

}  // namespace thalweg::driver
