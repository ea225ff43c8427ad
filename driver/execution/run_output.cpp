#include "driver/execution/run_output.hpp"

#include "core/base/error.hpp"
#include "core/parallel/on_first_rank.hpp"
#include "driver/bed/reference_grain.hpp"
#include "driver/case/solid_setup.hpp"
#include "driver/input/run_context.hpp"
#include "driver/setup/build_system.hpp"
#include "driver/setup/checkpoint_file.hpp"
#include "io/files/atomic_file.hpp"
#include "io/hdf5/hdf5_archive.hpp"
#include "io/hdf5/profile_file.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace thalweg::driver {

// Columns with the same value in every row of the series.
static std::vector<Diagnostic> constants_of(const Case& c) {
  if (c.grains.empty()) return {};
  const ReferenceGrain reference = reference_grain(c);
  return {{"reference_diameter", "m", reference.diameter}, {"reference_density", "kg/m^3", reference.density}};
}

static std::vector<Diagnostic> joined(std::vector<Diagnostic> row, const std::vector<Diagnostic>& constants) {
  row.insert(row.end(), constants.begin(), constants.end());
  return row;
}

// Removes a file of results that is from after a time (s) by an attribute of its own.
static void remove_if_later(const std::filesystem::path& file, const std::string& attribute, double time) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return;
  io::check_readable(file);
  try {
    if (io::Hdf5Reader(file).real_attribute(attribute) <= time) return;
  } catch (const InputError&) {  // whatever is in it, it is not of this state
  }
  io::remove_entry(file);
}

RunOutput::RunOutput(MPI_Comm communicator, const Case& c, const io::RunFolder& folder, const System& system,
                     const Observers& observers, const std::vector<Diagnostic>& row,
                     std::map<std::string, double> since, std::optional<double> continue_from)
    : communicator_(communicator),
      case_(c),
      folder_(folder),
      system_(system),
      observers_(observers),
      since_(std::move(since)),
      continue_from_(continue_from),
      kept_case_(kept_case_of(c)),
      constants_(constants_of(c)),
      columns_(joined(row, constants_)) {
  if (continue_from && c.output.series.every > 0.0)
    io::SeriesTable::check_columns(communicator, folder.series(), columns_);
  for (const auto& observer : observers) {
    if (!observer->has_records()) continue;
    const auto step = continue_from ? std::optional(system.step()) : std::nullopt;
    records_.push_back({observer.get(), io::RecordParts(communicator, folder.records(observer->name()), step),
                        observer->take_records()});
    records_.back().parts.check(records_.back().first);
  }
}

std::string RunOutput::begin() {
  if (continue_from_) drop_what_is_later();
  const Snapshot snapshot = system_.snapshot();
  if (!case_.grains.empty()) {  // also where none is there yet, or any more
    add_grains(folder_.path(), "grains", case_.output.grains, {});
    for (const io::NamedGrainOutputKeys& part : case_.output.grain_parts)
      add_grains(folder_.grain_parts(), part.name, part, part);
  }
  if (snapshot.fluid != nullptr) {
    add_fluid(folder_.path(), "fluid", case_.output.fluid);
    for (const io::NamedFluidOutputKeys& part : case_.output.fluid_parts)
      add_fluid(folder_.fluid_parts(), part.name, part);
  }
  begin_solids();
  for (ObserverRecords& records : records_) records.parts.begin(std::exchange(records.first, {}), system_.step());
  if (case_.output.series.every > 0.0)
    series_ = std::make_unique<io::SeriesTable>(communicator_, folder_.series(), columns_, continue_from_);
  return series_ ? series_->gap() : std::string();
}

void RunOutput::add_grains(const std::filesystem::path& folder, const std::string& name,
                           const io::GrainOutputKeys& keys, const io::GrainSelectionKeys& selection) {
  if (keys.every > 0.0)
    grains_.emplace_back(keys.every, io::GrainSeries(communicator_, folder, name, selection, keys.fields,
                                                     population_ids(case_), continue_from_, grain_output_facts(case_)));
}

void RunOutput::add_fluid(const std::filesystem::path& folder, const std::string& name,
                          const io::FluidOutputKeys& keys) {
  if (keys.every > 0.0)
    fluid_.emplace_back(
        keys.every, io::FluidSeries(communicator_, folder, name, keys, keys.fields, keys.precision, continue_from_));
}

// Solids that all stand still have one frame; a restart may be the first to ask for it.
void RunOutput::begin_solids() {
  if (case_.solids.empty() || solid_frames_every(case_).empty()) return;
  solids_.emplace(communicator_, folder_.path(), continue_from_);
  if (!any_solid_moves(case_) && solids_->is_empty()) write_solids(system_.time(), system_.step());
}

