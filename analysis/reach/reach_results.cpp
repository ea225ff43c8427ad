// What Reach reports: numbers, words, profiles and records.
#include "analysis/reach/reach.hpp"

#include "analysis/statistics/stationarity.hpp"
#include "core/parallel/mpi_session.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace thalweg::analysis {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Standard deviation of the means of the sections from the first one on.
double variation_of(const std::vector<CorrelatedMean>& means, std::size_t first) {
  const auto count = static_cast<double>(means.size() - first);
  double sum = 0.0, squares = 0.0;
  for (std::size_t k = first; k < means.size(); ++k) sum += means[k].mean();
  for (std::size_t k = first; k < means.size(); ++k) squares += std::pow(means[k].mean() - sum / count, 2);
  return std::sqrt(squares / count);
}

double mean_or_unknown(const CorrelatedMean& mean) { return mean.count() > 0 ? mean.mean() : unknown; }

}  // namespace

// As if they followed each other: the bed of a bin has no level before it is built up, or once it is gone.
double Reach::duration_of(const CorrelatedMean& level) const {
  const double records = static_cast<double>(mean_q_s_.count());
  return (window_ended_ - window_begun_) * static_cast<double>(level.count()) / records;
}

double Reach::bed_trend(const CorrelatedMean& level) const { return trend_of(level).drift / duration_of(level); }

void Reach::add_means(std::vector<Diagnostic>& results) const {
  const double duration = window_ended_ - window_begun_, plan = plan_of_bin() * static_cast<double>(sections_.bins);
  const double error = mean_q_s_.error().of_mean, variation = variation_of(q_s_, sections_.first());
  results.push_back({"q_s_mean", "m^2/s", mean_q_s_.mean()});
  results.push_back({"q_s_error", "m^2/s", error});
  results.push_back({"q_s_independent", "1", mean_q_s_.error().independent});
  results.push_back({"q_s_error_holds", "1", mean_q_s_.error().holds() ? 1.0 : 0.0});
  results.push_back({"q_s_variation", "m^2/s", variation});
  if (scales_.have_q_star()) {
    results.push_back({"q_star_mean", "1", mean_q_s_.mean() / scales_.flux()});
    results.push_back({"q_star_error", "1", error / scales_.flux()});
    results.push_back({"q_star_variation", "1", variation / scales_.flux()});
  }
  results.push_back({"bed_level_mean", "m", mean_or_unknown(mean_level_)});
  results.push_back({"bed_level_trend", "m/s", bed_trend(mean_level_)});
  results.push_back({"bed_level_trend_error", "m/s", trend_of(mean_level_).error / duration_of(mean_level_)});
  results.push_back({"entrainment_rate", "m/s", window_.all_volume_of(Passage::entrained) / (plan * duration)});
  results.push_back({"deposition_rate", "m/s", window_.all_volume_of(Passage::deposited) / (plan * duration)});
  results.push_back({"measured_from", "s", window_begun_});
  results.push_back({"measured_until", "s", window_ended_});
  if (mean_q_s_.count() == 0) forget_values(results);
}

std::vector<Diagnostic> Reach::results() const {
  std::vector<Diagnostic> results;
  add_means(results);
  const auto grains = [&](Passage passage) {
    return static_cast<double>(total_.all_grains_of(passage) + interval_.all_grains_of(passage));
  };
  const double change = std::accumulate(stored_.begin(), stored_.end(), 0.0) -
                        std::accumulate(first_stored_.begin(), first_stored_.end(), 0.0);
  results.push_back({"arrived_grains", "1", grains(Passage::arrived)});
  results.push_back({"left_grains", "1", grains(Passage::left)});
  results.push_back({"arrived_volume", "m^3", total_.all_volume_of(Passage::arrived)});
  results.push_back({"left_volume", "m^3", total_.all_volume_of(Passage::left)});
  results.push_back({"stored_change", "m^3", change * plan_of_bin()});
  results.push_back({"balance_residual", "1", static_cast<double>(balance_residual())});
  for (const Diagnostic& of_stays : residence_.results()) results.push_back(of_stays);
  results.push_back({"sections", "1", static_cast<double>(sections_.bins)});
  results.push_back({"section_spacing", "m", sections_.spacing()});
  results.push_back({"moving_speed", "m/s", moving_speed_});
  results.push_back({"mean_from", "s", from_});
  results.push_back({"records", "1", static_cast<double>(mean_q_s_.count())});
  return results;
}

std::vector<std::string> Reach::remarks() const {
  if (mean_q_s_.count() == 0) return {};
  const double unit = scales_.have_q_star() ? scales_.flux() : 1.0;
  const char* const name = scales_.have_q_star() ? "q*" : "q_s";
  const std::string transport =
      fmt::format("reach: {} = {}{} through {} sections, with a deviation of {:.2g} along x{}", name,
                  with_error(mean_q_s_, unit), scales_.have_q_star() ? "" : " m^2/s",
                  sections_.size() - sections_.first(), variation_of(q_s_, sections_.first()) / unit,
                  mean_q_s_.error().holds() ? "" : "; too few records, the error is larger");
  const double trend = bed_trend(mean_level_);
  if (std::isnan(trend)) return {transport};
  return {transport, fmt::format("reach: the level of the bed changes by {:+.3g} +- {:.2g} m/s", trend,
                                 trend_of(mean_level_).error / duration_of(mean_level_))};
}

