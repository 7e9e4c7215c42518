// The OBJ reader: meshes of good files, and messages for bad ones.
#include "sim/scene/obj.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "model/config.hpp"
#include "sim/scene/polygon.hpp"
#include "sim/scene/random.hpp"

namespace halfplane::obj_test {
namespace {

struct Parsed {
  Mesh mesh;
  std::vector<std::string> warnings;
};

// `library` is the file that every mtllib line finds; empty: none.
Parsed parse(const std::string& text, const std::string& library = "") {
  Parsed result;
  const auto source = [&library](const std::string&) {
    return library.empty() ? std::nullopt : std::optional<std::string>(library);
  };
  result.mesh = parse_obj(text, "test.obj", source, result.warnings);
  return result;
}

// The message with which a file is refused; empty if it is taken.
std::string refusal(const std::string& text, const std::string& library = "") {
  try {
    (void)parse(text, library);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void expect_refusal(const std::string& text, const std::string& start, const std::string& part) {
  const std::string message = refusal(text);
  EXPECT_EQ(message.substr(0, start.size()), start) << message;
  EXPECT_NE(message.find(part), std::string::npos) << message;
  EXPECT_NE(message.find("; "), std::string::npos) << "no mend in: " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Vec3 area_vector(const Vec3& a, const Vec3& b, const Vec3& c) {
  return scaled(cross(subtract(b, a), subtract(c, a)), 0.5);
}

// A triangulation is right if all triangles keep the polygon's side and their areas add up to the polygon's: nothing
// overlaps, nothing is left out. Every corner must be used.
void expect_exact_cover(const std::vector<Vec3>& polygon, const std::string& name) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  ASSERT_TRUE(triangulate_polygon(polygon, triangles)) << name;
  ASSERT_EQ(triangles.size(), polygon.size() - 2) << name;
  Vec3 whole{};
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    whole = add(whole, area_vector(polygon[0], polygon[i], polygon[i + 1]));
  double sum = 0;
  std::vector<bool> used(polygon.size(), false);
  for (const auto& t : triangles) {
    const Vec3 area = area_vector(polygon[t[0]], polygon[t[1]], polygon[t[2]]);
    EXPECT_GE(dot(area, normalized(whole)), -1e-9 * length(whole)) << name;
    sum += length(area);
    for (const std::uint32_t corner : t) used[corner] = true;
  }
  EXPECT_NEAR(sum, length(whole), 1e-9 * length(whole)) << name;
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0) << name;
}

// Lays the polygon on a slanted plane, away from the origin.
std::vector<Vec3> slanted(const std::vector<std::array<double, 2>>& flat) {
  const Vec3 x = normalized({1, 0.5, -0.3}), y = normalized(cross({0.2, -1, 0.7}, x));
  std::vector<Vec3> result;
  for (const auto& p : flat) result.push_back(add({3, -7, 2}, add(scaled(x, p[0]), scaled(y, p[1]))));
  return result;
}

TEST(Polygon, ConcaveOnesAreCoveredOnceByTheirTriangles) {
  expect_exact_cover(slanted({{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}}), "arrow");
  expect_exact_cover(slanted({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}}), "corners on straight edges");
  expect_exact_cover(slanted({{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 2}, {2, 2}, {2, 1}, {0, 1}}), "C");
  // A hole joined to the outline by a bridge that is walked both ways.
  expect_exact_cover(slanted({{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}, {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}}),
                     "bridged hole");
  std::vector<std::array<double, 2>> comb{{0, 0}, {20, 0}};
  for (int i = 20; i >= 0; --i) comb.push_back({static_cast<double>(i), i % 2 == 0 ? 5.0 : 1.0});
  expect_exact_cover(slanted(comb), "comb");
}

TEST(Polygon, RandomStarsAndSpiralsAreCoveredOnceByTheirTriangles) {
  Random random(7);
  for (int round = 0; round < 300; ++round) {
    const int count = 4 + static_cast<int>(random.next() % 60);
    std::vector<std::array<double, 2>> star, spiral;
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * (i + random.uniform(0, 0.9)) / count, r = random.uniform(0.1, 5);
      star.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    for (int i = 0; i <= count; ++i) {  // out along one arm, back along the other
      const double angle = 0.35 * i;
      spiral.push_back({(1 + angle) * std::cos(angle), (1 + angle) * std::sin(angle)});
    }
    for (int i = count; i >= 0; --i) {
      const double angle = 0.35 * i, r = 1 + angle + random.uniform(1, 3);
      spiral.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    expect_exact_cover(slanted(star), "star " + std::to_string(round));
    expect_exact_cover(slanted(spiral), "spiral " + std::to_string(round));
    if (HasFailure()) return;
  }
}

TEST(Polygon, OnesWithoutAreaAndCrossingOnesStillBecomeTriangles) {
  const std::vector<std::vector<Vec3>> odd{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}},
                                           {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1, 0, 0}},
                                           {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}},
                                           {{0, 0, 0}, {3, 0, 0}, {0, 2, 0}, {3, 2, 0}, {1, -1, 0}}};
  for (const auto& polygon : odd) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    EXPECT_TRUE(triangulate_polygon(polygon, triangles));
    EXPECT_EQ(triangles.size(), polygon.size() - 2);
  }
}

