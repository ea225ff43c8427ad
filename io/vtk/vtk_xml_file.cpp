#include "io/vtk/vtk_xml_file.hpp"

#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "io/files/shared_file.hpp"

#include <fmt/format.h>
#include <vtkSmartPointer.h>
#include <vtkZLibDataCompressor.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <fstream>
#include <string_view>
#include <type_traits>
#include <utility>

namespace thalweg::io {
namespace {

static_assert(std::endian::native == std::endian::little, "the files say so");

constexpr std::int64_t rows_per_block = 4096;  // 16 kB of the smallest numbers
constexpr std::string_view head_of_time =
    "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">";
constexpr const char* footer = "\n  </AppendedData>\n</VTKFile>\n";

template <typename Number>
std::string head_of(const std::string& name, int components) {
  const char* type = std::is_same_v<Number, double>         ? "Float64"
                     : std::is_same_v<Number, float>        ? "Float32"
                     : std::is_same_v<Number, std::int64_t> ? "Int64"
                                                            : "Int32";
  return fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\"", type, name,
                     components);
}

}  // namespace

VtkXmlFile::VtkXmlFile(MPI_Comm communicator, std::int64_t rows)
    : communicator_(communicator), share_(rows, rows_per_block, size_of(communicator)) {}

void VtkXmlFile::set_rows(std::int64_t rows) { share_ = {rows, rows_per_block, size_of(communicator_)}; }

void VtkXmlFile::add(const std::string& section, const std::string& name, int components,
                     std::span<const double> values) {
  add(section, head_of<double>(name, components), components * sizeof(double), std::as_bytes(values));
}
void VtkXmlFile::add(const std::string& section, const std::string& name, int components,
                     std::span<const float> values) {
  add(section, head_of<float>(name, components), components * sizeof(float), std::as_bytes(values));
}
void VtkXmlFile::add(const std::string& section, const std::string& name, int components,
                     std::span<const std::int64_t> values) {
  add(section, head_of<std::int64_t>(name, components), components * sizeof(std::int64_t), std::as_bytes(values));
}
void VtkXmlFile::add(const std::string& section, const std::string& name, int components,
                     std::span<const std::int32_t> values) {
  add(section, head_of<std::int32_t>(name, components), components * sizeof(std::int32_t), std::as_bytes(values));
}

void VtkXmlFile::add(const std::string& section, const std::string& head, std::size_t bytes_per_row,
                     std::span<const std::byte> values) {
  Array array{section, head, share_, bytes_per_row, {}, {}};
  auto compressor = vtkSmartPointer<vtkZLibDataCompressor>::New();  // which every reader knows
  compressor->SetCompressionLevel(1);  // half the time of the default level 5, and half a per cent more bytes
  const std::size_t block = bytes_per_row * static_cast<std::size_t>(rows_per_block);
  for (std::size_t begin = 0; begin < values.size(); begin += block) {
    const std::span<const std::byte> part = values.subspan(begin, std::min(block, values.size() - begin));
    const std::size_t room = compressor->GetMaximumCompressionSpace(part.size()), before = array.data.size();
    array.data.resize(before + room);
    const std::size_t size = compressor->Compress(reinterpret_cast<const unsigned char*>(part.data()), part.size(),
                                                  reinterpret_cast<unsigned char*>(array.data.data() + before), room);
    if (size == 0) throw RunError("An array of a picture cannot be compressed; is the memory full?");
    array.data.resize(before + size);
    array.sizes.push_back(size);
  }
  arrays_.push_back(std::move(array));
}

// The first three words before the data of an array: the number of blocks, and the size of a block and of a last one
// that is shorter (0: it is not), uncompressed. The compressed sizes of all blocks follow.
std::vector<std::uint64_t> VtkXmlFile::header_of(const Array& array) {
  const auto rest = static_cast<std::uint64_t>(array.share.rows() % rows_per_block);
  return {static_cast<std::uint64_t>(array.share.blocks()),
          static_cast<std::uint64_t>(rows_per_block) * array.bytes_per_row, rest * array.bytes_per_row};
}

