#include "model/config.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "model/generate/raster_pkg.hpp"
#include "model/generate/raster_taps.hpp"
#include "model/stages/triangle_setup.hpp"
#include "model/widths.hpp"
#include "tests/committed.hpp"

namespace halfplane::config_test {
namespace {

std::string refusal(const Config& config) {
  try {
    validate(config);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string file_text(const std::string& path) {
  std::ifstream file(std::string(HALFPLANE_SOURCE_DIR) + "/" + path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(Config, EveryPresetIsValidAndKnowsItsName) {
  for (const auto name : preset_names()) {
    EXPECT_EQ(refusal(preset(name)), "") << name;
    EXPECT_EQ(preset(name).preset, name);
  }
  EXPECT_THROW((void)preset("huge"), InputError);
}

TEST(Designs, EachIsValidAndFoundByItsNameAndItsLabel) {
  for (const Design& design : designs()) {
    EXPECT_EQ(refusal(design.config), "") << design.name;
    EXPECT_EQ(preset(design.name), design.config);
    EXPECT_EQ(labelled(design.label), design.config) << design.label;
  }
  EXPECT_EQ(label(labelled("textured stamp.size=4")),
            "embedded, perspective.colors=1, stamp.size=4, texture.unit=trilinear, texture.ways=2");
  EXPECT_THROW((void)labelled("huge stamp.size=4"), InputError);
  EXPECT_THROW((void)labelled("tiny stamp.size"), InputError);
}

TEST(Designs, EverySettingDiffersFromWhatIsThereWithoutIt) {
  std::istringstream file(file_text("model/designs.toml"));
  std::size_t rows = 0;
  for (std::string line; std::getline(file, line);) {
    const auto quote = line.find(" = \"");
    if (line.starts_with('#') || quote == std::string::npos) continue;
    ++rows;
    std::istringstream words(line.substr(quote + 4, line.size() - quote - 5));
    Config config;
    for (std::string word; words >> word;) {
      const auto equals = word.find('=');
      if (equals == std::string::npos) {
        config = preset(word);
        continue;
      }
      const Config before = config;
      set(config, word.substr(0, equals), word.substr(equals + 1));
      EXPECT_NE(config, before) << word << " in " << line;
    }
  }
  EXPECT_EQ(rows, designs().size());
}

TEST(Config, EverySettingReadsBackWhatWasSetAndRefusesWhatLiesOutside) {
  for (const Setting& setting : settings()) {
    Config config;
    const std::string own = get(config, setting);
    set(config, setting.key, own);
    EXPECT_EQ(config, Config()) << setting.key;
    for (const std::string_view name : setting.names) {
      set(config, setting.key, name);
      EXPECT_EQ(get(config, setting), name);
    }
    if (!setting.is_number()) continue;
    set(config, setting.key, std::to_string(setting.max));
    EXPECT_EQ(get(config, setting), std::to_string(setting.max));
    const Config before = config;
    for (const std::string& bad : {std::to_string(setting.max + 1), std::to_string(setting.min - 1), std::string("x"),
                                   std::string(""), std::string("4.5"), std::string("99999999999999")}) {
      EXPECT_THROW(set(config, setting.key, bad), InputError) << setting.key << " = " << bad;
      EXPECT_EQ(config, before);
    }
  }
}

TEST(Config, CombinationThatCouldOverflowIsRefusedNamingTheBound) {
  Config config;
  config.guard_band = 1 << 20;
  config.subpixel_bits = 12;
  EXPECT_NE(refusal(config).find("needs"), std::string::npos) << refusal(config);
  EXPECT_NE(refusal(config).find("bound: "), std::string::npos) << refusal(config);
}

TEST(Config, RefusedAreATargetBeyondTheGuardBandAStampBeyondTheTileAndAnOddGuardBand) {
  Config config;
  config.guard_band = 1024;
  EXPECT_NE(refusal(config).find("guard.band"), std::string::npos);
  config = Config();
  config.stamp_size = 8;
  config.tile_size = 4;
  EXPECT_NE(refusal(config).find("stamp"), std::string::npos);
  config = Config();
  config.guard_band = 2000;
  EXPECT_NE(refusal(config).find("power of two"), std::string::npos);
}

TEST(Config, TheSerialSetupHasNoClocksOfAPlane) {
  Config config = preset("small");
  set(config, "setup.plane_clocks", "2");
  EXPECT_NE(refusal(config).find("use setup.plane_clocks=1, or setup.kind=pipelined"), std::string::npos)
      << refusal(config);
  config.setup_kind = SetupKind::pipelined;
  EXPECT_EQ(refusal(config), "");
}

TEST(Config, PlaneTooCoarseForOneLsbIsRefused) {
  Config config;
  config.tile_size = 32;
  config.local_guard_bits = 4;
  EXPECT_NE(refusal(config).find("LSB"), std::string::npos) << refusal(config);
}

TEST(Widths, FollowTheTableOfTheNumericsPage) {
  for (const auto name : preset_names()) {
    const Config config = preset(name);
    const Widths w = derive_widths(config);
    const int V = w.coordinate.bits, B = config.depth_bits, s = w.grid_bits;
    EXPECT_EQ(1 << (V - 1), config.guard_band << s) << name;
    EXPECT_EQ(w.delta.bits, V + 1);
    EXPECT_LE(w.edge_product.bits, 2 * V + 2);
    EXPECT_EQ(w.edge_value.bits, 2 * V + 1 - s);
    EXPECT_LE(w.depth().numerator.bits, B + V + 2);
    EXPECT_EQ(w.depth().plane.bits, B + 1 + w.plane_fraction);
    EXPECT_LE(w.sample_edge.bits, 32);
    EXPECT_LE(w.depth().local.bits, 32);
    EXPECT_LE(depth_error_bound(config), 0.75);
  }
}

TEST(Widths, IntervalsNeedExactlyTheBitsOfTheirEnds) {
  const Config config = preset("tiny");
  const Widths widths = derive_widths(config);
  for (const Width* width : widths.all()) {
    const int128 half = int128{1} << (width->bits - 1);
    if (width->is_signed) {
      EXPECT_TRUE(width->range.lo >= -half && width->range.hi < half) << width->name;
      EXPECT_TRUE(width->bits == 1 || width->range.lo < -half / 2 || width->range.hi >= half / 2) << width->name;
    } else {
      EXPECT_TRUE(width->range.lo == 0 && width->range.hi < 2 * half) << width->name;
      EXPECT_TRUE(width->bits == 1 || width->range.hi >= half) << width->name;
    }
  }
}

// A small guard band asks for few guard bits: fewer than a tile keeps, if nothing else had a say.
TEST(Widths, TilesNarrowPlanesByAtLeastOneBitInEveryLegalConfiguration) {
  int checked = 0;
  for (const int band : {16, 32, 64, 2048})
    for (int subpixel_bits = 0; subpixel_bits <= 4; ++subpixel_bits)
      for (int local = 4; local <= 12; ++local) {
        Config config = preset("tiny");
        config.guard_band = band;
        config.subpixel_bits = subpixel_bits;
        config.local_guard_bits = local;
        if (!refusal(config).empty()) continue;
        ++checked;
        const Widths w = derive_widths(config);
        EXPECT_GE(w.guard_bits - local, 1) << label(config);  // per pixel: the rounding bits of RTL and model
        // Half of the last bit dropped, half of the last place kept, and the code's own offset.
        const int drop = w.plane_fraction - local;
        const std::uint64_t half = std::uint64_t{1} << (drop - 1), place = std::uint64_t{1} << (w.plane_fraction - 1),
                            offset = std::uint64_t{1} << (7 + w.plane_fraction);
        EXPECT_EQ(plane_bias(w.color(), w), half + place + offset) << label(config);
      }
  EXPECT_GT(checked, 100);
}

TEST(RasterPkg, TheCommittedOneIsWhatTheConfigurationYields) {
  test::expect_committed("rtl_ref/raster_pkg.sv", [](const auto&) { return raster_pkg(preset("embedded")); });
}

TEST(RasterTaps, TheCommittedOnesAreWhatTheGraphYields) {
  test::expect_committed("rtl_ref/cosim/taps.svh", [](const auto&) { return raster_taps(); });
}

/// The configuration in a result: every setting, as `config --list` describes it.
TEST(Config, TheCommittedSchemaIsThatOfTheSettings) {
  using Json = nlohmann::ordered_json;
  test::expect_committed("docs/json/halfplane.common.schema.json", [](const std::string& text) {
    Json schema = Json::parse(text);
    Json& config = schema["$defs"]["config"];
    const Json preset = config["properties"]["preset"];
    config["required"] = Json::array({"preset"});
    config["properties"] = Json::object({{"preset", preset}});
    for (const Setting& setting : settings()) {
      Json row{{"type", setting.is_number() ? "integer" : "string"}};
      if (setting.is_number()) row.update(Json::object({{"minimum", setting.min}, {"maximum", setting.max}}));
      if (!setting.names.empty()) row["enum"] = setting.names;
      row["description"] = setting.unit + ": " + std::string(setting.meaning);
      config["required"].push_back(setting.key);
      config["properties"][std::string(setting.key)] = row;
    }
    return schema.dump(2) + "\n";
  });
}

TEST(RasterPkg, AnyOtherSettingGivesAnotherIdentity) {
  for (const Setting& setting : settings()) {
    Config config;
    const std::string own = get(config, setting);
    if (setting.key == "msaa.pattern")
      set(config, setting.key, "0.25,0.25;0.75,0.75");
    else if (setting.key == "msaa.samples")
      set(config, setting.key, "2");
    else if (setting.key == "depth.format")
      set(config, setting.key, "f16");
    else if (setting.is_number())
      set(config, setting.key, std::to_string(own == std::to_string(setting.max) ? setting.min : setting.max));
    else
      set(config, setting.key, setting.names[setting.names.front() == own ? 1 : 0]);
    EXPECT_NE(config, Config()) << setting.key;
    EXPECT_EQ(config_id(config) != config_id(Config()), setting.is_hardware()) << setting.key;
  }
}

}  // namespace
}  // namespace halfplane::config_test