TEST(Obj, NegativeIndicesCountBackFromTheLineTheyAreOn) {
  const Mesh mesh = parse(kSquare + "f -4 -3 -2\nv 5 5 5\nf -5 -3 -2\n").mesh;
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.vertices[mesh.triangles[0][0]].position, (Vec3{0, 0, 0}));
  EXPECT_EQ(mesh.vertices[mesh.triangles[0][2]].position, (Vec3{1, 1, 0}));
  EXPECT_EQ(mesh.vertices[mesh.triangles[1][0]].position, (Vec3{0, 0, 0}));
  EXPECT_EQ(mesh.vertices[mesh.triangles[1][2]].position, (Vec3{0, 1, 0}));
}

TEST(Obj, CornersThatAgreeShareOneVertex) {
  EXPECT_EQ(parse(kSquare + "f 1 2 3\nf 1 3 4\n").mesh.vertices.size(), 4u);
  const std::string uvs = "vt 0 0\nvt 1 1\n";
  EXPECT_EQ(parse(kSquare + uvs + "f 1/1 2/1 3/1\nf 1/2 3/1 4/1\n").mesh.vertices.size(), 5u);
}

TEST(Obj, EveryCornerFormIsRead) {
  const std::string more = "vt 0.25 0.5\nvn 0 0 2\n";
  for (const char* face : {"f 1 2 3\n", "f 1/1 2/1 3/1\n", "f 1//1 2//1 3//1\n", "f 1/1/1 2/-1/-1 3/1/1\n"}) {
    const Mesh mesh = parse(kSquare + more + face).mesh;
    ASSERT_EQ(mesh.vertices.size(), 3u) << face;
    const MeshVertex& vertex = mesh.vertices[1];
    EXPECT_EQ(vertex.normal, (Vec3{0, 0, 1})) << face;
    const bool has_uv = std::string_view(face).find("/1") != std::string_view::npos && face[3] == '/' && face[4] != '/';
    EXPECT_EQ(vertex.u, has_uv ? 0.25 : 0) << face;
  }
}

TEST(Obj, WithoutSmoothingEachFaceHasItsOwnNormalAndWithItTheyAreAveraged) {
  const std::string roof = "v 0 0 0\nv 0 0 1\nv 1 1 0\nv 1 1 1\nv 2 0 0\nv 2 0 1\n";
  const std::string faces = "f 1 2 4 3\nf 3 4 6 5\n";
  const Mesh smooth = parse(roof + faces).mesh, flat = parse(roof + "s off\n" + faces).mesh;
  EXPECT_EQ(smooth.vertices.size(), 6u);
  EXPECT_EQ(flat.vertices.size(), 8u);
  for (const MeshVertex& vertex : smooth.vertices) {
    EXPECT_NEAR(vertex.normal[1], vertex.position[1] == 1 ? 1 : std::sqrt(0.5), 1e-12);  // the ridge: straight up
  }
  for (const MeshVertex& vertex : flat.vertices) EXPECT_NEAR(std::abs(vertex.normal[0]), std::sqrt(0.5), 1e-12);
}

