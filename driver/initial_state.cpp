#include "driver/initial_state.hpp"

#include "core/error.hpp"
#include "io/hdf5_archive.hpp"
#include "io/run_folder.hpp"

#include <fmt/format.h>

namespace thalweg::driver {

namespace {

// Does something with the source of a field, if there is one, so that an InputError names its key.
template <typename Work>
void about_source(const Case& c, InitialField field, Work&& work) {
  const InitialSource source = c.initial.source_of(field);
  if (source.path.empty()) return;
  try {
    work(io::checkpoint_at(source.path));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{} = {}: {}", source.key, source.path, error.what()));
  }
}

void refuse_state_without(InitialField field, const io::Hdf5Reader& archive, const std::filesystem::path& path) {
  if (field == InitialField::grains && !archive.has("grains/radius"))
    throw InputError(fmt::format("{} holds no grains; give a run with system: resolved or grains.", path.string()));
  if (field == InitialField::fluid && !archive.has("fluid/populations_00"))
    throw InputError(fmt::format("{} holds no fluid; give a run with system: resolved or fluid.", path.string()));
}

}  // namespace

void check_initial_sources(const Case& c) {
  for (const InitialField field : {InitialField::grains, InitialField::fluid})
    about_source(c, field, [&](const std::filesystem::path& path) {
      const io::Hdf5Reader archive(path);
      refuse_state_without(field, archive, path);
      if (field != InitialField::grains) return;
      if (const auto saved = static_cast<std::int64_t>(archive.shape("grains/radius").at(0)); saved != grain_rows(c))
        throw InputError(fmt::format("There are {} grains, but this case has {}; give populations with as many.", saved,
                                     grain_rows(c)));
    });
}

void take_initial_fields(MPI_Comm communicator, const Case& c, System& system) {
  // The fluid last: what it is taken for depends on where the grains are.
  for (const InitialField field : {InitialField::grains, InitialField::fluid})
    about_source(c, field, [&](const std::filesystem::path& path) {
      io::Hdf5Reader archive(communicator, path);
      refuse_state_without(field, archive, path);
      const double spacing = archive.real_attribute("run/spacing");
      if (field == InitialField::grains)
        system.take_grains(archive, spacing);
      else
        system.take_fluid(archive, spacing);
    });
}

}  // namespace thalweg::driver
