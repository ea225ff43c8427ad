// Interface of the time loop to anything that advances in time, shows its state, and can be saved and loaded.
#pragma once

#include "core/base/archive.hpp"
#include "core/base/error.hpp"
#include "core/base/phase_timer.hpp"
#include "core/state/location.hpp"
#include "core/state/profile.hpp"
#include "core/state/snapshot.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace thalweg {

// A number worth a column in the progress line, the series and the summary.
struct Diagnostic {
  std::string name;  // e.g. "largest_lattice_velocity"
  std::string unit;  // e.g. "m/s", "1" for none
  double value;
};

// Three diagnostics of a vector: `name`_x, `name`_y, `name`_z.
inline void add_vector(const std::string& name, const std::string& unit, const Vec3& value,
                       std::vector<Diagnostic>& diagnostics) {
  const char* const axes[] = {"_x", "_y", "_z"};
  for (int axis = 0; axis < 3; ++axis) diagnostics.push_back({name + axes[axis], unit, value[axis]});
}

// Sets all values to NaN (null in JSON), as means are before anything has been measured.
inline void forget_values(std::vector<Diagnostic>& diagnostics) {
  for (Diagnostic& diagnostic : diagnostics) diagnostic.value = std::numeric_limits<double>::quiet_NaN();
}

// The diagnostic of that name, if there is one.
inline std::optional<double> find_diagnostic(const std::vector<Diagnostic>& diagnostics, const std::string& name) {
  for (const Diagnostic& diagnostic : diagnostics)
    if (diagnostic.name == name) return diagnostic.value;
  return std::nullopt;
}

class System {
public:
  virtual ~System() = default;

  virtual void advance() = 0;  // one (fluid) step. Throws RunError.
  // The next step records its momentum budget for its snapshot. Collective; does not change the state. A system without
  // fluid and grains has none to record.
  virtual void record_momentum() {}
  // The next step measures the stress of the fluid on every grain. Its snapshot has the mean of this exchange and the
  // last one, which oscillate from step to step, if that step measured it too, and this one if not. Collective; does
  // not change the state.
  virtual void measure_grain_stress() {}
  virtual std::int64_t step() const = 0;                                     // steps done since the start of the run
  virtual double time_step() const = 0;                                      // s
  double time() const { return static_cast<double>(step()) * time_step(); }  // s

  virtual Snapshot snapshot() const = 0;                    // valid until the next advance()
  virtual std::vector<Diagnostic> diagnostics() const = 0;  // state of health; collective, the same on every rank

  // The state as arrays for profiles.h5, where it consists of some; the same on every rank.
  virtual std::vector<Profile> profiles() const { return {}; }

  // Location at which the diagnostic of that name takes its value; empty if it belongs to no location. Collective, the
  // same on every rank; may cost as much as diagnostics().
  virtual std::optional<Location> location_of(const std::string&) const { return std::nullopt; }

  virtual void save(ArchiveWriter& archive) const = 0;  // everything the next step depends on; collective
  virtual void load(ArchiveReader& archive) = 0;        // throws InputError where it does not fit; collective
  // Takes the fluid alone from another run in the same box, whose cells had the size `spacing` (m), as an initial
  // state. Throws InputError where it does not fit, or there is no fluid; collective.
  virtual void import_fluid(ArchiveReader&, double /*spacing*/) {
    throw InputError("this system has no fluid that could be taken over.");
  }

  // Takes the grains alone, with their contact springs, from a run with as many grains; keeps their velocities, but not
  // the time. Call it before import_fluid().
  virtual void import_grains(ArchiveReader&, double /*spacing*/) {
    throw InputError("this system has no grains that could be taken over.");
  }

  virtual PhaseTimer& timer() = 0;
  virtual std::int64_t cells() const = 0;                 // lattice cells in the whole domain; 0 without a fluid
  virtual std::int64_t grain_steps_per_step() const = 0;  // grains times sub-steps in one step, over all ranks
};

}  // namespace thalweg