TEST(Obj, MaterialsGiveColoursAndOpacity) {
  const std::string text = "mtllib a.mtl\n" + kSquare + "usemtl red paint\nf 1 2 3\nusemtl half\nf 1 3 4\n";
  const auto [mesh, warnings] = parse(text, "newmtl red paint\nKd 1 0 0.2\nnewmtl half\nKd 0.5\nd 0.25\n");
  EXPECT_TRUE(warnings.empty());
  EXPECT_TRUE(mesh.lit);
  EXPECT_EQ(mesh.vertices[mesh.triangles[0][0]].rgba, (std::array<double, 4>{255, 0, 51, 255}));
  EXPECT_EQ(mesh.vertices[mesh.triangles[1][0]].rgba, (std::array<double, 4>{127.5, 127.5, 127.5, 63.75}));
}

TEST(Obj, AMissingLibraryOrMaterialIsOneWarningEach) {
  const auto [mesh, warnings] = parse("mtllib a.mtl\nmtllib a.mtl\n" + kSquare + "usemtl x\nf 1 2 3\nf 1 3 4\n");
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0].find("test.obj:1: no material library 'a.mtl'"), 0u) << warnings[0];
  EXPECT_EQ(warnings[1].find("test.obj:8: no material 'x'"), 0u) << warnings[1];
  EXPECT_EQ(mesh.triangles.size(), 2u);
}

TEST(Obj, ABrokenMaterialNamesTheLibraryAndTheLine) {
  const std::string text = "mtllib a.mtl\n" + kSquare + "f 1 2 3\n";
  const auto warning = [&text](const std::string& library) {
    const auto [mesh, warnings] = parse(text, library);
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(warnings.size(), 1u) << library;
    return warnings.empty() ? "" : warnings[0];
  };
  EXPECT_EQ(warning("newmtl a\nKd 1 x 0\nKd y\n").find("a.mtl:2: green of Kd 'x'"), 0u);
  EXPECT_EQ(warning("Kd 1 1 0\n").find("a.mtl:1: "), 0u);
  EXPECT_EQ(warning("newmtl a\nKd 1 1\n").find("a.mtl:2: blue of Kd is missing"), 0u);
  EXPECT_EQ(warning("newmtl a\nd nan\n").find("a.mtl:2: "), 0u);
  EXPECT_EQ(warning("newmtl a\nNs nan\n").find("a.mtl:2: exponent Ns 'nan'"), 0u);
  EXPECT_EQ(warning("newmtl a\nmap_Kd\n").find("a.mtl:2: map_Kd without a file"), 0u);
  EXPECT_EQ(warning("newmtl \nKd 1 0 0\n").find("a.mtl:1: newmtl without a name"), 0u);
}

TEST(Obj, VertexColoursAreTakenAsTheyAreInEitherRange) {
  for (const char* color : {" 1 0 0.2", " 255 0 51"}) {
    const Mesh mesh = parse(std::string("v 0 0 0") + color + "\nv 1 0 0 0 0 1\nv 0 1 0 0 0 0\nf 1 2 3\n").mesh;
    EXPECT_FALSE(mesh.lit);
    EXPECT_EQ(mesh.vertices[0].rgba, (std::array<double, 4>{255, 0, 51, 255})) << color;
    EXPECT_EQ(mesh.vertices[1].rgba,
              (std::array<double, 4>{0, 0, color[1] == '1' && color[2] == ' ' ? 255.0 : 1.0, 255}))
        << color;
  }
}

TEST(Obj, OnlyFacesWhoseCornersAllHaveColoursShowThem) {
  const std::string text = "mtllib a.mtl\nusemtl red\nv 0 0 0 1 1 0\nv 1 0 0 1 1 0\nv 0 1 0 1 1 0\nv 1 1 0\n";
  const Mesh mesh = parse(text + "f 1 2 3\nf 2 4 3\n", "newmtl red\nKd 1 0 0\n").mesh;
  EXPECT_TRUE(mesh.lit);
  for (std::size_t i = 0; i < 3; ++i) {
    const MeshVertex &colored = mesh.vertices[mesh.triangles[0][i]], &plain = mesh.vertices[mesh.triangles[1][i]];
    EXPECT_EQ(colored.rgba, (std::array<double, 4>{255, 255, 0, 255}));
    EXPECT_FALSE(mesh.materials[colored.material].has_header_light);
    EXPECT_EQ(plain.rgba, (std::array<double, 4>{255, 0, 0, 255}));
    EXPECT_TRUE(mesh.materials[plain.material].has_header_light);
  }
}

