#include "driver/setup/checkpoint_file.hpp"

#include "core/base/error.hpp"
#include "core/base/round_off.hpp"
#include "driver/case/grain_setup.hpp"
#include "driver/input/case_changes.hpp"
#include "driver/input/case_reader.hpp"
#include "driver/setup/bed_archive.hpp"
#include "driver/setup/build_system.hpp"
#include "driver/setup/version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

namespace thalweg::driver {

namespace {

// Version of the checkpoint format; files without a number precede version 2.
constexpr std::int64_t checkpoint_format = 2;

// The kept case is a text in parts that an attribute has room for: it holds less than 64 kB, and more than eight
// attributes of a group would need tables of their own.
constexpr std::size_t part_size = 32000;  // bytes

std::string kept_part(std::size_t n) { return fmt::format("kept_case/part_{}", n); }

// Each of whole characters.
std::vector<std::string> kept_parts(const std::string& text) {
  const auto goes_on = [&](std::size_t at) { return (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U; };
  std::vector<std::string> parts;
  for (std::size_t begin = 0, end = 0; begin < text.size(); begin = end) {
    end = std::min(begin + part_size, text.size());
    while (end < text.size() && end > begin + 1 && goes_on(end)) --end;
    parts.push_back(text.substr(begin, end - begin));
  }
  return parts;
}

void save_kept_case(ArchiveWriter& archive, const std::string& text) {
  const std::vector<std::string> parts = kept_parts(text);
  archive.attribute("kept_case/parts", static_cast<std::int64_t>(parts.size()));
  for (std::size_t n = 0; n < parts.size(); ++n) archive.attribute(kept_part(n), parts[n]);
}

// m, of the axes along which the grains have neighbours beyond the end of the box; 0 for the others.
void save_periods(ArchiveWriter& archive, const Case& c) {
  if (!has_grains(c.system)) return;
  const PeriodicBox box = grain_box(c);
  for (std::size_t axis = 0; axis < 3; ++axis)
    archive.attribute(saved_period(axis), box.periodic[axis] ? box.size[static_cast<int>(axis)] : 0.0);
}

std::string load_kept_case(const ArchiveReader& archive) {
  std::string text;
  const auto parts = static_cast<std::size_t>(archive.integer_attribute("kept_case/parts"));
  for (std::size_t n = 0; n < parts; ++n) text += archive.text_attribute(kept_part(n));
  return text;
}

// A lattice of as many cells of another size would be taken for this one, at other speeds. A column, which has no
// domain.spacing, looks at its cells itself.
void refuse_other_spacing(const ArchiveReader& archive, const Case& c) {
  if (c.system == SystemKind::continuum || !archive.has("run/spacing")) return;
  const double saved = archive.real_attribute("run/spacing"), here = c.domain.spacing;
  if (same_but_for_rounding(saved, here)) return;
  throw InputError(
      fmt::format("its domain.spacing is {:.10g} m and that of this case {:.10g} m; a restart keeps it: set it back, "
                  "or begin a new run from that state with initial.from.",
                  saved, here));
}

// A checkpoint that has left its run folder has no case beside it to compare with.
void refuse_other_case(const ArchiveReader& archive, const Case& c) {
  if (!archive.has("kept_case/parts")) return;  // of an earlier version
  const bool dry = !has_fluid(c);
  refuse_changes_of_state(state_changes(load_kept_case(archive), resolved_yaml(c), dry), dry);
}

// Adds the file to errors about its contents; data of a wrong shape mean that it is damaged.
template <typename Work>
void about_file(const std::filesystem::path& path, Work&& work) {
  const auto names_the_file = [&](const InputError& error) {
    return std::string_view(error.what()).starts_with(path.string());
  };
  try {
    work();
  } catch (const DamagedFile& error) {
    if (names_the_file(error)) throw;
    throw DamagedFile(fmt::format("{}: {}", path.string(), error.what()));
  } catch (const InputError& error) {
    if (names_the_file(error)) throw;
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  } catch (const std::logic_error&) {  // of a vector or an archive
    throw DamagedFile(fmt::format(
        "{}: some of its data have the wrong shape, the file is damaged; take an earlier checkpoint.", path.string()));
  }
}

}  // namespace

std::string saved_period(std::size_t axis) { return fmt::format("run/period_{}", "xyz"[axis]); }

void require_checksums(io::Hdf5Reader& checkpoint) {
  if (checkpoint.has("run/format")) checkpoint.require_checksums();
}

std::string kept_case_of(const Case& c) { return state_of_case(resolved_yaml(c), !has_fluid(c)); }

void write_checkpoint_file(MPI_Comm communicator, const std::filesystem::path& path, const Case& c,
                           const std::string& kept_case, const System& system, const Observers& observers,
                           const RunHistory& run_history) {
  io::Hdf5Writer archive(communicator, path);
  archive.attribute("run/format", checkpoint_format);
  archive.attribute("run/system", std::string(name_of(c.system)));
  archive.attribute("run/name", c.name);
  archive.attribute("run/version", version_number());  // the commit would make equal states differ
  archive.attribute("run/step", system.step());
  archive.attribute("run/time", system.time());
  archive.attribute("run/time_step", system.time_step());
  archive.attribute("run/spacing", c.domain.spacing);
  save_periods(archive, c);
  save_kept_case(archive, kept_case);
  save_beds(archive, communicator, c);
  system.save(archive);
  run_history.save(archive, observers, c.output.series.every);
  archive.close();
}

RunHistory read_checkpoint_file(MPI_Comm communicator, const std::filesystem::path& path, const Case& c, System& system,
                                Observers& observers) {
  io::Hdf5Reader archive(communicator, path);
  if (!archive.has("run/system"))
    throw InputError(fmt::format("{} is an HDF5 file but not a checkpoint of this program.", path.string()));
  require_checksums(archive);
  if (const std::int64_t format = archive.has("run/format") ? archive.integer_attribute("run/format") : 1;
      format > checkpoint_format)
    throw InputError(
        fmt::format("{} was written by version {} in format {}, and this is version {}, which reads formats up to {}; "
                    "continue with that version.",
                    path.string(), archive.text_attribute("run/version"), format, version_number(), checkpoint_format));
  const std::string saved = archive.text_attribute("run/system");
  if (saved != name_of(c.system))
    throw InputError(fmt::format("{} holds a run with system: {}, but this case has system: {}.", path.string(), saved,
                                 name_of(c.system)));
  RunHistory run_history;
  about_file(path, [&] {
    refuse_other_spacing(archive, c);
    refuse_other_case(archive, c);
    system.load(archive);
    run_history = RunHistory::load(archive, system, observers, c.output.series.every);
  });
  return run_history;
}

std::filesystem::path read_first_whole_checkpoint(MPI_Comm communicator,
                                                  const std::vector<std::filesystem::path>& checkpoints, const Case& c,
                                                  System& system, Observers& observers,
                                                  const std::function<Observers()>& new_observers,
                                                  std::vector<std::string>& damage, RunHistory& run_history) {
  for (const std::filesystem::path& path : checkpoints) {
    try {
      run_history = read_checkpoint_file(communicator, path, c, system, observers);
      return path;
    } catch (const DamagedFile& error) {
      if (path == checkpoints.back()) throw;
      damage.emplace_back(error.what());
      observers = new_observers();
    }
  }
  throw InputError("There is no checkpoint to restart from.");
}

}  // namespace thalweg::driver
