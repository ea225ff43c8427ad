// ParaView's list of the frames of a series with their times: a .pvd file.
//
// A new frame is appended in one write, in place of the file's last two lines; a kill within that write can leave the
// end of the list unreadable until the run goes on, never an entry before it. A restart adds what the list lacks from
// the frames themselves, each of which holds its time (io/vtk/vtk_xml_file.hpp).
#pragma once

#include <mpi.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::io {

// Rank 0 reads and writes. All calls are collective and throw RunError on every rank.
class PvdIndex {
public:
  struct Entry {
    double time;       // s
    std::string file;  // relative to the folder of the index
  };

  // Lists the frames NAME/NAME_<step>.* beside NAME.pvd. continue_from: take up those up to that time (s), and remove
  // later frames, which are of a course that a restart has left. Empty: start with none.
  PvdIndex(MPI_Comm communicator, std::filesystem::path path, std::optional<double> continue_from);

  // Adds a frame (in place of one of the same time).
  void add(double time, const std::filesystem::path& file);

  // The frames that have been added, and the index, outlast a loss of power once this returns: before a checkpoint that
  // counts on them.
  void put_on_disk();

  const std::vector<Entry>& entries() const { return entries_; }  // on rank 0

private:
  void take_up(double until);
  void append(const Entry& entry);
  void rewrite();

  MPI_Comm communicator_;
  std::filesystem::path path_;
  std::vector<Entry> entries_;
  std::uint64_t end_of_entries_ = 0;              // place of the next one, bytes; 0: there is no file yet
  std::vector<std::filesystem::path> new_files_;  // since put_on_disk()
};

// Takes up every index in a folder that has frames as a run does that goes on from this time (s). Collective; throws
// RunError on every rank.
void take_up_indices(MPI_Comm communicator, const std::filesystem::path& folder, double continue_from);

}  // namespace thalweg::io
