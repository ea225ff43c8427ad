#include "io/hdf5/profile_file.hpp"

#include "io/hdf5/hdf5_archive.hpp"
#include "io/hdf5/labelled_arrays.hpp"

namespace thalweg::io {

void write_profiles(MPI_Comm communicator, const std::filesystem::path& path, double time,
                    const ProfileGroups& groups) {
  Hdf5Writer file(communicator, path);
  file.attribute("time", time);
  file.attribute("time_units", std::string("s"));
  ArrayLabeller arrays(file);
  for (const auto& [name, profiles] : groups)
    for (const Profile& profile : profiles) arrays.write(name, profile);
  arrays.name_dimensions();
  file.close();
}

}  // namespace thalweg::io