TEST(Obj, WhatIsDamagedBesidePlacesIsOneWarningAKind) {
  const std::string at5 = "test.obj:5: ";
  const std::pair<std::string, std::string> damaged[] = {
      {"f 1/1 2/1 3/1\nf 1/1 3/1 4/2\n", "vt index 1 of 0; it is taken as missing"},
      {"f 1//1 2//1 3//1\n", "vn index 1 of 0; it is taken as missing"},
      {"f 1/0 2 3\n", "index 0 in '1/0'"},
      {"f 1//0 2 3\n", "index 0 in '1//0'"},
      {"f 1/-1 2 3\n", "beyond the first of 0"},
      {"vn nan nan nan\nf 1//1 2//1 3//1\n", "x of vn 'nan'"},
      {"vt\nf 1/1 2/1 3/1\n", "u of vt is missing"},
      {"f 1 2\nf 3\nf 1 2 3\n", "a face of 2 corners is left out"},
      {"l 1\nf 1 2 3\n", "a line of fewer than two points is left out"},
      {"v 0 0 0 1 1\nf 1 2 3\n", "5 numbers"},
      {"v 0 0 0 1 1 256\nf 1 2 3\n", "colour of 256"},
      {"s x\nf 1 2 3\n", "smoothing group"},
      {"mtllib\nf 1 2 3\n", "mtllib without a name"}};
  for (const auto& [text, part] : damaged) {
    const auto [mesh, warnings] = parse(kSquare + text);
    ASSERT_EQ(warnings.size(), 1u) << text;
    EXPECT_EQ(warnings[0].find(at5), 0u) << warnings[0];
    EXPECT_NE(warnings[0].find(part), std::string::npos) << warnings[0];
    EXPECT_GE(mesh.triangles.size(), 1u);
    for (const MeshVertex& vertex : mesh.vertices) EXPECT_EQ(length(vertex.normal), 1) << text;
  }
}

TEST(Obj, LinesAndPointsAreDrawnInTheColourOfTheirMaterial) {
  const std::string text = "mtllib a.mtl\n" + kSquare + "usemtl red\nl 1 2/7 3\nl 3 -1\np 1 2\nf 1 2 3\n";
  const auto [mesh, warnings] = parse(text, "newmtl red\nKd 1 0 0\n");
  EXPECT_TRUE(warnings.empty());
  ASSERT_EQ(mesh.parts.size(), 3u);
  EXPECT_EQ(mesh.parts[1].topology, Topology::line_strip);
  EXPECT_EQ(mesh.parts[1].count, 6u) << "with the restart between them";
  EXPECT_EQ(mesh.indices[3], kRestart);
  EXPECT_EQ(mesh.parts[2].topology, Topology::points);
  EXPECT_EQ(mesh.parts[2].count, 2u);
  const MeshVertex& vertex = mesh.vertices[mesh.indices[5]];
  EXPECT_EQ(vertex.position, (Vec3{0, 1, 0}));
  EXPECT_EQ(vertex.normal, Vec3{}) << "not lit";
  EXPECT_EQ(vertex.rgba, (std::array<double, 4>{255, 0, 0, 255}));
  EXPECT_EQ(parse(kSquare + "l 1 2\n").mesh.parts.size(), 1u) << "without a face";
  expect_refusal(kSquare + "l 1 5\n", "test.obj:5: ", "v index 5 of 4");
}

TEST(Obj, NamesMayHoldHashesQuotesAndBlanks) {
  const std::string faces = "usemtl Material #1\nf 1 2 3\nusemtl Material #2\nf 1 3 4\nusemtl red # of all\nf 1 2 4\n";
  const auto [mesh, warnings] =
      parse("mtllib \"a.mtl\"\n" + kSquare + faces,
            "newmtl Material #1\nKd 1 0 0\nnewmtl Material #2\nKd 0 1 0\nnewmtl red\nKd 0 0 1\n");
  EXPECT_TRUE(warnings.empty());
  ASSERT_EQ(mesh.triangles.size(), 3u);
  for (std::size_t t = 0; t < 3; ++t) {
    std::array<double, 4> color{0, 0, 0, 255};
    color[t] = 255;
    EXPECT_EQ(mesh.vertices[mesh.triangles[t][0]].rgba, color);
  }
}