void Reach::add_by_section(std::vector<Profile>& profiles) const {
  const std::size_t first = sections_.first();
  const std::uint64_t count = sections_.size() - first;
  const double duration = window_ended_ - window_begun_;
  const auto add = [&](const char* name, const char* unit, const auto& value_at) {
    profiles.push_back({name, unit, {"section"}, {}, {count}, {}});
    for (std::size_t k = first; k < sections_.size(); ++k) profiles.back().values.push_back(value_at(k));
  };
  add("q_s", "m^2/s", [&](std::size_t k) { return mean_or_unknown(q_s_[k]); });
  add("q_s_error", "m^2/s", [&](std::size_t k) { return q_s_[k].error().of_mean; });
  add("upstream_q_s", "m^2/s",
      [&](std::size_t k) { return window_.volume_of(Passage::upstream, k) / (width_ * duration); });
  if (scales_.have_q_star()) {
    add("q_star", "1", [&](std::size_t k) { return mean_or_unknown(q_s_[k]) / scales_.flux(); });
    add("q_star_error", "1", [&](std::size_t k) { return q_s_[k].error().of_mean / scales_.flux(); });
  }
  add("downstream_grains", "1",
      [&](std::size_t k) { return static_cast<double>(window_.grains_of(Passage::downstream, k)); });
  add("upstream_grains", "1",
      [&](std::size_t k) { return static_cast<double>(window_.grains_of(Passage::upstream, k)); });
}

std::vector<Profile> Reach::profiles() const {
  const std::vector<double> places = sections_.places(), middles = sections_.middles();
  const double duration = window_ended_ - window_begun_;
  std::vector<Profile> profiles{{"section", "m", {"section"}, {}, {places.size()}, places},
                                {"x", "m", {"x"}, {}, {middles.size()}, middles}};
  add_by_section(profiles);
  const auto add = [&](const char* name, const char* unit, std::vector<double> values) {
    profiles.push_back({name, unit, {"x"}, {}, {middles.size()}, std::move(values)});
  };
  const auto of_levels = [&](const auto& value_of) {
    std::vector<double> values;
    for (const CorrelatedMean& level : level_) values.push_back(value_of(level));
    return values;
  };
  add("bed_level", "m", of_levels(mean_or_unknown));
  add("bed_level_error", "m", of_levels([](const CorrelatedMean& level) { return level.error().of_mean; }));
  add("bed_level_trend", "m/s", of_levels([&](const CorrelatedMean& level) { return bed_trend(level); }));
  add("stored", "m", stored_);
  std::vector<double> change;
  for (std::size_t bin = 0; bin < stored_.size(); ++bin)
    change.push_back(mean_q_s_.count() > 0 ? (stored_[bin] - window_stored_[bin]) / duration : unknown);
  add("storage_rate", "m/s", change);
  add("entrainment_rate", "m/s", rates(window_, Passage::entrained, duration));
  add("deposition_rate", "m/s", rates(window_, Passage::deposited, duration));
  add("arrival_rate", "m/s", rates(window_, Passage::arrived, duration));
  add("departure_rate", "m/s", rates(window_, Passage::left, duration));
  for (Profile& of_stays : residence_.profiles()) profiles.push_back(std::move(of_stays));
  return profiles;
}

Records Reach::take_records() {
  Records records;
  if (rank_of(communicator_) != 0) return records;
  const std::vector<double> places = sections_.places(), middles = sections_.middles();
  records.places = {{"section", "m", {"section"}, {}, {places.size()}, places},
                    {"x", "m", {"x"}, {}, {middles.size()}, middles}};
  const auto add = [&](const char* name, const char* unit, double Row::*value) {
    records.rows.push_back({name, unit, {"time"}, {}, {rows_.size()}, {}});
    for (const Row& row : rows_) records.rows.back().values.push_back(row.*value);
  };
  const auto add_along = [&](const char* name, const char* unit, const char* axis, std::uint64_t count,
                             std::vector<double> Row::*values, double scale = 1.0) {
    records.rows.push_back({name, unit, {"time", axis}, {}, {rows_.size(), count}, {}});
    for (const Row& row : rows_)
      for (const double value : row.*values) records.rows.back().values.push_back(value / scale);
  };
  add("time", "s", &Row::time);
  add("interval", "s", &Row::interval);
  add_along("q_s", "m^2/s", "section", places.size(), &Row::q_s);
  add_along("upstream_q_s", "m^2/s", "section", places.size(), &Row::upstream_q_s);
  if (scales_.have_q_star()) add_along("q_star", "1", "section", places.size(), &Row::q_s, scales_.flux());
  add_along("bed_level", "m", "x", middles.size(), &Row::bed_level);
  add_along("stored", "m", "x", middles.size(), &Row::stored);
  add_along("entrained", "m/s", "x", middles.size(), &Row::entrained);
  add_along("deposited", "m/s", "x", middles.size(), &Row::deposited);
  add_along("arrived", "m/s", "x", middles.size(), &Row::arrived);
  add_along("left", "m/s", "x", middles.size(), &Row::left);
  rows_.clear();
  return records;
}

}  // namespace thalweg::analysis
