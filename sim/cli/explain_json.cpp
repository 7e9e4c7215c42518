#include <array>
#include <cmath>

#include "model/draw_states.hpp"
#include "model/packets/packet_words.hpp"
#include "model/stages/depth_encode.hpp"
#include "model/stages/multisample.hpp"
#include "model/stages/stencil_packets.hpp"
#include "sim/cli/explain_output.hpp"
#include "sim/study/explain/verify.hpp"
#include "sim/words.hpp"

namespace halfplane::explain {
namespace {

constexpr std::array<std::string_view, 3> kTileClasses{"outside", "cut", "inside"};

std::string name_of(Stage stage) { return std::string(info(stage).name); }
std::string name_of(Verdict verdict) { return std::string(info(verdict).name); }

double grid_to_lsb(std::int64_t value) { return std::ldexp(static_cast<double>(value), -exact::kGridBits); }

Json stored_json(const Stored& stored, const Config& config, int depth_bits, bool has_owner, bool has_stencil) {
  Json json{{"depth", hex_text(stored.depth, depth_bits)},
            {"color", hex_text(stored.color, config.color_format == ColorFormat::rgb565 ? 16 : 32)}};
  if (has_stencil) json["stencil"] = stored.stencil;
  if (has_owner) json["owner"] = stored.owner < 0 ? Json(nullptr) : Json(stored.owner);
  return json;
}

Json corners_json(const Entry& entry, const Widths& widths) {
  Json corners = Json::array();
  for (const SnappedVertex& v : entry.corners) {
    Json codes = Json::object();
    for (std::size_t p = 0; p < static_cast<std::size_t>(widths.affine_planes); ++p)
      codes[std::string(widths.plane_name(p))] = v.code[p];
    corners.push_back({{"x", v.x},
                       {"y", v.y},
                       {"x_pixels", std::ldexp(v.x, -widths.grid_bits)},
                       {"y_pixels", std::ldexp(v.y, -widths.grid_bits)},
                       {"codes", codes}});
  }
  return corners;
}

Json edges_json(const Entry& entry, const Widths& widths) {
  Json edges = Json::array();
  for (const EdgeFigure& e : entry.edges)
    edges.push_back({{"from", e.from},
                     {"to", e.to},
                     {"side", e.side},
                     {"owns_ties", e.owns_ties},
                     {"tie", e.is_tie()},
                     {"value", e.value},
                     {"bits", hex_text(static_cast<std::uint64_t>(e.value), e.bits)},
                     {"exact", e.exact},
                     {"real", std::ldexp(static_cast<double>(e.exact), -2 * widths.grid_bits)}});
  return edges;
}

Json planes_json(const Entry& entry) {
  Json planes = Json::object();
  for (const PlaneFigure& p : entry.planes)
    planes[std::string(p.name)] = {{"unrounded", p.unrounded},
                                   {"fraction_bits", p.guard_bits},
                                   {"real", std::ldexp(static_cast<double>(p.unrounded), -p.guard_bits)},
                                   {"code", p.code},
                                   {"bits", hex_text(p.code, p.bits)}};
  return planes;
}

Json texel_color(const Texel& texel) { return Json{texel[0], texel[1], texel[2], texel[3]}; }

Json surface_json(const SurfaceFigure& figure) {
  const SurfaceSample& s = figure.sample;
  Json json{{"primitive_color", texel_color(s.primitive)}, {"color", texel_color(s.color)}};
  if (figure.is_lit)
    json["light"] = {{"normal", s.normal},
                     {"diffuse", std::ldexp(s.light.diffuse, -kLightFraction)},
                     {"specular", std::ldexp(s.light.specular, -kLightFraction)},
                     {"color", texel_color(s.lit)}};
  if (s.fog_q != 0) json["fog"] = {{"q", s.fog_q}, {"factor", std::ldexp(s.fog, -kFogFactorBits)}};
  if (figure.texture.empty()) return json;
  json["texture"] = figure.texture;
  json["coordinate"] = {s.coordinate[0], s.coordinate[1]};
  json["place"] = {s.place.coordinate[0], s.place.coordinate[1]};
  json["place_fraction_bits"] = s.place.fraction_bits;
  json["level_of_detail"] = std::ldexp(s.lod, -kLodFraction);
  json["filter"] = figure.filter.is_linear ? "linear" : "nearest";
  json["between_levels"] = figure.filter.is_between;
  Json texels = Json::array();
  for (const TexelFigure& t : figure.texels) {
    texels.push_back({{"level", t.level},
                      {"x", t.x},
                      {"y", t.y},
                      {"weight", std::ldexp(t.weight, -24)},
                      {"address", t.address},
                      {"color", texel_color(t.color)}});
    if (t.is_border) texels.back()["border"] = true;
  }
  json["texels"] = texels;
  json["texel"] = texel_color(s.texel);
  return json;
}

Json steps_json(const std::vector<LineStep>& steps) {
  Json json = Json::array();
  for (const LineStep& s : steps)
    json.push_back({{"step", s.step},
                    {"x", s.x},
                    {"y", s.y},
                    {"error", s.error},
                    {"decision", s.moves ? "diagonal" : "straight"}});
  return json;
}

Json line_json(const LineFigure& line) {
  Json rules = Json::object();
  for (const LineWalk& walk : line.walks)
    rules[std::string(kLineRuleNames[static_cast<std::size_t>(walk.rule)])] = steps_json(walk.steps);
  return {{"rule", kLineRuleNames[static_cast<std::size_t>(line.rule)]},
          {"major_axis", line.is_x_major ? "x" : "y"},
          {"major", line.major},
          {"minor", line.minor},
          {"registers", rules},
          {"textbook", {{"bresenham", steps_json(line.bresenham)}, {"midpoint", steps_json(line.midpoint)}}}};
}

Json triangle_steps_json(const std::vector<TriangleStep>& steps, int guard_bits) {
  Json json = Json::array();
  for (const TriangleStep& s : steps) {
    Json step{{"x", s.x},
              {"y", s.y},
              {"tile", kTileClasses[static_cast<std::size_t>(s.tile)]},
              {"edges", {s.value[0], s.value[1], s.value[2]}},
              {"covered", s.covered}};
    if (s.covered)
      step["depth"] = {{"unrounded", s.depth.unrounded},
                       {"real", std::ldexp(static_cast<double>(s.depth.unrounded), -guard_bits)},
                       {"code", s.depth.code}};
    json.push_back(step);
  }
  return json;
}

Json operations_json(const Entry& entry) {
  Json operations = Json::array();
  for (const OperationStep& step : entry.operations) {
    Json json{{"operation", step.name}, {"stage", name_of(step.stage)}};
    if (step.passes) json["passes"] = *step.passes;
    for (const Figure& f : step.figures) {
      const std::string name(f.name);
      if (f.bits == 0)
        json[name] = f.text;
      else if (f.values.size() == 1)
        json[name] = hex_text(f.values[0], f.bits);
      else
        json[name] = f.values;
    }
    operations.push_back(json);
  }
  return operations;
}

Json fields_json(Arrow arrow, const std::vector<std::uint32_t>& words, const Widths& widths) {
  return with_packet_type(arrow, [&]<class Packet>(std::type_identity<Packet>) {
    Json fields = Json::object();
    const auto values = element_values<Packet>(words.data(), widths);
    std::size_t next = 0;
    for (const auto& [name, width] : element_names<Packet>(widths)) fields[name] = hex_text(values[next++], width.bits);
    return fields;
  });
}

Json hardware_json(const HardwareFigure& figure, const PacketStore& store, const Widths& widths) {
  Json json{{"verdict", name_of(figure.outcome.verdict)}, {"stage", name_of(figure.outcome.stage)}};
  json["hiz"] = nullptr;
  if (figure.hiz) {
    const int bits = widths.depth().code.bits;
    json["hiz"] = {{"nearest", hex_text(figure.hiz->nearest, bits)},
                   {"farthest", hex_text(figure.hiz->farthest, bits)},
                   {"rejects", figure.hiz->rejects}};
  }
  Json packets = Json::array();
  for (const PacketId& id : figure.packets) {
    const RecordedPacket& packet = store.at(id);
    packets.push_back({{"arrow", std::string(info(id.first).name)},
                       {"number", id.second},
                       {"cycle", packet.model_cycle},
                       {"fields", fields_json(id.first, packet.model, widths)}});
  }
  json["packets"] = packets;
  return json;
}

Json model_json(const Entry& entry, const Explanation& all, const PixelHistory& pixel, const Config& config,
                const Widths& widths) {
  Json json{{"verdict", name_of(entry.specification.verdict)},
            {"stage", name_of(entry.specification.stage)},
            {"clipped", entry.is_cut},
            {"corners", corners_json(entry, widths)}};
  if (entry.kind == Kind::triangle)
    json["area"] = {{"value", entry.area},
                    {"real", std::ldexp(static_cast<double>(entry.area), -2 * widths.grid_bits)}};
  if (entry.kind == Kind::point) {
    json["size"] = entry.point_size;
    json["shape"] = entry.point_shape == PointShape::round ? "round" : "square";
  }
  if (!entry.box.is_empty()) json["box"] = {entry.box.left, entry.box.top, entry.box.right, entry.box.bottom};
  if (!entry.edges.empty()) json["edges"] = edges_json(entry, widths);
  if (entry.tile)
    json["tile"] = {{"x", pixel.at.x >> widths.tile_shift},
                    {"y", pixel.at.y >> widths.tile_shift},
                    {"class", kTileClasses[static_cast<std::size_t>(*entry.tile)]}};
  if (entry.shaded_at) json["shaded_at"] = *entry.shaded_at == kAtCentre ? Json("centre") : Json(*entry.shaded_at);
  if (!entry.planes.empty()) json["planes"] = planes_json(entry);
  if (entry.surface) json["surface"] = surface_json(*entry.surface);
  if (entry.line) json["line"] = line_json(*entry.line);
  if (!entry.steps.empty()) json["steps"] = triangle_steps_json(entry.steps, config.local_guard_bits);
  json["operations"] = operations_json(entry);
  json["hardware"] = entry.hardware ? hardware_json(*entry.hardware, all.packets, widths) : Json(nullptr);
  return json;
}

Json golden_json(const GoldenFigure& golden) {
  Json json{{"verdict", golden_verdict(golden)}};
  if (golden.outline) {
    Json corners = Json::array();
    for (std::size_t i = 0; i < golden.outline->corners; ++i)
      corners.push_back(
          {{"x_pixels", golden.outline->x[i]}, {"y_pixels", golden.outline->y[i]}, {"z", golden.outline->z[i]}});
    json["corners"] = corners;
  }
  if (!golden.edges.empty()) json["edges"] = golden.edges;
  if (golden.fragment) {
    json["depth"] = golden.fragment->depth;
    json["stored_depth"] = golden.fragment->stored_depth;
    json["color"] = golden.fragment->color;
  }
  return json;
}

Json oracle_json(const Entry& entry) {
  Json json{{"covers", entry.oracle->covers}, {"on_border", entry.oracle->is_on_border}};
  Json planes = Json::object();
  for (const PlaneFigure& p : entry.planes)
    planes[std::string(p.name)] = {{"numerator", decimal(p.oracle.numerator)},
                                   {"denominator", decimal(p.oracle.denominator)},
                                   {"real", to_real(p.oracle)}};
  json["planes"] = planes;
  if (entry.surface) json["surface_color"] = entry.surface->errors.exact;
  return json;
}

Json parts_json(const Entry& entry) {
  Json parts = Json::object();
  for (const PlaneFigure& p : entry.planes)
    if (p.parts)
      parts[std::string(p.name)] = {{"snap", grid_to_lsb(p.parts->snap)},
                                    {"interpolation", grid_to_lsb(p.parts->interpolation)},
                                    {"storage", grid_to_lsb(p.parts->storage)},
                                    {"total", grid_to_lsb(p.parts->snap + p.parts->interpolation + p.parts->storage)}};
  return parts;
}

Json rtl_json(const HardwareFigure& figure, const PacketStore& store, const Widths& widths) {
  Json packets = Json::array();
  std::size_t differing = 0;
  for (const PacketId& id : figure.packets) {
    const RecordedPacket& packet = store.at(id);
    Json json{{"arrow", std::string(info(id.first).name)}, {"number", id.second}, {"cycle", packet.rtl_cycle}};
    Json fields = Json::array();
    if (packet.rtl.empty())
      json["missing"] = true;
    else
      for (const std::string& field : differing_fields(id, packet, widths)) fields.push_back(field);
    differing += packet.rtl.empty() || !fields.empty() ? 1 : 0;
    json["differs"] = fields;
    packets.push_back(json);
  }
  return {{"packets", packets}, {"differing", differing}};
}

Json entry_json(const Entry& entry, const PixelHistory& pixel, const Explanation& all, const Config& config,
                const Widths& widths) {
  Json json{{"primitive", entry.primitive},
            {"draw", entry.draw},
            {"kind", kKindNames[static_cast<std::size_t>(entry.kind)]},
            {"piece", entry.piece},
            {"stage", name_of(entry.outcome.stage)},
            {"verdict", name_of(entry.outcome.verdict)},
            {"why", entry.outcome.why},
            {"model", model_json(entry, all, pixel, config, widths)}};
  if (all.samples > 1) json["sample"] = pixel.sample;
  json["golden"] = entry.golden ? golden_json(*entry.golden) : Json(nullptr);
  json["oracle"] = entry.oracle ? oracle_json(entry) : Json(nullptr);
  json["parts"] = parts_json(entry);
  json["rtl"] = pixel.rtl && entry.hardware ? rtl_json(*entry.hardware, all.packets, widths) : Json(nullptr);
  return json;
}

/// The final stored values; null for hardware.
Json final_json(const Resolved& of, const Scene& scene, const Config& config) {
  const int depth_bits = DepthEncode(config, scene.planes).format().bits;
  Json golden = stored_json(of.golden.rounded, config, depth_bits, true, false);
  golden["depth_real"] = of.golden.depth;
  golden["color_real"] = of.golden.color;
  return {{"model", stored_json(of.model, config, depth_bits, true, true)},
          {"engine", stored_json(of.engine, config, depth_bits, true, true)},
          {"golden", golden},
          {"hardware", nullptr},
          {"rtl", nullptr}};
}

}  // namespace

std::string hex_text(std::uint64_t value, int bits) { return "0x" + hex_digits(value, bits); }

double to_real(const exact::Rational& value) {
  return static_cast<double>(static_cast<long double>(value.numerator) / static_cast<long double>(value.denominator));
}

std::string_view golden_verdict(const GoldenFigure& golden) {
  if (!golden.fragment) return golden.outline ? "uncovered" : "dropped";
  const golden::Fate& fate = golden.fragment->fate;
  if (fate.written) return "written";
  if (fate.killed) return "alpha";
  if (fate.passed) return "masked";
  return fate.stencil_failed ? "stencil" : "depth";
}

std::string_view state_word(std::string_view state, const State& of) {
  const DrawState& row = draw_state(state);
  const StateValue value = row.value(of);
  return value.word < row.words.size() ? row.words[value.word] : std::string_view("set");
}

Json pixel_json(PixelSamples pixel, const Explanation& all, const Scene& scene, const Config& config) {
  const Widths widths = derive_widths(config);
  const PixelHistory& first = pixel.front();
  Json json{{"x", first.at.x}, {"y", first.at.y}, {"history", Json::array()}};
  for (std::size_t i = 0; i < first.history.size(); ++i)
    for (const PixelHistory& sample : pixel)
      json["history"].push_back(entry_json(sample.history[i], sample, all, config, widths));
  if (!first.resolved) {
    json["final"] = final_json({first.model, first.engine, first.golden}, scene, config);
    const int depth_bits = DepthEncode(config, scene.planes).format().bits;
    const auto hardware = [&](const std::optional<Stored>& stored) {
      return stored ? stored_json(*stored, config, depth_bits, false, has_stencil(config)) : Json(nullptr);
    };
    json["final"]["hardware"] = hardware(first.hardware);
    json["final"]["rtl"] = hardware(first.rtl);
    return json;
  }
  json["final"] = final_json(*first.resolved, scene, config);
  json["samples"] = Json::array();
  for (const PixelHistory& sample : pixel)
    json["samples"].push_back({{"sample", sample.sample},
                               {"x_pixels", std::ldexp(sample.place.x, -kPatternFraction)},
                               {"y_pixels", std::ldexp(sample.place.y, -kPatternFraction)},
                               {"final", final_json({sample.model, sample.engine, sample.golden}, scene, config)}});
  return json;
}

}  // namespace halfplane::explain