TEST(Obj, AByteOrderMarkIsPassedOverAndUtf16IsNamed) {
  const std::string mark = "\xEF\xBB\xBF";
  const auto [mesh, warnings] =
      parse(mark + "mtllib a.mtl\nusemtl red\n" + kSquare + "f 1 2 3\n", mark + "newmtl red\nKd 1 0 0\n");
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(mesh.vertices[0].rgba, (std::array<double, 4>{255, 0, 0, 255}));
  expect_refusal(std::string("\xFF\xFEv\0 \0", 6), "test.obj:1: ", "UTF-16");
  expect_refusal(std::string("\0v\0 ", 4), "test.obj:1: ", "UTF-16");
}

TEST(Obj, OpacityBlendsAndDOverrulesTr) {
  const std::string text = "mtllib a.mtl\n" + kSquare + "usemtl m\nf 1 2 3\n";
  const auto alpha = [&text](const std::string& lines) {
    const Mesh mesh = parse(text, "newmtl m\nKd 1 0 0\n" + lines).mesh;
    EXPECT_EQ(mesh.parts[0].alpha, mesh.vertices[0].rgba[3] < 255 ? AlphaMode::blend : AlphaMode::opaque);
    return mesh.vertices[0].rgba[3];
  };
  EXPECT_EQ(alpha(""), 255);
  EXPECT_EQ(alpha("d 0.4\n"), 102);
  EXPECT_EQ(alpha("Tr 0.4\n"), 153);
  EXPECT_EQ(alpha("Tr 0\n"), 255);
  EXPECT_EQ(alpha("d 1\nTr 1\n"), 255);
  EXPECT_EQ(alpha("Tr 1\nd 1\n"), 255);
}

TEST(Obj, ObjectsBecomePartsWithTheirNames) {
  const Mesh mesh = parse(kSquare + "o unused\no a b\nf 1 2 3\nf 1 3 4\ng c\nf 1 2 4\no a b\nf 2 3 4\n").mesh;
  EXPECT_EQ(mesh.objects, (std::vector<std::string>{"a b", "c"}));
  ASSERT_EQ(mesh.parts.size(), 3u);
  EXPECT_EQ(mesh.parts[0].count, 2u);
  EXPECT_EQ(mesh.parts[2].object, 0u);
  EXPECT_EQ(mesh.parts[1].line, 10u);
}

TEST(Obj, LineEndsContinuationsAndCommentsOfEveryKindAreRead) {
  const std::string text = "# comment\r\nv 0 0 0\r\nv 1 0 \\\r\n 0\rv 0 +1 0 # end\n\n\tf 1 \\\n 2 3";
  EXPECT_EQ(parse(text).mesh.triangles.size(), 1u);
  expect_refusal("v 0 0 0\r\nv 1 0 \\\r\n 0\rv 0 x 0\n", "test.obj:4: ", "y of v 'x'");
}

TEST(Obj, NumbersAreRoundedToTheNearestBinary64) {
  const Mesh mesh = parse("v 0.3 1e-400 123456789.123456789\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").mesh;
  EXPECT_EQ(mesh.vertices[0].position, (Vec3{0.3, 0, 123456789.123456789}));
}

TEST(Obj, BadFilesAreRefusedWithLineAndMend) {
  const std::string at5 = "test.obj:5: ";
  expect_refusal(kSquare + "f 1 2 5\n", at5, "v index 5 of 4");
  expect_refusal(kSquare + "f 1 2 -5\n", at5, "beyond the first of 4");
  expect_refusal(kSquare + "f 0 1 2\n", at5, "index 0");
  expect_refusal(kSquare + "f 1 2 3x4\n", at5, "'3x4'");
  expect_refusal(kSquare + "f 1/1/1/1 2 3\n", at5, "three parts");
  expect_refusal(kSquare + "f 1 2 99999999999999999999\n", at5, "whole numbers");
  expect_refusal(kSquare, "test.obj:1: ", "no faces");
  expect_refusal("", "test.obj:1: ", "no faces");
  expect_refusal("v 0 nan 0\n", "test.obj:1: ", "y of v 'nan'");
  expect_refusal("v 0 0 inf\n", "test.obj:1: ", "z of v 'inf'");
  expect_refusal("v 0 0 1e999\n", "test.obj:1: ", "'1e999'");
  expect_refusal("v 0 0 1e31\n", "test.obj:1: ", "beyond");
  expect_refusal("v 0 0\n", "test.obj:1: ", "z of v is missing");
  expect_refusal(std::string("v \x1b[31m\x01 0 0\n"), "test.obj:1: ", "?[31m?");
}

