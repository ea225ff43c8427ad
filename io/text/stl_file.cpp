#include "io/text/stl_file.hpp"

#include "core/base/error.hpp"
#include "core/parallel/on_first_rank.hpp"
#include "io/files/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>

namespace thalweg::io {
namespace {

// Single precision, as binary files have it, so that a text file gives the same corners.
using Corner = std::array<float, 3>;
using Facet = std::array<Corner, 3>;

// Joins corners at the same place.
class MeshOfFacets {
public:
  void add(const Facet& facet) {
    std::array<int, 3> corners{};
    for (int k = 0; k < 3; ++k) {
      Corner at = facet[k];
      for (float& x : at) x += 0.0F;  // -0 is the same place as 0
      const auto [known, is_new] = index_.try_emplace(at, static_cast<int>(mesh_.points.size()));
      if (is_new) mesh_.points.emplace_back(at[0], at[1], at[2]);
      corners[k] = known->second;
    }
    // Joined corners leave slivers without an area; they carry no surface.
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
      mesh_.triangles.push_back(corners);
  }
  TriangleMesh& mesh() { return mesh_; }

private:
  std::map<Corner, int> index_;
  TriangleMesh mesh_;
};

constexpr std::size_t header_size = 84, facet_size = 50;  // bytes of a binary file: a title and the count; each facet

std::uint64_t announced_facets(const std::string& bytes) {
  static_assert(std::endian::native == std::endian::little, "as the file is");
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + header_size - sizeof count, sizeof count);
  return count;
}

bool is_binary(const std::string& bytes) {
  return bytes.size() >= header_size && bytes.size() == header_size + facet_size * announced_facets(bytes);
}

void read_binary(const std::string& name, const std::string& bytes, MeshOfFacets& into) {
  for (std::uint64_t n = 0; n < announced_facets(bytes); ++n) {
    std::array<Corner, 4> normal_and_corners;
    std::memcpy(normal_and_corners.data(), bytes.data() + header_size + n * facet_size, sizeof normal_and_corners);
    const Facet facet{normal_and_corners[1], normal_and_corners[2], normal_and_corners[3]};
    for (const Corner& corner : facet)
      if (!std::all_of(corner.begin(), corner.end(), [](float x) { return std::isfinite(x); }))
        throw InputError(
            fmt::format("{}: a corner of facet {} of {} lies at ({}, {}, {}); repair the surface where it was made.",
                        name, n + 1, announced_facets(bytes), corner[0], corner[1], corner[2]));
    into.add(facet);
  }
}

bool is_word(std::string_view text, std::string_view word) {
  return std::equal(text.begin(), text.end(), word.begin(), word.end(),
                    [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); });
}

// The words of a text one after the other, each with its line.
class Words {
public:
  explicit Words(std::string_view text) : text_(text) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text_.starts_with(byte_order_mark)) at_ = byte_order_mark.size();
  }

  // Empty at the end of the text.
  std::string_view next() {
    while (at_ < text_.size() && is_blank(text_[at_])) pass();
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }
  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '\r') ++at_;
  }
  int line() const { return line_; }  // of the latest word, from 1 on

