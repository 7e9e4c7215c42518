#include "per_vertex_cycles.hpp"

#include "per_vertex.hpp"
#include "sim/show/report/hardware.hpp"

namespace halfplane {
namespace {

/// `part` of 3: which of the runs it is.
std::uint64_t cycles_of_frame(const Scene& scene, const Config& config, int part,
                              const std::function<void(double)>& progress) {
  RenderOptions options;
  if (progress) options.progress = [&progress, part](double fraction) { progress((part + fraction) / 3); };
  return run_cycles(scene, {config, {}, {}}, options).run.cycles;
}

}  // namespace

PerVertexCycles per_vertex_cycles(const Scene& scene, const Config& config,
                                  const std::function<void(double)>& progress) {
  PerVertexCycles result;
  const Scene at_vertices = lit_at_vertices(scene);
  std::vector<std::string_view> units{""};  // to be set; more than nearest texels only where the scene asks for them
  if (config.texture_unit == TextureUnitKind::off) units = {"nearest", "bilinear", "trilinear"};
  for (const std::string_view unit : units) {
    Config with = config;
    result.set.clear();
    const auto set_also = [&](std::string_view key, std::string_view value) {
      set(with, key, value);
      result.set.push_back(std::string(key) + "=" + std::string(value));
    };
    if (!unit.empty()) set_also("texture.unit", unit);
    if (config.shade_units == 0) set_also("shade.unit", "1");
    Config without = with;
    without.shade_units = 0;
    try {
      result.fragments = cycles_of_frame(scene, with, 0, progress);
      result.vertices = cycles_of_frame(at_vertices, with, 1, progress);
      result.without_unit = cycles_of_frame(at_vertices, without, 2, progress);
      result.refused.clear();
      return result;
    } catch (const InputError& error) {
      result = {};
      result.refused = error.what();
    }
  }
  return result;
}

}  // namespace halfplane