TEST(Obj, AConcavePolygonOfTooManyCornersIsRefusedByItsSize) {
  std::string text, face = "f";
  for (int i = 0; i < 5000; ++i) {
    const double angle = 2 * std::numbers::pi * i / 5000, r = i % 2 == 0 ? 1 : 0.9;
    text += "v " + std::to_string(r * std::cos(angle)) + " " + std::to_string(r * std::sin(angle)) + " 0\n";
    face += " " + std::to_string(i + 1);
  }
  expect_refusal(text + face + "\n", "test.obj:5001: ", "5000 corners");
}

/// A TGA of 2x2 texels, uncompressed, 24 bits: blue, green, red; the lower row first.
std::string tga(const std::array<std::array<char, 3>, 4>& rgb) {
  std::string bytes("\0\0\2\0\0\0\0\0\0\0\0\0\2\0\2\0\x18\0", 18);
  for (const auto& [r, g, b] : rgb) bytes += {b, g, r};
  return bytes;
}

TEST(Obj, ImagesAreFoundByTheirLastPartAndMapDBecomesAlpha) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "halfplane obj maps";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a.obj") << "mtllib C:\\models\\a.mtl\n" + kSquare +
                                         "vt 0 0\nvt 1 0\nvt 1 1\nusemtl m\nf 1/1 2/2 3/3\n";
  std::ofstream(folder / "a.mtl") << "newmtl m\nmap_Kd /somewhere/t#1.tga\nmap_d cut.tga\n";
  constexpr char kAll = '\xff';
  std::ofstream(folder / "t#1.tga", std::ios::binary) << tga({{{kAll, 0, 0}, {0, kAll, 0}, {0, 0, kAll}, {1, 2, 3}}});
  for (const bool is_smooth : {false, true}) {
    const char half = is_smooth ? '\x40' : kAll;
    std::ofstream(folder / "cut.tga", std::ios::binary)
        << tga({{{0, 0, 0}, {kAll, kAll, kAll}, {half, half, half}, {kAll, kAll, kAll}}});
    std::vector<std::string> warnings;
    const Mesh mesh = read_obj_file((folder / "a.obj").string(), warnings);
    EXPECT_EQ(warnings, std::vector<std::string>{});
    ASSERT_EQ(mesh.textures.size(), 1u);
    EXPECT_EQ(mesh.parts[0].alpha, is_smooth ? AlphaMode::blend : AlphaMode::mask);
    const auto& codes = mesh.textures[0].level.front().code;
    EXPECT_EQ(codes,
              (std::vector<std::uint32_t>{0xff000000, 0x00ff00ff, is_smooth ? 0x0000ff40u : 0x0000ffffu, 0x010203ff}));
  }
}

TEST(Obj, FilesFindTheirLibraryBesideThemselvesAndMissingFilesAreNamed) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "halfplane obj";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a.obj") << "mtllib a b.mtl\n" + kSquare + "usemtl m\nf 1 2 3 4\n";
  std::ofstream(folder / "a b.mtl") << "newmtl m\nKd 0 1 0\n";
  std::vector<std::string> warnings;
  const Mesh mesh = read_obj_file((folder / "a.obj").string(), warnings);
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(mesh.vertices[0].rgba, (std::array<double, 4>{0, 255, 0, 255}));
  for (const std::filesystem::path& bad : {folder / "none.obj", folder}) {
    try {
      (void)read_obj_file(bad.string(), warnings);
      ADD_FAILURE() << bad << " was taken";
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find(bad.string()), 0u) << error.what();
    }
  }
}

}  // namespace
}  // namespace halfplane::obj_test
