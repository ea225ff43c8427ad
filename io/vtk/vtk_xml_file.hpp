// A frame for ParaView as one VTK XML file (.vtp, .vti; VTK User's Guide, "VTK XML formats"), which all ranks write
// together: no rank holds all of it, and its bytes do not depend on the number of ranks.
//
// An array is cut into blocks of the same number of rows; each rank compresses (zlib) and writes its own.
#pragma once

#include "core/parallel/rows_by_id.hpp"

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace thalweg::io {

class VtkXmlFile {
public:
  // rows: tuples of every array that is added next, over all ranks.
  VtkXmlFile(MPI_Comm communicator, std::int64_t rows);
  void set_rows(std::int64_t rows);

  // The rows that a rank adds and writes, and the first of this rank.
  const BlockShare& share() const { return share_; }
  std::int64_t first_row() const { return share_.rows_of(rank_of(communicator_)).first; }

  // Adds an array to a section of the piece ("PointData", "CellData", "Points", "Verts"); those of one section come one
  // after the other. values: this rank's rows, all components of a row together. The same calls on every rank.
  void add(const std::string& section, const std::string& name, int components, std::span<const double> values);
  void add(const std::string& section, const std::string& name, int components, std::span<const float> values);
  void add(const std::string& section, const std::string& name, int components, std::span<const std::int64_t> values);
  void add(const std::string& section, const std::string& name, int components, std::span<const std::int32_t> values);

  // Writes the file: a data set of this type ("PolyData", "ImageData") of one piece, with the attributes of either, and
  // its time (s) as the field data TimeValue, from which VTK's readers take it. Collective; throws RunError on every
  // rank.
  void write(const std::filesystem::path& path, double time, const std::string& type, const std::string& attributes,
             const std::string& piece_attributes) const;

  // The time (s) of a file; empty: it has none, or is no such file.
  static std::optional<double> time_in(const std::filesystem::path& path);

private:
  struct Array {
    std::string section, head;  // head: its element, without the offset
    BlockShare share;
    std::size_t bytes_per_row;
    std::vector<std::uint64_t> sizes;  // of this rank's blocks, compressed
    std::vector<std::byte> data;       // those blocks
  };
  struct Location {  // in the file, from the start of the appended data
    std::uint64_t header, sizes, data;
  };

  void add(const std::string& section, const std::string& head, std::size_t bytes_per_row,
           std::span<const std::byte> values);
  static std::uint64_t header_bytes(const Array& array);
  std::vector<Location> places(std::uint64_t& total) const;
  static std::vector<std::uint64_t> header_of(const Array& array);

  MPI_Comm communicator_;
  BlockShare share_;
  std::vector<Array> arrays_;
};

}  // namespace thalweg::io
