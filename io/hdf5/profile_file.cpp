#include "io/hdf5/profile_file.hpp"

#include "core/parallel/mpi_session.hpp"
#include "io/hdf5/hdf5_archive.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace thalweg::io {

void write_profiles(MPI_Comm communicator, const std::filesystem::path& path, double time,
                    const ProfileGroups& groups) {
  Hdf5Writer file(communicator, path);
  file.attribute("time", time);
  file.attribute("time_unit", std::string("s"));
  const bool first = rank_of(communicator) == 0;
  for (const auto& [name, profiles] : groups)
    for (const Profile& profile : profiles) {
      const std::string place = name + "/" + profile.name;
      const std::vector<std::uint64_t> nothing(profile.shape.size(), 0);
      const std::span<const double> values = profile.values;
      file.write(place, first ? values : values.first(0), {profile.shape, nothing, first ? profile.shape : nothing});
      file.attribute(place + "/unit", profile.unit);
      if (!profile.components.empty())
        file.attribute(place + "/components", fmt::format("{}", fmt::join(profile.components, " ")));
    }
  file.close();
}

}  // namespace thalweg::io