private:
  static bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
  // A line ends with \n, \r\n or \r.
  void pass() {
    const bool ends = text_[at_] == '\n' || (text_[at_] == '\r' && text_.substr(at_ + 1, 1) != "\n");
    line_ += ends ? 1 : 0;
    ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

class TextReader {
public:
  TextReader(std::string name, std::string_view text, MeshOfFacets& into)
      : name_(std::move(name)), words_(text), into_(into) {}

  // Reads from "solid NAME" on; a file may have several.
  void read() {
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
      if (is_word(word, "facet"))
        read_facet();
      else if (is_word(word, "solid") || is_end(word, "solid"))
        words_.skip_line();
      else
        wrong(word, "facet or endsolid");
    }
  }

private:
  void read_facet() {
    expect("normal");
    for (int k = 0; k < 3; ++k) words_.next();  // follows from the corners; files without one write anything here
    expect("outer");
    expect("loop");
    Facet facet;
    for (Corner& corner : facet) {
      expect("vertex");
      for (float& x : corner) x = number();
    }
    expect_end("loop");
    expect_end("facet");
    into_.add(facet);
  }

  void expect(std::string_view what) {
    if (const std::string_view word = words_.next(); !is_word(word, what)) wrong(word, what);
  }
  void expect_end(std::string_view of) {
    if (const std::string_view word = words_.next(); !is_end(word, of))
      wrong(word, is_word(word, "vertex") ? "the end of the facet after three corners" : fmt::format("end{}", of));
  }
  // "endloop", or "end loop" as some programs write it.
  bool is_end(std::string_view word, std::string_view of) {
    return is_word(word, fmt::format("end{}", of)) || (is_word(word, "end") && is_word(words_.next(), of));
  }

  // Fortran programs write 1.0D-03.
  float number() {
    const std::string_view word = words_.next();
    std::string digits(word.substr(word.starts_with('+') ? 1 : 0));
    std::replace_if(
        digits.begin(), digits.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');
    double value = 0.0;
    const char* end = digits.data() + digits.size();
    const auto [parsed, error] = std::from_chars(digits.data(), end, value);
    const auto rounded = static_cast<float>(value);
    if (error != std::errc() || parsed != end || !std::isfinite(rounded)) wrong(word, "a finite coordinate");
    return rounded;
  }

  [[noreturn]] void wrong(std::string_view word, std::string_view expected) const {
    const std::string place = fmt::format("{}:{}", name_, words_.line());
    if (word.empty())
      throw InputError(
          fmt::format("{}: the file ends where it should have {}: it is cut off; write it again.", place, expected));
    constexpr std::size_t enough = 40;  // characters to find the place
    throw InputError(
        fmt::format("{}: \"{}\" stands where an STL file has {}; correct this line, or write the file again.", place,
                    word.substr(0, enough), expected));
  }

  std::string name_;
  Words words_;
  MeshOfFacets& into_;
};

// Refuses a file that is neither a whole binary file nor begins as a text file.
[[noreturn]] void refuse(const std::string& name, const std::string& bytes) {
  const bool is_text = bytes.find('\0') == std::string::npos;
  if (is_text || bytes.size() < header_size)
    throw InputError(
        fmt::format("{}:1: this is not an STL file, which begins with the word solid if it is text and has {} bytes "
                    "and more if it is binary; give an STL file.",
                    name, header_size));
  throw InputError(
      fmt::format("{}: this is not a text STL, and as a binary one it should have {} bytes, for the {} facets of its "
                  "header, and has {}: it is cut off, or its header is wrong; write it again.",
                  name, header_size + facet_size * announced_facets(bytes), announced_facets(bytes), bytes.size()));
}

}  // namespace

TriangleMesh read_stl(const std::filesystem::path& path, const Ranks& ranks) {
  const std::string name = path.string();
  const std::string bytes = told_by_first_rank(ranks.communicator(), [&] {
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(path, unknown) && unknown != std::errc::permission_denied)
      throw InputError(fmt::format("{}: there is no such file; give an STL file.", name));
    std::string text = read_text(path);
    constexpr std::size_t largest = std::size_t{1} << 34;  // bytes, of less than 2^31 corners
    if (text.size() > largest)
      throw InputError(fmt::format("{}: the file has {} bytes, and no more than {} are read; give a coarser surface.",
                                   name, text.size(), largest));
    return text;
  });
  MeshOfFacets facets;
  if (is_binary(bytes))  // whatever its title says
    read_binary(name, bytes, facets);
  else if (bytes.find('\0') == std::string::npos && is_word(Words(bytes).next(), "solid"))
    TextReader(name, bytes, facets).read();
  else
    refuse(name, bytes);
  TriangleMesh& mesh = facets.mesh();
  if (mesh.triangles.empty())
    throw InputError(fmt::format("{}: the file has no facet with an area; write it again.", name));
  const std::string open = what_is_open(mesh);
  if (!open.empty())
    throw InputError(fmt::format("{}: the surface is not closed: {}; repair it where it was made.", name, open));
  const double volume = signed_volume(mesh);
  double reach = 0.0;  // from the origin
  for (const Vec3& point : mesh.points) reach = std::max(reach, point.norm());
  constexpr double rounding = 1e-14;  // of the volume of a surface, over that of its reach
  if (!(std::abs(volume) > rounding * reach * reach * reach))
    throw InputError(fmt::format("{}: the surface is flat and encloses no volume; repair it where it was made.", name));
  if (volume < 0.0) turn_inside_out(mesh);
  return std::move(mesh);
}

}  // namespace thalweg::io
