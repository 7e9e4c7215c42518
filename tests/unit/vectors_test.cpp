// Vectors of the stages, their files, and the judge of foreign ones.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <set>
#include <utility>

#include "../tier.hpp"
#include "model/capture/capture.hpp"
#include "sim/config_file.hpp"
#include "sim/scene/random.hpp"
#include "sim/vectors/check.hpp"
#include "sim/vectors/vector_file.hpp"

namespace halfplane::vectors::vectors_test {
namespace {

constexpr std::uint64_t kSeed = 27;

Config with_setting(const char* preset_name, const char* key, const char* value) {
  Config config = preset(preset_name);
  set_by_key(config, key, value);
  return config;
}

/// Everything that hardware can have: levels, colours over w, fog, alpha test, stencil, blending, dithering.
Config all_units() {
  Config config = preset("embedded");
  for (const auto& [key, value] : {std::pair{"texture.unit", "trilinear"},
                                   {"perspective.colors", "1"},
                                   {"fog.unit", "1"},
                                   {"alpha.unit", "1"},
                                   {"stencil.bits", "8"},
                                   {"blend.lanes", "4"},
                                   {"dither.unit", "1"}})
    set_by_key(config, key, value);
  return config;
}

const std::vector<Config>& configurations() {
  static const std::vector<Config> all{preset("tiny"),
                                       with_setting("small", "lines.unit", "1"),
                                       with_setting("embedded", "cache.lines", "16"),
                                       with_setting("embedded", "frame.order", "bins"),
                                       with_setting("embedded", "texture.unit", "bilinear"),
                                       with_setting("embedded", "stencil.bits", "8"),
                                       with_setting("full", "hiz.lag", "2"),
                                       all_units()};
  return all;
}

/// Lines, points, triangles that cover whole tiles, and with a texture unit a textured one.
Scene small_scene(const Config& config) {
  const bool has_texture = config.texture_unit != TextureUnitKind::off;
  std::string text = "halfplane 1\ntarget 16 16\n";
  if (has_texture) text += "texture t pattern grid 16 16\n";
  text +=
      "clear color 9 8 7 255 depth 1\nspace window\n"
      "v 0 0 0.5 1 255 0 0 255 0 0\nv 16 0 0.25 1 0 255 0 255 2 0\nv 0 16 0.75 1 0 0 255 255 0 2\nt 0 1 2\n"
      "l 0 1 1 2 2 0\nstate point_size 3\np 0 1 2\nstate depth_test always\n";
  if (has_texture) text += "state texture t\nstate texture_min linear\nstate texture_mag linear\n";
  return read_capture(text + "t 2 1 0\nl 2 1\n", "small");
}

/// The same, and random ones.
SceneSource scenes_of(const Config& config, std::uint64_t primitives = 60) {
  SceneSource random = random_scenes(config, kSeed, primitives);
  return [random, small = std::optional(small_scene(config))]() mutable -> std::optional<Scene> {
    if (small) return std::exchange(small, std::nullopt);
    return random();
  };
}

bool is_of(const JudgedStage& stage, const Config& config) {
  const bool is_of_texture = stage.stage == Stage::texture_unit || stage.stage == Stage::texture_memory;
  return !is_of_texture || config.texture_unit != TextureUnitKind::off;
}

TEST(Vectors, FieldsAndPackedWordsAreTheSame) {
  Random random(kSeed);
  for (const Config& config : configurations()) {
    const Widths widths = derive_widths(config);
    for (std::size_t a = 0; a < kArrows; ++a) {
      const auto arrow = static_cast<Arrow>(a);
      if (is_of_texture_unit(arrow) && config.texture_unit == TextureUnitKind::off) continue;
      const auto fields = fields_of(arrow, widths);
      int bits = 0;
      std::set<std::string> names;
      std::vector<std::uint64_t> values;
      for (const FieldName& field : fields) {
        values.push_back(random.next() >> (64 - field.bits));
        names.insert(field.name);
        bits += field.bits;
      }
      EXPECT_EQ(bits, bits_of(arrow, widths)) << info(arrow).name;
      EXPECT_EQ(names.size(), fields.size()) << info(arrow).name << ": a name twice";
      EXPECT_EQ(values_of(arrow, widths, words_from(fields, values)), values) << info(arrow).name;
    }
  }
}

TEST(Vectors, EveryArrowIsAPortOfAStage) {
  std::set<std::string_view> in, out;
  for (const JudgedStage& stage : judged_stages()) {
    for (const Port& port : stage.in) in.insert(port.name);
    for (const Port& port : stage.out) out.insert(port.name);
  }
  for (const ArrowInfo& arrow : kArrowInfo) {
    EXPECT_TRUE(out.contains(arrow.name)) << arrow.name;
    EXPECT_TRUE(in.contains(arrow.name)) << arrow.name;
  }
}

TEST(Vectors, WhatAStageGaveIsJudgedEqualWhateverTheFile) {
  const auto folder = std::filesystem::temp_directory_path() / ("halfplane-vectors-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  Format next = Format::jsonl;
  for (const Config& config : configurations())
    for (const JudgedStage& stage : judged_stages()) {
      if (!is_of(stage, config)) continue;
      SCOPED_TRACE(label(config) + " " + std::string(info(stage.stage).name));
      const StagePackets packets = record_stage(stage, config, scenes_of(config, test::cases(20, 60)));
      next = static_cast<Format>((static_cast<int>(next) + 1) % 3);
      for (const Format format : {Format::jsonl, Format::csv, Format::hex}) {
        if (config.preset != "tiny" && format != next) continue;  // each in its turn: files of other presets are long
        const std::string path = folder / kFormats[static_cast<std::size_t>(format)];
        (void)write_vectors(path, format, stage, config, packets, {"random", 1});
        const VectorFile file = read_vectors(path);
        EXPECT_EQ(file.stage, &stage);
        EXPECT_EQ(file.config, config);
        for (std::size_t p = 0; p < stage.in.size(); ++p) EXPECT_EQ(file.packets.in[p].size(), packets.in[p].size());
        if (!stage.can_run()) {
          EXPECT_THROW((void)judge(stage, config, file.packets), InputError);
          continue;
        }
        const Judgement judgement = judge(stage, config, file.packets);
        EXPECT_FALSE(judgement.first);
        EXPECT_GT(judgement.total_compared(), 0U);
        EXPECT_EQ(judgement.total_differing(), 0U);
        for (std::size_t p = 0; p < stage.in.size(); ++p)
          EXPECT_EQ(judgement.in[p], packets.in[p].size()) << stage.in[p].name << ": not all was taken";
      }
    }
  std::filesystem::remove_all(folder);
}

/// A bit of every field of every packet that comes out of any stage, one at a time.
TEST(Vectors, AFaultInAnyFieldOfAnyStageIsFound) {
  std::cout << "seed " << kSeed << '\n';
  Random random(kSeed);
  std::size_t faults = 0;
  std::set<std::string_view> seen;
  for (const Config& config : configurations()) {
    const Widths widths = derive_widths(config);
    for (const JudgedStage& stage : judged_stages()) {
      if (!is_of(stage, config) || !stage.can_run()) continue;
      StagePackets packets = record_stage(stage, config, scenes_of(config));
      for (std::size_t p = 0; p < stage.out.size(); ++p) {
        const auto fields = fields_of(stage.out[p].like, widths);
        if (packets.out[p].size() == 0) continue;
        seen.insert(stage.out[p].name);
        const std::size_t step = 1 + fields.size() / 12;  // not every one of many samples
        for (std::size_t f = random.next() % step; f < fields.size(); f += step) {
          SCOPED_TRACE(label(config) + " " + std::string(stage.out[p].name) + "." + fields[f].name);
          const std::size_t n = random.next() % packets.out[p].size();
          const auto words = packets.out[p].at(n);
          const std::vector<std::uint32_t> before(words.begin(), words.end());
          auto values = values_of(stage.out[p].like, widths, words);
          values[f] ^= std::uint64_t{1} << random.next() % static_cast<unsigned>(fields[f].bits);
          std::ranges::copy(words_from(fields, values), words.begin());
          const Judgement judgement = judge(stage, config, packets);
          std::ranges::copy(before, words.begin());
          ASSERT_TRUE(judgement.first);
          EXPECT_EQ(judgement.first->kind, FirstDifference::Kind::differs);
          EXPECT_EQ(judgement.first->port, p);
          EXPECT_EQ(judgement.first->number, n);
          ASSERT_EQ(judgement.first->fields.size(), 1U);
          EXPECT_EQ(judgement.first->fields[0].name, fields[f].name);
          EXPECT_EQ(judgement.first->fields[0].got, values[f]);
          EXPECT_EQ(judgement.total_differing(), 1U);
          ++faults;
        }
      }
    }
  }
  std::cout << faults << " faults, each found\n";
  EXPECT_GT(faults, 500U);
  for (const JudgedStage& stage : judged_stages())
    for (const Port& port : stage.out)
      EXPECT_TRUE(!stage.can_run() || seen.contains(port.name)) << port.name << " never came";
}

TEST(Vectors, PacketsThatAreMissingOrTooManyAreFound) {
  const Config config = preset("embedded");
  for (const JudgedStage& stage : judged_stages()) {
    if (!stage.can_run() || !is_of(stage, config)) continue;
    SCOPED_TRACE(info(stage.stage).name);
    const StagePackets packets = record_stage(stage, config, scenes_of(config));
    for (std::size_t p = 0; p < stage.out.size(); ++p) {
      const PacketList& list = packets.out[p];
      if (list.size() < 3) continue;
      StagePackets fewer = packets, more = packets, twice = packets;
      fewer.out[p] = twice.out[p] = PacketList(list[0].size());
      for (std::size_t n = 0; n + 1 < list.size(); ++n) fewer.out[p].push(list[n]);
      more.out[p].push(list[0]);
      for (std::size_t n = 0; n < list.size(); ++n) {
        twice.out[p].push(list[n]);
        if (n == 0) twice.out[p].push(list[n]);
      }
      const Judgement missing = judge(stage, config, fewer), extra = judge(stage, config, more);
      ASSERT_TRUE(missing.first && extra.first);
      EXPECT_EQ(missing.first->kind, FirstDifference::Kind::missing);
      EXPECT_EQ(missing.first->number, list.size() - 1);
      EXPECT_EQ(extra.first->kind, FirstDifference::Kind::extra);
      EXPECT_EQ(extra.first->number, list.size());
      EXPECT_TRUE(judge(stage, config, twice).first);
      if (stage.stage != Stage::fine_raster) continue;  // whose stamps are all different
      StagePackets lost = packets;
      lost.out[p] = PacketList(list[0].size());
      for (std::size_t n = 0; n < list.size(); ++n)
        if (n != 1) lost.out[p].push(list[n]);
      const Judgement judgement = judge(stage, config, lost);
      ASSERT_TRUE(judgement.first);
      EXPECT_EQ(judgement.first->number, 1U);
      EXPECT_NE(judgement.first->hint.find("was lost"), std::string::npos);
      EXPECT_EQ(judgement.total_differing(), 1U) << "behind it the judge finds its place again";
      EXPECT_EQ(judge(stage, config, twice).total_differing(), 1U);
    }
  }
}

TEST(Vectors, InputThatEndsEarlyIsRefused) {
  const Config config = preset("tiny");
  const JudgedStage& stage = judged_stage("fine_raster");
  StagePackets packets = record_stage(stage, config, random_scenes(config, kSeed, 20));
  packets.in[1] = PacketList(packet_words(stage.in[1].like, derive_widths(config)));
  EXPECT_THROW((void)judge(stage, config, packets), InputError);
  EXPECT_THROW((void)judged_stage("fine_rooster"), InputError);
  EXPECT_THROW(require_stage(judged_stage("texture_unit"), config), InputError);
}

}  // namespace
}  // namespace halfplane::vectors::vectors_test
