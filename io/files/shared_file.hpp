// A file that all ranks write together, through MPI-IO.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace thalweg::io {

// Before every opening of a file through MPI: Open MPI guards it by a semaphore that has the file's name and belongs to
// the node. A process that is killed at that moment leaves it taken, and everyone who opens a file of this name on this
// node would wait for ever. Collective.
void forget_semaphore_of(MPI_Comm communicator, const std::filesystem::path& file);

// Writes to `path` + ".partial" and gives the file its name in close(), so that a reader never opens half a file. All
// calls are collective, and so are the errors: the constructor and close() throw RunError on every rank if anything has
// failed on one of them, and no file is left. A file abandoned without close(), because a rank has failed elsewhere,
// stays open to the end of the program: closing it is collective.
class SharedFile {
public:
  // bytes: size of the whole file, the same on every rank. The room is taken at once.
  SharedFile(MPI_Comm communicator, const std::filesystem::path& path, std::uint64_t bytes);
  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;

  // Piece that a rank writes: bytes, and their offset in the file.
  struct Piece {
    std::uint64_t offset;
    std::span<const std::byte> bytes;
  };

  // Writes this rank's pieces, perhaps none, in order of their offsets.
  void write(const std::vector<Piece>& pieces);

  void close();

private:
  void agree(bool good);

  MPI_Comm communicator_;
  std::filesystem::path path_, partial_;
  MPI_File file_ = MPI_FILE_NULL;
  bool good_ = true;  // on this rank, so far
};

}  // namespace thalweg::io
