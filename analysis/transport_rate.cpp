#include "analysis/transport_rate.hpp"

#include "analysis/sphere_in_layer.hpp"
#include "core/mpi_session.hpp"
#include "core/order_free_sum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::analysis {

namespace {

constexpr double share_of_fall_speed_that_counts_as_moving = 0.01;

}  // namespace

double TransportScales::flux() const {
  const double excess = fluid_density > 0.0 ? std::abs(grain_density / fluid_density - 1.0) : 1.0;
  return std::sqrt(excess * gravity * grain_diameter) * grain_diameter;
}

double TransportScales::moving_speed() const {
  return share_of_fall_speed_that_counts_as_moving * flux() / grain_diameter;
}

TransportRate::TransportRate(MPI_Comm communicator, const TransportScales& scales, double from)
    : communicator_(communicator), scales_(scales), from_(from) {}

void TransportRate::observe(const Snapshot& snapshot) {
  const GrainView& grains = snapshot.grains;
  const double threshold = scales_.moving_speed();
  std::vector<double> flux;
  std::int64_t moving = 0;
  double largest_squared = 0.0;
  const auto add = [&](double volume, const Vec3& velocity) {
    flux.push_back(volume * velocity.x());
    const double speed_squared = velocity.squaredNorm();
    if (speed_squared > threshold * threshold) ++moving;
    largest_squared = std::max(largest_squared, speed_squared);
  };
  for (std::size_t i = 0; i < grains.id.size(); ++i)
    if (!grains.is_member(i)) add(volume_of(grains.radius[i], grains.disk_thickness), grains.velocity[i]);
  for (const ClumpState& clump : grains.clumps) add(clump.volume, clump.velocity);
  const Vec3 size = snapshot.decomposition->box().size;
  const double width = grains.disk_thickness > 0.0 ? grains.disk_thickness : size.y();
  q_s_ = order_free_sums(communicator_, flux, 1)[0] / (size.x() * width);
  moving_ = sum_over_ranks(communicator_, moving);
  largest_speed_ = std::sqrt(max_over_ranks(communicator_, largest_squared));

  // from_ may be a rounded multiple of the time step: a measurement at that very step counts.
  if (snapshot.time < from_ * (1.0 - 1e-12)) return;
  // A run that goes on from a checkpoint looks once more at the state the checkpoint holds.
  if (snapshot.step <= counted_step_) return;
  counted_step_ = snapshot.step;
  ++measurements_;
  sum_ += q_s_;
  sum_of_squares_ += q_s_ * q_s_;
}

std::vector<Figure> TransportRate::figures() const {
  std::vector<Figure> figures{{"q_s", "m^2/s", q_s_}};
  if (scales_.have_q_star()) figures.push_back({"q_star", "1", q_s_ / scales_.flux()});
  figures.push_back({"moving_grains", "1", static_cast<double>(moving_)});
  figures.push_back({"largest_grain_speed", "m/s", largest_speed_});
  return figures;
}

std::vector<Figure> TransportRate::results() const {
  const double count = std::max<double>(1.0, static_cast<double>(measurements_));
  const double mean = sum_ / count;
  const double deviation = std::sqrt(std::max(0.0, sum_of_squares_ / count - mean * mean));
  std::vector<Figure> results{{"q_s_mean", "m^2/s", mean}};
  if (scales_.have_q_star()) {
    results.push_back({"q_star_mean", "1", mean / scales_.flux()});
    results.push_back({"q_star_deviation", "1", deviation / scales_.flux()});
  }
  results.push_back({"mean_from", "s", from_});
  results.push_back({"measurements", "1", static_cast<double>(measurements_)});
  for (const Figure& latest : figures()) results.push_back(latest);
  return results;
}

void TransportRate::save(ArchiveWriter& archive) const {
  archive.attribute("transport_rate/mean_from", from_);
  archive.attribute("transport_rate/measurements", measurements_);
  archive.attribute("transport_rate/counted_step", counted_step_);
  archive.attribute("transport_rate/sum", sum_);
  archive.attribute("transport_rate/sum_of_squares", sum_of_squares_);
}

void TransportRate::load(ArchiveReader& archive) {
  if (!archive.has("transport_rate/mean_from") || archive.real_attribute("transport_rate/mean_from") != from_) return;
  measurements_ = archive.integer_attribute("transport_rate/measurements");
  counted_step_ = archive.integer_attribute("transport_rate/counted_step");
  sum_ = archive.real_attribute("transport_rate/sum");
  sum_of_squares_ = archive.real_attribute("transport_rate/sum_of_squares");
}

}  // namespace thalweg::analysis
