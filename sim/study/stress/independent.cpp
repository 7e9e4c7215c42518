#include "sim/study/stress/independent.hpp"

#include <gmpxx.h>

#include <algorithm>

namespace halfplane::stress {
namespace {

/// floor(value * scale + 1/2).
mpz_class snapped(double value, const mpz_class& scale) {
  const mpq_class moved = mpq_class(value) * mpq_class(scale) + mpq_class(1, 2);
  mpz_class floor;
  mpz_fdiv_q(floor.get_mpz_t(), moved.get_num_mpz_t(), moved.get_den_mpz_t());
  return floor;
}

/// z = (d - a x - b y) / c, coordinates in subpixels, depth in codes.
struct ExactPlane {
  mpz_class a, b, c, d;
};

ExactPlane plane_through(const Scene& scene, std::size_t first_index, const Config& config) {
  const mpz_class pixel = mpz_class(1) << static_cast<mp_bitcnt_t>(config.subpixel_bits);
  const mpz_class codes = (mpz_class(1) << static_cast<mp_bitcnt_t>(config.depth_bits)) - 1;
  std::array<std::array<mpz_class, 3>, 3> p;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vertex& v = scene.vertices[scene.indices[first_index + i]];
    p[i] = {snapped(v.x, pixel), snapped(v.y, pixel), snapped(v.z, codes)};
  }
  const auto difference = [&p](std::size_t i, std::size_t k) { return mpz_class(p[i][k] - p[0][k]); };
  ExactPlane plane;  // the cross product of two edges
  plane.a = difference(1, 1) * difference(2, 2) - difference(1, 2) * difference(2, 1);
  plane.b = difference(1, 2) * difference(2, 0) - difference(1, 0) * difference(2, 2);
  plane.c = difference(1, 0) * difference(2, 1) - difference(1, 1) * difference(2, 0);
  plane.d = plane.a * p[0][0] + plane.b * p[0][1] + plane.c * p[0][2];
  return plane;
}

bool can_judge(const Scene& scene, const Config& config) {
  if (config.depth_format != DepthFormat{} || config.depth_mapping != DepthMapping::projection) return false;
  for (const Command& command : scene.commands) {
    const auto* draw = std::get_if<Draw>(&command);
    if (draw == nullptr) continue;
    const State& s = scene.states[draw->state];
    if (draw->topology != Topology::triangles || s.space != Space::window || s.polygon_mode != PolygonMode::fill ||
        s.polygon_offset != std::array{0.0, 0.0} || s.pixel_center != PixelCenter::half ||
        s.origin != Origin::top_left || !s.depth_write)
      return false;
  }
  return true;
}

}  // namespace

std::optional<double> measured_depth_error(const Scene& scene, const Config& config, const Engine& engine) {
  if (!can_judge(scene, config)) return std::nullopt;
  std::vector<std::size_t> first_index;  // of each primitive
  for (const Command& command : scene.commands)
    if (const auto* draw = std::get_if<Draw>(&command))
      for (std::size_t i = 0; i + 2 < draw->count; i += 3) first_index.push_back(draw->first + i);
  RenderOptions options;
  options.want_ids = true;
  const Rendering rendering = engine(scene, config, options);
  const mpz_class doubled_pixel = mpz_class(2) << static_cast<mp_bitcnt_t>(config.subpixel_bits);
  mpq_class worst = 0;
  std::int32_t known = -1;
  ExactPlane plane;
  std::size_t p = 0;
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x, ++p) {
      const std::int32_t id = rendering.ids[p];
      if (id < 0) continue;
      if (id != known) plane = plane_through(scene, first_index[static_cast<std::size_t>(id)], config);
      known = id;
      const mpz_class px = doubled_pixel * x + doubled_pixel / 2, py = doubled_pixel * y + doubled_pixel / 2;  // halves
      const mpz_class stored(static_cast<unsigned long>(rendering.frame.depth[rendering.frame.at(x, y)]));
      mpq_class error(stored * 2 * plane.c - (2 * plane.d - plane.a * px - plane.b * py), 2 * plane.c);
      error.canonicalize();
      worst = std::max(worst, mpq_class(abs(error)));
    }
  return worst.get_d();
}

}  // namespace halfplane::stress
