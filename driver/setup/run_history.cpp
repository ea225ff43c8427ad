#include "driver/setup/run_history.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::driver {

namespace {

std::string largest_path(const std::string& diagnostic) { return "largest/" + diagnostic; }
std::string since_path(const std::string& observer) { return "run/since_" + observer; }

std::string interval_path(const std::string& observer) { return "run/interval_" + observer; }

// s, between its measurements, which go with the rows of the series where it has no interval of its own.
double interval_of(const analysis::Observer& observer, double series_every) {
  return observer.every() > 0.0 ? observer.every() : series_every;
}

// True if the archive has means over another measurement interval, to which this run's cannot be added with equal
// weights.
bool has_other_weights(ArchiveReader& archive, const analysis::Observer& observer, double series_every) {
  const std::string path = interval_path(observer.name());
  return archive.has(observer.name() + "/mean_from") && archive.has(path) &&
         archive.real_attribute(path) != interval_of(observer, series_every);
}

}  // namespace

void RunHistory::save(ArchiveWriter& archive, const Observers& observers, double series_every) const {
  archive.attribute("largest/from", largest_from);
  for (const Diagnostic& diagnostic : largest)
    if (std::isfinite(diagnostic.value)) archive.attribute(largest_path(diagnostic.name), diagnostic.value);
  for (const auto& [observer, time] : since) archive.attribute(since_path(observer), time);
  for (const auto& observer : observers) {
    observer->save(archive);
    archive.attribute(interval_path(observer->name()), interval_of(*observer, series_every));
  }
}

RunHistory RunHistory::load(ArchiveReader& archive, const System& system, Observers& observers, double series_every) {
  RunHistory run_history;
  run_history.largest_from = archive.has("largest/from") ? archive.real_attribute("largest/from") : system.time();
  for (Diagnostic diagnostic : system.diagnostics())
    if (archive.has(largest_path(diagnostic.name))) {
      diagnostic.value = archive.real_attribute(largest_path(diagnostic.name));
      run_history.largest.push_back(diagnostic);
    }
  for (const auto& observer : observers) {
    const std::string name = observer->name(), path = since_path(name);
    if (has_other_weights(archive, *observer, series_every) || !observer->load(archive))
      run_history.since[name] = system.time();
    else if (archive.has(path))
      run_history.since[name] = archive.real_attribute(path);
  }
  return run_history;
}

std::vector<Diagnostic> RunHistory::results_of(const analysis::Observer& observer) const {
  std::vector<Diagnostic> results = observer.results();
  const auto begun = since.find(observer.name());
  if (begun == since.end()) return results;
  const auto from = std::find_if(results.begin(), results.end(),
                                 [](const Diagnostic& diagnostic) { return diagnostic.name == "mean_from"; });
  if (from != results.end())
    from->value = std::max(from->value, begun->second);
  else
    results.push_back({"since", "s", begun->second});
  return results;
}

}  // namespace thalweg::driver
