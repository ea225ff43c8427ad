// Surfaces in the dialects of STL that programs write, and what is wrong with others, with its line.
#include "io/text/stl_file.hpp"

#include "core/base/error.hpp"
#include "tests/io/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::io::stl_file_test {
namespace {

using testing::message_of;
using testing::put;
using testing::ScratchFolder;

using Corner = std::array<float, 3>;
using Facet = std::array<Corner, 3>;

// A tetrahedron with legs of 1/2 along the axes, wound outwards: of volume (1/2)^3/6 = 1/48.
const std::vector<Facet> tetrahedron = [] {
  const Corner o{0, 0, 0}, x{0.5, 0, 0}, y{0, 0.5, 0}, z{0, 0, 0.5};
  return std::vector<Facet>{{o, y, x}, {o, x, z}, {o, z, y}, {x, y, z}};
}();

// How a program writes a text file.
struct Dialect {
  std::string name = "", before = "", line_end = "\n", indent = "", end_loop = "endloop", end_facet = "endfacet",
              end_solid = "endsolid part", half = "0.5", normal = "0 0 0", title = "part";
};

std::string text_of(const Dialect& d, const std::vector<Facet>& facets = tetrahedron) {
  std::string text = d.before + "solid " + d.title + d.line_end;
  for (const Facet& facet : facets) {
    text += d.indent + "facet normal " + d.normal + d.line_end + d.indent + "outer loop" + d.line_end;
    for (const Corner& corner : facet) {
      text += d.indent + "vertex";
      for (const float x : corner) text += d.indent + " " + (x == 0.0F ? "0" : d.half);
      text += d.line_end;
    }
    text += d.indent + d.end_loop + d.line_end + d.indent + d.end_facet + d.line_end;
  }
  return text + d.end_solid + d.line_end;
}

std::string upper_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::string binary_of(const std::vector<Facet>& facets, std::uint32_t count, std::string title = "made by hand") {
  title.resize(80, ' ');
  std::string bytes = title + std::string(reinterpret_cast<const char*>(&count), sizeof count);
  for (const Facet& facet : facets) {
    bytes.append(sizeof(Corner), '\0');
    bytes.append(reinterpret_cast<const char*>(facet.data()), sizeof facet);
    bytes.append(2, '\0');
  }
  return bytes;
}

TriangleMesh mesh_of(const std::string& bytes) {
  const ScratchFolder folder;
  put(folder / "part.stl", bytes);
  return read_stl(folder / "part.stl");
}

void expect_tetrahedron(const TriangleMesh& mesh, std::size_t how_many = 1) {
  EXPECT_EQ(mesh.points.size(), 4 * how_many);
  EXPECT_EQ(mesh.triangles.size(), 4 * how_many);
  EXPECT_DOUBLE_EQ(signed_volume(mesh), static_cast<double>(how_many) / 48.0);
}

class Dialects : public ::testing::TestWithParam<Dialect> {};

TEST_P(Dialects, AreRead) { expect_tetrahedron(mesh_of(text_of(GetParam()))); }

INSTANTIATE_TEST_SUITE_P(
    All, Dialects,
    ::testing::Values(Dialect{"plain"}, Dialect{"byte_order_mark", "\xEF\xBB\xBF"},
                      Dialect{"blank_lines_first", "\n\n"}, Dialect{"windows", "", "\r\n"},
                      Dialect{"old_macintosh", "", "\r"}, Dialect{"indented", "", "\n", "\t  "},
                      Dialect{"separate_ends", "", "\n", "  ", "end loop", "end facet", "end solid part"},
                      Dialect{"mixed_case", "", "\n", "", "EndLoop", "ENDFACET", "EndSolid"},
                      Dialect{"no_end", "", "\n", "", "endloop", "endfacet", ""},
                      Dialect{"fortran", "", "\n", "", "endloop", "endfacet", "endsolid", "5.0D-01"},
                      Dialect{"fortran_small", "", "\n", "", "endloop", "endfacet", "endsolid", "+0.05d+1"},
                      Dialect{"exponent", "", "\n", "", "endloop", "endfacet", "endsolid", "500.E-3"},
                      Dialect{"no_normal", "", "\n", "", "endloop", "endfacet", "endsolid", "0.5", "nan -nan(ind) nan"},
                      Dialect{"words_in_the_title", "", "\n", "", "endloop", "endfacet", "endsolid facet", "0.5",
                              "0 0 1", "facet normal of a solid"}),
    [](const auto& dialect) { return dialect.param.name; });

TEST(StlFile, CaseDoesNotMatter) { expect_tetrahedron(mesh_of(upper_case(text_of({})))); }

TEST(StlFile, SeveralSolidsAreOneSurface) {
  std::vector<Facet> moved = tetrahedron;
  for (Facet& facet : moved)
    for (Corner& corner : facet) corner[0] += 2.0F;
  expect_tetrahedron(mesh_of(text_of({}) + text_of({.half = "0.5"}, {})), 1);
  std::vector<Facet> both = tetrahedron;
  both.insert(both.end(), moved.begin(), moved.end());
  expect_tetrahedron(mesh_of(binary_of(both, 8)), 2);
}

TEST(StlFile, BinaryWhateverItsTitleSays) {
  expect_tetrahedron(mesh_of(binary_of(tetrahedron, 4)));
  expect_tetrahedron(mesh_of(binary_of(tetrahedron, 4, "solid part")));
}

TEST(StlFile, WoundInwardsAndSliversAndNegativeZeroAreTakenCareOf) {
  std::vector<Facet> facets = tetrahedron;
  for (Facet& facet : facets) std::swap(facet[1], facet[2]);
  facets[0][0] = {-0.0F, 0.0F, -0.0F};
  facets.push_back({Corner{0, 0, 0}, Corner{0, 0, 0}, Corner{0.5, 0, 0}});
  expect_tetrahedron(mesh_of(binary_of(facets, 5)));
}

// The complaint about a file, without its path.
std::string complaint(const std::string& bytes) {
  const ScratchFolder folder;
  const std::string path = (folder / "part.stl").string();
  put(path, bytes);
  const std::string message = message_of<InputError>([&] { read_stl(path); });
  EXPECT_EQ(message.find(path), 0u) << message;
  return message.substr(std::min(message.size(), path.size()));
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(StlFile, ComplaintsAboutTextHaveTheLine) {
  const std::string good = text_of({});
  EXPECT_EQ(complaint(replaced(good, "vertex 0 0.5 0", "vertx 0 0.5 0")),
            ":5: \"vertx\" stands where an STL file has vertex; correct this line, or write the file again.");
  for (const char* wrong : {"inf", "nan", "1e400", "1e39", "0,5", "0.5m", "-"})
    EXPECT_EQ(complaint(replaced(good, "vertex 0 0.5 0", std::string("vertex 0 ") + wrong + " 0")),
              std::string(":5: \"") + wrong +
                  "\" stands where an STL file has a finite coordinate; correct this line, or write the file again.");
  EXPECT_EQ(
      complaint(replaced(good, "endloop", "vertex 1 1 1\nendloop")),
      ":7: \"vertex\" stands where an STL file has the end of the facet after three corners; correct this line, or "
      "write the file again.");
  EXPECT_EQ(
      complaint(replaced(good, "endfacet", "endfacet\ncolor 1 0 0")),
      ":9: \"color\" stands where an STL file has facet or endsolid; correct this line, or write the file again.");
  EXPECT_EQ(complaint(good.substr(0, good.find("vertex 0.5"))),
            ":6: the file ends where it should have vertex: it is cut off; write it again.");
  EXPECT_EQ(complaint(text_of({}, {})), ": the file has no facet with an area; write it again.");
  EXPECT_EQ(complaint(text_of({}, {tetrahedron[0], tetrahedron[1], tetrahedron[2]})),
            ": the surface is not closed: 3 edges belong to one triangle only; repair it where it was made.");
}

// Two triangles, back to back: closed, and nothing inside; away from the origin, where volumes are rounded.
TEST(StlFile, AFlatSurfaceIsRefused) {
  const Corner a{10.1F, 20.2F, 5.3F}, b{11.7F, 20.2F, 5.3F}, c{10.1F, 22.9F, 6.1F};
  EXPECT_EQ(complaint(binary_of({{a, b, c}, {a, c, b}}, 2)),
            ": the surface is flat and encloses no volume; repair it where it was made.");
}

TEST(StlFile, OtherFilesAreRefused) {
  for (const char* other : {"", "v 0 0 0\nf 1 2 3\n", "no geometry at all\n"})
    EXPECT_EQ(
        complaint(other),
        ":1: this is not an STL file, which begins with the word solid if it is text and has 84 bytes and more if it "
        "is binary; give an STL file.");
  EXPECT_EQ(message_of<InputError>([] { read_stl("nowhere.stl"); }),
            "nowhere.stl: there is no such file; give an STL file.");
}

TEST(StlFile, ABinaryFileMustFitItsHeader) {
  const std::string end = ": it is cut off, or its header is wrong; write it again.";
  EXPECT_EQ(
      complaint(binary_of(tetrahedron, 0x2aaaaaaa)),
      ": this is not a text STL, and as a binary one it should have 35791394184 bytes, for the 715827882 facets of "
      "its header, and has 284" +
          end);
  EXPECT_NE(complaint(binary_of(tetrahedron, 3, "solid part")).find("234 bytes, for the 3 facets"), std::string::npos);
  EXPECT_NE(complaint(binary_of(tetrahedron, 4).substr(0, 250)).find("and has 250"), std::string::npos);
}

TEST(StlFile, BinaryCornersMustBeFinite) {
  for (const float wrong : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    std::vector<Facet> facets = tetrahedron;
    facets[1][2][2] = wrong;
    EXPECT_NE(complaint(binary_of(facets, 4)).find(": a corner of facet 2 of 4 lies at (0, 0, "), std::string::npos);
  }
}

}  // namespace
}  // namespace thalweg::io::stl_file_test