std::uint64_t VtkXmlFile::header_bytes(const Array& array) {
  return sizeof(std::uint64_t) * (3 + array.share.blocks());
}

// Locations of this rank's data; `total` becomes the size of all appended data.
std::vector<VtkXmlFile::Location> VtkXmlFile::places(std::uint64_t& total) const {
  std::vector<std::uint64_t> here, before, all;
  for (const Array& array : arrays_) here.push_back(array.data.size());
  before.assign(here.size(), 0);
  all.assign(here.size(), 0);
  const auto count = static_cast<int>(here.size());
  MPI_Exscan(here.data(), before.data(), count, MPI_UINT64_T, MPI_SUM, communicator_);
  MPI_Allreduce(here.data(), all.data(), count, MPI_UINT64_T, MPI_SUM, communicator_);
  const int me = rank_of(communicator_);
  std::vector<Location> result;
  total = 0;
  for (std::size_t n = 0; n < arrays_.size(); ++n) {
    const std::uint64_t ours = me == 0 ? 0 : before[n];  // not defined on the first rank
    const auto first_block = static_cast<std::uint64_t>(arrays_[n].share.blocks_of(me).first);
    const std::uint64_t header = header_bytes(arrays_[n]);
    result.push_back({total, total + sizeof(std::uint64_t) * (3 + first_block), total + header + ours});
    total += header + all[n];
  }
  return result;
}

void VtkXmlFile::write(const std::filesystem::path& path, double time, const std::string& type,
                       const std::string& attributes, const std::string& piece_attributes) const {
  std::uint64_t appended = 0;
  const std::vector<Location> at = places(appended);
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n  <{0}{1}>\n    <FieldData>\n      {2}{3}"
      "</DataArray>\n    </FieldData>\n    <Piece{4}>\n",
      type, attributes, head_of_time, time, piece_attributes);
  for (std::size_t n = 0; n < arrays_.size(); ++n) {
    const std::string& section = arrays_[n].section;
    if (n == 0 || arrays_[n - 1].section != section) text += fmt::format("      <{}>\n", section);
    text += fmt::format("        {} offset=\"{}\"/>\n", arrays_[n].head, at[n].header);
    if (n + 1 == arrays_.size() || arrays_[n + 1].section != section) text += fmt::format("      </{}>\n", section);
  }
  text += fmt::format("    </Piece>\n  </{}>\n  <AppendedData encoding=\"raw\">\n   _", type);

  const bool first = rank_of(communicator_) == 0;
  const std::string_view end(footer);
  std::vector<std::vector<std::uint64_t>> headers;  // the first rank's block sizes follow its header at once
  headers.reserve(arrays_.size());
  std::vector<SharedFile::Piece> pieces;
  if (first) pieces.push_back({0, std::as_bytes(std::span(text))});
  for (std::size_t n = 0; n < arrays_.size(); ++n) {
    std::vector<std::uint64_t>& words = headers.emplace_back();
    if (first) words = header_of(arrays_[n]);
    words.insert(words.end(), arrays_[n].sizes.begin(), arrays_[n].sizes.end());
    pieces.push_back({text.size() + (first ? at[n].header : at[n].sizes), std::as_bytes(std::span(words))});
    pieces.push_back({text.size() + at[n].data, arrays_[n].data});
  }
  if (first) pieces.push_back({text.size() + appended, std::as_bytes(std::span(end))});
  SharedFile file(communicator_, path, text.size() + appended + end.size());
  file.write(pieces);
  file.close();
}

std::optional<double> VtkXmlFile::time_in(const std::filesystem::path& path) {
  std::string head(2048, '\0');  // more than what stands before the time
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  const std::size_t found = head.find(head_of_time);
  if (found == std::string::npos) return std::nullopt;
  double time = 0.0;
  const char* end = head.data() + head.size();
  const auto parsed = std::from_chars(head.data() + found + head_of_time.size(), end, time);
  return parsed.ec == std::errc() && parsed.ptr != end && *parsed.ptr == '<' ? std::optional(time) : std::nullopt;
}

}  // namespace thalweg::io
