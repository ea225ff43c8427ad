#include "driver/run_output.hpp"

#include "core/error.hpp"
#include "core/on_first_rank.hpp"
#include "core/round_off.hpp"
#include "driver/bed_archive.hpp"
#include "driver/build_system.hpp"
#include "driver/reference_grain.hpp"
#include "driver/run_facts.hpp"
#include "driver/version.hpp"
#include "io/hdf5_archive.hpp"
#include "io/profile_file.hpp"

#include <fmt/format.h>

#include <utility>

namespace thalweg::driver {

RunOutput::RunOutput(MPI_Comm communicator, const Case& c, const io::RunFolder& folder, const System& system,
                     const Observers& observers, std::map<std::string, double> since,
                     std::optional<double> continue_from)
    : communicator_(communicator),
      case_(c),
      folder_(folder),
      system_(system),
      observers_(observers),
      since_(std::move(since)),
      continue_from_(continue_from) {
  const Snapshot snapshot = system.snapshot();
  if (snapshot.grains.global_count > 0) {
    add_grains(folder.path(), "grains", c.output.grains, {});
    for (const io::NamedGrainOutputKeys& part : c.output.grain_parts)
      add_grains(folder.grain_parts(), part.name, part, part);
  }
  if (snapshot.fluid != nullptr) {
    add_fluid(folder.path(), "fluid", c.output.fluid);
    for (const io::NamedFluidOutputKeys& part : c.output.fluid_parts) add_fluid(folder.fluid_parts(), part.name, part);
  }
  for (const auto& observer : observers)
    if (observer->has_records())
      records_.emplace_back(observer.get(),
                            io::RecordFile(communicator, folder.records(observer->name()), continue_from));
  if (!c.grains.empty()) {
    const ReferenceGrain reference = reference_grain(c);
    constants_ = {{"reference_diameter", "m", reference.diameter}, {"reference_density", "kg/m^3", reference.density}};
  }
  write_records();  // whether they can be written, or continued, is known before the run begins
}

void RunOutput::add_grains(const std::filesystem::path& folder, const std::string& name,
                           const io::GrainOutputKeys& keys, const io::GrainSelectionKeys& selection) {
  if (keys.every > 0.0)
    grains_.emplace_back(keys.every, io::GrainSeries(communicator_, folder, name, selection, keys.fields,
                                                     population_ends(case_), continue_from_));
}

void RunOutput::add_fluid(const std::filesystem::path& folder, const std::string& name,
                          const io::FluidOutputKeys& keys) {
  if (keys.every > 0.0)
    fluid_.emplace_back(
        keys.every, io::FluidSeries(communicator_, folder, name, keys, keys.fields, keys.precision, continue_from_));
}

void RunOutput::add_to(loop::LoopPlan& plan) {
  const double time_step = system_.time_step();
  plan.series = Schedule(case_.output.series.every, time_step);
  plan.write_row = [this](double time, std::int64_t, const std::vector<Figure>& row) { write_row(time, row); };
  plan.checkpoint = Schedule(case_.output.checkpoint.every, time_step);
  plan.checkpoint_wall = case_.output.checkpoint.every_wall;
  plan.write_checkpoint = [this](const loop::LoopRecord& record) { return write_checkpoint(record); };
  for (auto& [every, series] : grains_)
    plan.outputs.push_back({"grain output", Schedule(every, time_step),
                            [&written = series](const Snapshot& snapshot) { written.write(snapshot); }});
  for (auto& [every, series] : fluid_)
    plan.outputs.push_back({"fluid output", Schedule(every, time_step),
                            [&written = series](const Snapshot& snapshot) { written.write(snapshot); }});
  // With the looks at the system's health, so that nothing is written of a state that is broken.
  if (!records_.empty())
    plan.outputs.push_back({"records", Schedule(loop::TimeLoop::steps_between_health_checks * time_step, time_step),
                            [this](const Snapshot&) { write_records(); }});
}

void RunOutput::begin_series(const std::vector<Figure>& row) {
  if (case_.output.series.every <= 0.0) return;
  std::vector<io::SeriesTable::Column> columns;
  for (const auto* figures : {&row, &std::as_const(constants_)})
    for (const Figure& figure : *figures) columns.push_back({figure.name, figure.unit});
  series_ = std::make_unique<io::SeriesTable>(communicator_, folder_.series(), columns, continue_from_);
}

void RunOutput::write_row(double time, const std::vector<Figure>& measured) {
  std::vector<double> values;
  for (const auto* figures : {&measured, &std::as_const(constants_)})
    for (const Figure& figure : *figures) values.push_back(figure.value);
  series_->append(time, values);
}

// As often as the state is saved, and at the end.
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

void RunOutput::write_records() {
  for (auto& [observer, file] : records_) file.add(observer->take_records());
}

std::uint64_t RunOutput::write_checkpoint(const loop::LoopRecord& record) {
  write_records();
  // A restart counts on what lies beside the checkpoint.
  for (auto& [observer, file] : records_) file.put_on_disk();
  if (series_) series_->put_on_disk();
  const std::filesystem::path path = folder_.checkpoint(system_.step());
  write_checkpoint_file(communicator_, path, case_, system_, observers_, {record.largest, record.largest_from, since_});
  std::uint64_t bytes = 0;
  on_first_rank(communicator_, [&] {
    folder_.rotate_checkpoints(system_.step(), static_cast<int>(case_.output.checkpoint.keep));
    std::error_code ignored;
    bytes = std::filesystem::file_size(path, ignored);
  });
  write_profiles();
  return bytes;
}

// Of what a checkpoint contains and how; those without a number were written before 2.
static constexpr std::int64_t checkpoint_format = 2;

void write_checkpoint_file(MPI_Comm communicator, const std::filesystem::path& path, const Case& c,
                           const System& system, const Observers& observers, const Accounts& accounts) {
  io::Hdf5Writer archive(communicator, path);
  archive.attribute("run/format", checkpoint_format);
  archive.attribute("run/system", std::string(name_of(c.system)));
  archive.attribute("run/name", c.name);
  archive.attribute("run/version", version_number());  // the commit would make equal states differ
  archive.attribute("run/step", system.step());
  archive.attribute("run/time", system.time());
  archive.attribute("run/time_step", system.time_step());
  archive.attribute("run/spacing", c.domain.spacing);
  save_beds(archive, communicator, c);
  system.save(archive);
  accounts.save(archive, observers, c.output.series.every);
  archive.close();
}

// A lattice of as many cells of another size would be taken for this one, at other speeds. A column, which has no
// domain.spacing, looks at its cells itself.
static void refuse_other_spacing(const ArchiveReader& archive, const Case& c) {
  if (c.system == SystemKind::continuum || !archive.has("run/spacing")) return;
  const double saved = archive.real_attribute("run/spacing"), here = c.domain.spacing;
  if (same_but_for_rounding(saved, here)) return;
  throw InputError(
      fmt::format("its domain.spacing is {:.10g} m and that of this case {:.10g} m; a restart keeps it: set it back, "
                  "or begin a new run from that state with initial.from.",
                  saved, here));
}

// What does not fit names the file.
static void load_system(System& system, ArchiveReader& archive, const std::filesystem::path& path, const Case& c) {
  try {
    refuse_other_spacing(archive, c);
    system.load(archive);
  } catch (const io::DamagedFile&) {
    throw;
  } catch (const InputError& error) {
    const std::string reason = error.what();
    if (reason.starts_with(path.string())) throw;
    throw InputError(fmt::format("{}: {}", path.string(), reason));
  }
}

Accounts read_checkpoint_file(MPI_Comm communicator, const std::filesystem::path& path, const Case& c, System& system,
                              Observers& observers) {
  io::Hdf5Reader archive(communicator, path);
  if (!archive.has("run/system"))
    throw InputError(fmt::format("{} is an HDF5 file but not a checkpoint of this program.", path.string()));
  if (const std::int64_t format = archive.has("run/format") ? archive.integer_attribute("run/format") : 1;
      format > checkpoint_format)
    throw InputError(fmt::format(
        "{} was written by version {} in format {}, and this is version {}, which reads formats up to {}; go "
        "on with that version.",
        path.string(), archive.text_attribute("run/version"), format, version_number(), checkpoint_format));
  const std::string saved = archive.text_attribute("run/system");
  if (saved != name_of(c.system))
    throw InputError(fmt::format("{} holds a run with system: {}, but this case has system: {}.", path.string(), saved,
                                 name_of(c.system)));
  load_system(system, archive, path, c);
  return Accounts::load(archive, system, observers, c.output.series.every);
}

std::filesystem::path read_first_whole_checkpoint(MPI_Comm communicator,
                                                  const std::vector<std::filesystem::path>& checkpoints, const Case& c,
                                                  System& system, Observers& observers,
                                                  std::vector<std::string>& damage, Accounts& accounts) {
  for (const std::filesystem::path& path : checkpoints) {
    try {
      accounts = read_checkpoint_file(communicator, path, c, system, observers);
      return path;
    } catch (const io::DamagedFile& error) {
      if (path == checkpoints.back()) throw;
      damage.emplace_back(error.what());
    }
  }
  throw InputError("There is no checkpoint to go on from.");
}

}  // namespace thalweg::driver
