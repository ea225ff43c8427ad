#include "io/hdf5/profile_file.hpp"

#include "core/state/whole_dataset.hpp"
#include "io/hdf5/hdf5_archive.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace thalweg::io {

void write_profiles(MPI_Comm communicator, const std::filesystem::path& path, double time,
                    const ProfileGroups& groups) {
  Hdf5Writer file(communicator, path);
  file.attribute("time", time);
  file.attribute("time_unit", std::string("s"));
  for (const auto& [name, profiles] : groups)
    for (const Profile& profile : profiles) {
      const std::string location = name + "/" + profile.name;
      write_whole(file, communicator, location, std::span<const double>(profile.values), profile.shape);
      file.attribute(location + "/unit", profile.unit);
      if (!profile.components.empty())
        file.attribute(location + "/components", fmt::format("{}", fmt::join(profile.components, " ")));
    }
  file.close();
}

}  // namespace thalweg::io
