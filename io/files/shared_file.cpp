#include "io/files/shared_file.hpp"

#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "io/files/atomic_file.hpp"

#include <fmt/format.h>

#include <semaphore.h>

#include <algorithm>

namespace thalweg::io {
namespace {

constexpr std::size_t largest_part = std::size_t{1} << 30;  // MPI counts bytes with an int

// The pieces in parts that can be written at once; longer pieces are cut.
std::vector<std::vector<SharedFile::Piece>> in_parts(const std::vector<SharedFile::Piece>& pieces) {
  std::vector<std::vector<SharedFile::Piece>> parts;
  std::size_t room = 0;
  for (SharedFile::Piece piece : pieces) {
    while (!piece.bytes.empty()) {
      if (room == 0) {
        parts.emplace_back();
        room = largest_part;
      }
      const std::size_t size = std::min(room, piece.bytes.size());
      parts.back().push_back({piece.offset, piece.bytes.first(size)});
      piece = {piece.offset + size, piece.bytes.subspan(size)};
      room -= size;
    }
  }
  return parts;
}

// Layout of pieces in the file and in memory. A view of a file needs a type that is not empty, so without pieces it is
// MPI_BYTE, of which none is written.
struct Layout {
  MPI_Datatype in_file = MPI_BYTE, in_memory = MPI_BYTE;
  int bytes = 0;

  explicit Layout(const std::vector<SharedFile::Piece>& pieces) {
    std::vector<int> lengths;
    std::vector<MPI_Aint> offsets, addresses;
    for (const SharedFile::Piece& piece : pieces) {
      lengths.push_back(static_cast<int>(piece.bytes.size()));
      offsets.push_back(static_cast<MPI_Aint>(piece.offset));
      addresses.emplace_back();
      MPI_Get_address(piece.bytes.data(), &addresses.back());
      bytes += lengths.back();
    }
    if (bytes == 0) return;
    const auto count = static_cast<int>(lengths.size());
    MPI_Type_create_hindexed(count, lengths.data(), offsets.data(), MPI_BYTE, &in_file);
    MPI_Type_create_hindexed(count, lengths.data(), addresses.data(), MPI_BYTE, &in_memory);
    MPI_Type_commit(&in_file);
    MPI_Type_commit(&in_memory);
  }
  ~Layout() {
    if (bytes == 0) return;
    MPI_Type_free(&in_file);
    MPI_Type_free(&in_memory);
  }
  Layout(const Layout&) = delete;
  Layout& operator=(const Layout&) = delete;
};

}  // namespace

void forget_semaphore_of([[maybe_unused]] MPI_Comm communicator, [[maybe_unused]] const std::filesystem::path& file) {
#ifdef OPEN_MPI
  sem_unlink(("OMPIO_" + file.filename().string()).c_str());
  MPI_Barrier(communicator);
#endif
}

SharedFile::SharedFile(MPI_Comm communicator, const std::filesystem::path& path, std::uint64_t bytes)
    : communicator_(communicator), path_(path), partial_(path) {
  partial_ += ".partial";
  // MPI-IO keeps the length of a file it finds, and a failed collective open is not always collective, so the first
  // rank makes the file.
  bool made = true;
  if (rank_of(communicator_) == 0) {
    std::error_code ignored;
    std::filesystem::remove(partial_, ignored);
    made = create_file(partial_) && reserve_on_disk(partial_, 0, bytes);
  }
  agree(made);
  forget_semaphore_of(communicator_, partial_);
  good_ = MPI_File_open(communicator_, partial_.c_str(), MPI_MODE_WRONLY, MPI_INFO_NULL, &file_) == MPI_SUCCESS;
  agree(good_);
}

void SharedFile::write(const std::vector<Piece>& pieces) {
  const std::vector<std::vector<Piece>> parts = in_parts(pieces);
  std::uint64_t rounds = parts.size();
  MPI_Allreduce(MPI_IN_PLACE, &rounds, 1, MPI_UINT64_T, MPI_MAX, communicator_);
  for (std::size_t round = 0; round < rounds; ++round) {
    const Layout layout(round < parts.size() ? parts[round] : std::vector<Piece>());
    MPI_Status status;
    int written = 0;
    const bool well =
        MPI_File_set_view(file_, 0, MPI_BYTE, layout.in_file, "native", MPI_INFO_NULL) == MPI_SUCCESS &&
        MPI_File_write_all(file_, MPI_BOTTOM, layout.bytes > 0 ? 1 : 0, layout.in_memory, &status) == MPI_SUCCESS;
    if (well) MPI_Get_elements(&status, MPI_BYTE, &written);
    good_ = good_ && well && written == layout.bytes;
  }
}

void SharedFile::close() {
  good_ = MPI_File_close(&file_) == MPI_SUCCESS && good_;
  agree(good_);
  bool renamed = true;
  if (rank_of(communicator_) == 0) {
    std::error_code error;
    std::filesystem::rename(partial_, path_, error);
    renamed = !error;
  }
  agree(renamed);
}

void SharedFile::agree(bool good) {
  if (!any_rank(communicator_, !good)) return;
  std::error_code ignored;
  if (rank_of(communicator_) == 0) std::filesystem::remove(partial_, ignored);
  throw RunError(fmt::format("{}: cannot write the file; is the disk full or the folder missing or write-protected?",
                             path_.string()));
}

}  // namespace thalweg::io
