// Interface to a saved state, independent of the file format (io/ has HDF5).
//
// A path is "group/name". A dataset is a global array of up to four dimensions, slowest first; every rank writes or
// reads its own box of it. All calls are collective: every rank makes the same calls with the same paths and global
// shapes. Nothing that depends on the number of ranks goes into an archive.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace thalweg {

struct ArrayBox {
  std::vector<std::uint64_t> global_shape;  // of the whole dataset
  std::vector<std::uint64_t> offset;        // of this rank's box in it
  std::vector<std::uint64_t> shape;         // of this rank's box; a zero anywhere: this rank has nothing
};

// values: those of this rank's box, slowest dimension first. Attributes are the same on every rank. Throws RunError on
// every rank if writing fails, std::logic_error if box and values do not match.
class ArchiveWriter {
public:
  virtual ~ArchiveWriter() = default;
  virtual void write(const std::string& path, std::span<const double> values, const ArrayBox& box) = 0;
  virtual void write(const std::string& path, std::span<const float> values, const ArrayBox& box) = 0;
  virtual void write(const std::string& path, std::span<const std::int64_t> values, const ArrayBox& box) = 0;
  virtual void attribute(const std::string& path, double value) = 0;
  virtual void attribute(const std::string& path, std::int64_t value) = 0;
  virtual void attribute(const std::string& path, const std::string& value) = 0;
};

// Every read throws InputError (naming file and path) if the path is missing or has another shape or type.
class ArchiveReader {
public:
  virtual ~ArchiveReader() = default;
  virtual bool has(const std::string& path) const = 0;
  virtual std::vector<std::uint64_t> shape(const std::string& path) const = 0;
  virtual void read(const std::string& path, std::span<double> values, const ArrayBox& box) = 0;
  virtual void read(const std::string& path, std::span<float> values, const ArrayBox& box) = 0;
  virtual void read(const std::string& path, std::span<std::int64_t> values, const ArrayBox& box) = 0;
  virtual double real_attribute(const std::string& path) const = 0;
  virtual std::int64_t integer_attribute(const std::string& path) const = 0;
  virtual std::string text_attribute(const std::string& path) const = 0;
};

}  // namespace thalweg
