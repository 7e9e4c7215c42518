// A textured cube that turns, drawn on a Target frame by frame: for each frame a model, a view and a projection matrix, whose
// product takes the vertices to clip space. Prints what a frame costs; docs/library.md explains it.
//
// usage: turning_cube [FRAMES [THREADS [PICTURE.ppm]]]    The picture is that of the last frame.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <vector>

#include <halfplane/engines/target.hpp>

namespace {

constexpr int kWidth = 640, kHeight = 480;  // pixels
constexpr double kEye = 4;                  // its distance from the middle of the cube, whose half side is 1

/// Row after row; a vector stands to the right of it, as a column.
using Matrix = std::array<std::array<double, 4>, 4>;

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 4; ++k) c[i][j] += a[i][k] * b[k][j];
  return c;
}

Matrix turn_about_y(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{{c, 0, s, 0}, {0, 1, 0, 0}, {-s, 0, c, 0}, {0, 0, 0, 1}}};
}

Matrix move(double x, double y, double z) { return {{{1, 0, 0, x}, {0, 1, 0, y}, {0, 0, 1, z}, {0, 0, 0, 1}}}; }

/// OpenGL's, with 90 degrees from top to bottom: z from -w at the near plane to w at the far one.
Matrix perspective(double aspect, double near, double far) {
  return {{{1 / aspect, 0, 0, 0},
           {0, 1, 0, 0},
           {0, 0, -(far + near) / (far - near), -2 * far * near / (far - near)},
           {0, 0, -1, 0}}};
}

/// `v` with the position that the matrix takes (x, y, z, 1) to.
halfplane::Vertex moved(const Matrix& m, const halfplane::Vertex& v) {
  const auto row = [&](std::size_t i) { return m[i][0] * v.x + m[i][1] * v.y + m[i][2] * v.z + m[i][3]; };
  halfplane::Vertex to = v;
  to.x = row(0);
  to.y = row(1);
  to.z = row(2);
  to.w = row(3);
  return to;
}

struct Mesh {
  std::vector<halfplane::Vertex> vertices;
  std::vector<std::uint32_t> indices;
};

/// Six faces of four corners, counterclockwise from outside.
Mesh cube() {
  Mesh mesh;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double side = face % 2 == 0 ? 1 : -1;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& [u, v] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) {
      std::array<double, 3> at{};
      at[static_cast<std::size_t>(axis)] = side;
      at[static_cast<std::size_t>((axis + 1) % 3)] = side * (2 * u - 1);
      at[static_cast<std::size_t>((axis + 2) % 3)] = 2 * v - 1;
      halfplane::Vertex corner{at[0], at[1], at[2]};
      corner.rgba = {255, axis == 0 ? 128.0 : 255.0, axis == 1 ? 128.0 : 255.0, 255};
      corner.u = u;
      corner.v = v;
      mesh.vertices.push_back(corner);
    }
    for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U}) mesh.indices.push_back(first + i);
  }
  return mesh;
}

using Clock = std::chrono::steady_clock;

/// Microseconds since `start`, kept in `times`.
void note(std::vector<double>& times, Clock::time_point start) {
  times.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
}

void print_median(const char* name, std::vector<double>& times) {
  std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2), times.end());
  std::printf("%-8s %8.0f us\n", name, times[times.size() / 2]);
}

void write_picture(const char* path, const std::vector<std::uint16_t>& pixels) {
  std::ofstream file(path, std::ios::binary);
  file << "P6 " << kWidth << ' ' << kHeight << " 255\n";
  for (const std::uint16_t p : pixels)
    for (const int channel : {(p >> 11) * 255 / 31, (p >> 5 & 63) * 255 / 63, (p & 31) * 255 / 31})
      file.put(static_cast<char>(channel));
}

}  // namespace

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::max(1, std::atoi(argv[1])) : 100;
  halfplane::Target target(halfplane::preset("embedded"), kWidth, kHeight);
  target.set_threads(argc > 2 ? std::max(1, std::atoi(argv[2])) : 1);

  halfplane::State state;  // clip space
  state.cull = halfplane::Cull::back;
  state.texture = target.add_texture(
      halfplane::make_texture("squares", halfplane::pattern_image(halfplane::TexturePattern::chequer, 64, 64),
                              halfplane::TextureFormat::rgb565, halfplane::Mips::box));
  state.texture_min = halfplane::TextureMin::linear_mipmap_nearest;

  const Mesh mesh = cube();
  std::vector<halfplane::Vertex> clip(mesh.vertices.size());
  std::vector<std::uint16_t> pixels(std::size_t{kWidth} * kHeight);
  const Matrix projection = perspective(double{kWidth} / kHeight, 1, 100), view = move(0, 0, -kEye);

  std::vector<double> clear_us, draw_us, copy_us;
  std::uint64_t first_frame_pixels = 0;
  for (int frame = 0; frame < frames; ++frame) {
    const Matrix model = turn_about_y(2 * std::numbers::pi * frame / frames);
    const Matrix to_clip = product(projection, product(view, model));
    for (std::size_t i = 0; i < clip.size(); ++i) clip[i] = moved(to_clip, mesh.vertices[i]);

    auto start = Clock::now();
    target.clear({.color = {{20, 20, 30, 255}}, .depth = 1.0});
    note(clear_us, start);
    start = Clock::now();
    const halfplane::Counters drawn = target.draw(state, halfplane::Topology::triangles, clip, mesh.indices);
    note(draw_us, start);
    start = Clock::now();
    target.copy_to({.color = pixels.data(), .color_pitch = sizeof pixels[0] * kWidth});
    note(copy_us, start);
    if (frame == 0) first_frame_pixels = drawn.covered;
  }
  // What a draw costs when next to nothing is drawn.
  std::vector<double> small_us;
  const std::vector<halfplane::Vertex> small{{0, 0, 0}, {2.0 / kWidth, 0, 0}, {0, 2.0 / kHeight, 0}};
  for (int i = 0; i < frames; ++i) {
    const auto start = Clock::now();
    (void)target.draw({}, halfplane::Topology::triangles, small);
    note(small_us, start);
  }
  print_median("clear", clear_us);
  print_median("draw", draw_us);
  print_median("copy_to", copy_us);
  print_median("a pixel", small_us);
  if (argc > 3) write_picture(argv[3], pixels);

  // At first the eye sees one face alone, whose half side of 1 at a distance of kEye - 1 is a third of half the height.
  constexpr int kSide = kHeight / 3;
  std::printf("the first frame draws %llu pixels, of %d x %d\n", static_cast<unsigned long long>(first_frame_pixels),
              kSide, kSide);
  return first_frame_pixels == std::uint64_t{kSide} * kSide ? 0 : 1;
}