// Once a step, for which frames of several kinds may be due.
void RunOutput::write_solids(double time, std::int64_t step) {
  if (solids_step_ == step) return;
  solids_step_ = step;
  solids_->write(time, step, solid_surfaces(case_, time));
}

void RunOutput::add_to(loop::LoopPlan& plan) {
  const double time_step = system_.time_step();
  plan.series = Schedule(case_.output.series.every, time_step);
  plan.write_row = [this](double time, std::int64_t, const std::vector<Diagnostic>& row) { write_row(time, row); };
  plan.checkpoint = Schedule(case_.output.checkpoint.every, time_step);
  plan.checkpoint_wall = case_.output.checkpoint.every_wall;
  plan.write_checkpoint = [this](const loop::LoopRecord& record) { return write_checkpoint(record); };
  for (auto& [every, series] : grains_)
    plan.outputs.push_back({"grain output", Schedule(every, time_step),
                            [&written = series](const Snapshot& snapshot) { written.write(snapshot); },
                            series.needs_grain_stress()});
  for (auto& [every, series] : fluid_)
    plan.outputs.push_back({"fluid output", Schedule(every, time_step),
                            [&written = series](const Snapshot& snapshot) { written.write(snapshot); }});
  if (solids_ && any_solid_moves(case_))
    for (const double every : solid_frames_every(case_))
      plan.outputs.push_back({"solid output", Schedule(every, time_step),
                              [this](const Snapshot& snapshot) { write_solids(snapshot.time, snapshot.step); }});
  // Written together with the health checks, so that a broken state is never written.
  if (!records_.empty())
    plan.outputs.push_back({"records", Schedule(loop::TimeLoop::steps_between_health_checks * time_step, time_step),
                            [this](const Snapshot&) { add_records(); }});
}

void RunOutput::write_row(double time, const std::vector<Diagnostic>& measured) {
  series_->append(time, joined(measured, constants_));
}

// Called with each checkpoint and at the end.
void RunOutput::write_profiles() {
  io::ProfileGroups groups;
  for (const auto& observer : observers_) {
    std::vector<Profile> profiles = observer->profiles();
    if (!profiles.empty()) groups.emplace_back(observer->name(), std::move(profiles));
  }
  if (std::vector<Profile> own = system_.profiles(); !own.empty())
    groups.emplace_back(name_of(case_.system), std::move(own));
  if (!groups.empty()) io::write_profiles(communicator_, folder_.profiles(), system_.time(), groups);
}

void RunOutput::add_records() {
  for (ObserverRecords& records : records_) records.parts.add(records.observer->take_records(), system_.step());
}

// Frames, records, rows, profiles and the bed that the run no longer writes are dropped as well: they belong to the
// course that it has left.
void RunOutput::drop_what_is_later() const {
  on_first_rank(communicator_, [&] {
    for (const std::string& name : io::RunFolder::names_of_records())
      io::drop_parts_after(folder_.records(name), system_.step());
    remove_if_later(folder_.profiles(), "time", *continue_from_);
    remove_if_later(folder_.bed(), "bed/time", *continue_from_);
  });
  for (const auto& folder : {folder_.path(), folder_.grain_parts(), folder_.fluid_parts()})
    io::take_up_indices(communicator_, folder, *continue_from_);
  if (case_.output.series.every <= 0.0)
    io::SeriesTable::drop_rows_after(communicator_, folder_.series(), *continue_from_);
}

// A restart counts on what lies beside the checkpoint.
void RunOutput::put_on_disk() {
  for (auto& [every, series] : grains_) series.put_on_disk();
  for (auto& [every, series] : fluid_) series.put_on_disk();
  if (solids_) solids_->put_on_disk();
  for (ObserverRecords& records : records_) records.parts.write(system_.step());
  if (series_) series_->put_on_disk();
}

std::uint64_t RunOutput::write_checkpoint(const loop::LoopRecord& record) {
  add_records();
  put_on_disk();
  const std::filesystem::path path = folder_.checkpoint(system_.step());
  write_checkpoint_file(communicator_, path, case_, kept_case_, system_, observers_,
                        {record.largest, record.largest_from, since_});
  std::uint64_t bytes = 0;
  on_first_rank(communicator_, [&] {
    folder_.rotate_checkpoints(system_.step(), static_cast<int>(std::min<std::int64_t>(
                                                   case_.output.checkpoint.keep, std::numeric_limits<int>::max())));
    std::error_code ignored;
    bytes = std::filesystem::file_size(path, ignored);
  });
  write_profiles();
  return bytes;
}

}  // namespace thalweg::driver
