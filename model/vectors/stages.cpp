#include "stages.hpp"

#include <type_traits>

#include "../nearest_word.hpp"
#include "../packets/packet_words.hpp"

namespace halfplane::vectors {
namespace {

constexpr Port port(Arrow arrow) { return {info(arrow).name, arrow}; }
constexpr Port kInterpolated{"interpolated", Arrow::fragment}, kTested{"tested", Arrow::write};
constexpr std::string_view kOfHost = "it is the host's: what goes into it is a scene, no packets";

}  // namespace

std::span<const JudgedStage> judged_stages() {
  using enum Arrow;
  static const std::vector<JudgedStage> all{
      {Stage::viewport, {}, {port(primitive)}, kOfHost},
      {Stage::line_setup, {}, {port(line)}, kOfHost},
      {Stage::cull, {port(primitive)}, {port(triangle)}},
      {Stage::triangle_setup, {port(triangle)}, {port(setup)}},
      {Stage::coarse_raster, {port(setup), port(retire)}, {port(context), port(tile), port(edges)}},
      {Stage::fine_raster, {port(tile), port(edges)}, {port(stamp)}},
      {Stage::interpolate, {port(stamp), port(context)}, {kInterpolated}},
      {Stage::line_raster, {port(line)}, {port(line_pixel)}},
      {Stage::primitive_join, {kInterpolated, port(line_pixel)}, {port(fragment)}},
      {Stage::depth_test, {port(fragment), port(color)}, {kTested, port(retire)}},
      {Stage::rop, {port(fragment), kTested}, {port(write)}},
      {Stage::texture_unit, {port(fragment), port(write), port(texel)}, {port(texture), port(color)}},
      {Stage::framebuffer, {port(fragment), port(write), port(response), port(color)}, {port(request)}},
      {Stage::memory_port, {port(request), port(answer)}, {port(beat), port(response)}},
      {Stage::memory, {port(beat)}, {port(answer)}},
      {Stage::texture_memory,
       {port(texture)},
       {port(texel)},
       "its texels are the scene's, which the file does not hold"}};
  return all;
}

const JudgedStage& judged_stage(std::string_view name) {
  std::vector<std::string_view> names;
  for (const JudgedStage& stage : judged_stages()) {
    if (info(stage.stage).name == name) return stage;
    names.push_back(info(stage.stage).name);
  }
  std::string list;
  for (const std::string_view word : names) list += (list.empty() ? "" : ", ") + std::string(word);
  throw InputError("no stage '" + std::string(name) + "' sends packets;" + did_you_mean(name, names) + " give one of " +
                   list);
}

void require_stage(const JudgedStage& stage, const Config& config) {
  require_sampled_hardware(config, "the RTL");
  const bool is_of_texture = stage.stage == Stage::texture_unit || stage.stage == Stage::texture_memory;
  if (is_of_texture && !has_texture_planes(config))
    throw InputError("stage " + std::string(info(stage.stage).name) +
                     ": this hardware has no texture unit; set texture.unit to nearest, bilinear or trilinear");
  const bool is_of_lines = stage.stage == Stage::line_setup || stage.stage == Stage::line_raster;
  if (is_of_lines && config.line_units == 0)
    throw InputError("stage " + std::string(info(stage.stage).name) +
                     ": this hardware has no unit that draws lines; set lines.unit to 1");
}

int bits_of(Arrow like, const Widths& widths) {
  return with_packet_type(like, [&]<class Packet>(std::type_identity<Packet>) { return packet_bits<Packet>(widths); });
}

std::size_t packet_words(Arrow like, const Widths& widths) { return words_of(bits_of(like, widths)); }

}  // namespace halfplane::vectors
