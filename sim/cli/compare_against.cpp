#include "sim/cli/compare_against.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <ostream>

#include "model/as_number.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/progress.hpp"
#include "sim/words.hpp"

namespace halfplane {

namespace {

constexpr std::size_t kShownLines = 6;  // explanations in a summary

std::uint32_t channel_of(std::uint32_t rgb, int channel) { return rgb >> 8 * channel & 255; }

/// {r, g, b} of 8 bits, or {depth}.
Json value_json(std::uint32_t value, bool is_depth) {
  if (is_depth) return {{"depth", value}};
  return {{"r", channel_of(value, 0)}, {"g", channel_of(value, 1)}, {"b", channel_of(value, 2)}};
}

std::string value_text(std::uint32_t value, bool is_depth) {
  if (is_depth) return std::to_string(value);
  std::string text;
  for (int c = 0; c < 3; ++c) text += (c == 0 ? "" : " ") + right_aligned(std::to_string(channel_of(value, c)), 3);
  return text;
}

std::string pixel_text(const ForeignPixel& pixel, bool is_depth) {
  return right_aligned(std::to_string(pixel.x), 5) + " " + right_aligned(std::to_string(pixel.y), 5) + "  " +
         left_aligned(std::string(name_of(pixel.kind)), 11) + left_aligned(value_text(pixel.expected, is_depth), 14) +
         value_text(pixel.found, is_depth);
}

std::string pixels_heading(bool is_depth) {
  return "    x     y  kind       " + left_aligned(is_depth ? "expected" : "expected rgb", 14) +
         (is_depth ? "found" : "found rgb");
}

Json pixel_json(const ForeignPixel& pixel, bool is_depth) {
  return {{"x", pixel.x},
          {"y", pixel.y},
          {"kind", name_of(pixel.kind)},
          {"expected", value_json(pixel.expected, is_depth)},
          {"found", value_json(pixel.found, is_depth)}};
}

/// "12 of 1,024 pixels differ by more than 1 code, 30 more by less"
std::string count_text(const JudgedImage& judged) {
  const AgainstResult& r = judged.result;
  const std::uint32_t codes = judged.image.is_depth ? judged.tolerance.depth : judged.tolerance.color;
  std::string text = with_commas(r.different) + " of " + with_commas(r.pixels) + " pixels differ";
  if (codes == 0) return text;
  return text + " by more than " + with_commas(codes) + (codes == 1 ? " code, " : " codes, ") +
         with_commas(r.within_tolerance) + " by no more";
}

}  // namespace

void add_against_options(CLI::App& app, AgainstWords& words) {
  add_text_option(
      app, "--against", words.path,
      "another rasterizer's image: the model against it too, colours .png or depth codes .npy; with a folder as "
      "SCENE, a folder: each scene against NAME.png, NAME.npy or both",
      "FILE")
      ->each(claim_input);
  add_text_option(
      app, "--tolerance", words.tolerance,
      "of --against: codes of the stored format that each channel, or the depth, of an equal pixel may be off: "
      "color=1,depth=1",
      "LIST");
  add_number_option(app, "--first", words.listed, 0, 1000000, "of --against: list the first N pixels that differ")
      ->type_name("N")
      ->each([&words](const std::string&) { words.has_listed = true; });
}

Tolerance parse_tolerance(const AgainstWords& words) {
  if (words.path.empty()) {
    for (const auto& [is_given, name] :
         {std::pair(!words.tolerance.empty(), "--tolerance"), std::pair(words.has_listed, "--first")})
      if (is_given) throw InputError(std::string(name) + ": there is no image to judge; add --against FILE");
    return {};
  }
  Tolerance tolerance;
  for (const std::string& part : words_of(words.tolerance, ',')) {
    const auto equals = part.find('=');
    const std::string key = part.substr(0, equals), number = equals == std::string::npos ? "" : part.substr(equals + 1);
    std::uint32_t* const codes = key == "color" ? &tolerance.color : key == "depth" ? &tolerance.depth : nullptr;
    if (codes == nullptr)
      throw InputError("--tolerance: an image has no '" + key + "'; give color=N, depth=N, or both with a comma");
    if (const auto value = as_number<std::uint32_t>(number))
      *codes = *value;
    else
      throw InputError("--tolerance: '" + part + "' is no number of codes; give " + key + "=N, a whole number");
  }
  return tolerance;
}

Json against_json(const JudgedImage& judged) {
  const AgainstResult& r = judged.result;
  const bool is_depth = judged.image.is_depth;
  Json kinds = Json::object();
  for (std::size_t k = 0; k < r.kinds.size(); ++k)
    kinds[std::string(kForeignDifferences[k])] = {
        {"pixels", r.kinds[k].pixels}, {"max", r.kinds[k].max}, {"rms", r.kinds[k].rms()}};
  Json explanations = Json::array();
  for (const Explanation& one : r.explanations)
    explanations.push_back({{"kind", name_of(one.kind)}, {"change", one.change}, {"pixels", one.pixels}});
  Json differences = Json::array();
  for (const ForeignPixel& pixel : r.first) differences.push_back(pixel_json(pixel, is_depth));
  Json first = nullptr;  // its values are single numbers
  if (r.first_pixel)
    first = {{"x", r.first_pixel->x},
             {"y", r.first_pixel->y},
             {"kind", name_of(r.first_pixel->kind)},
             {"expected", r.first_pixel->expected},
             {"got", r.first_pixel->found}};
  return {
      {"file", judged.path},      {"image", is_depth ? "depth" : "color"},
      {"pixels", r.pixels},       {"tolerance", {{"color", judged.tolerance.color}, {"depth", judged.tolerance.depth}}},
      {"different", r.different}, {"within_tolerance", r.within_tolerance},
      {"kinds", kinds},           {"explanations", explanations},
      {"first", first},           {"differences", differences}};
}

std::vector<std::string> against_lines(const JudgedImage& judged) {
  const AgainstResult& r = judged.result;
  const bool is_depth = judged.image.is_depth;
  std::vector<std::string> lines{"", "against " + judged.path + ": " + count_text(judged)};
  if (r.different == 0) return lines;
  lines.back() += ", by what explains them";
  for (std::size_t k = 0; k < r.kinds.size(); ++k)
    if (r.kinds[k].pixels != 0)
      lines.push_back("  " + std::string(kForeignDifferences[k]) + ": " + with_commas(r.kinds[k].pixels) +
                      " pixels, by at most " + fixed(r.kinds[k].max, 0) + ", rms " + fixed(r.kinds[k].rms(), 2) +
                      (is_depth ? " depth codes" : " LSB of 8 bits"));
  for (std::size_t i = 0; i < r.explanations.size() && i < kShownLines; ++i)
    lines.push_back("  " + with_commas(r.explanations[i].pixels) + " are what the scene shows with " +
                    r.explanations[i].change);
  lines.emplace_back("FAILED: the image differs from the model's, whose own bounds are above");
  return lines;
}

std::vector<std::string> difference_lines(const JudgedImage& judged, const std::string& explain) {
  const AgainstResult& r = judged.result;
  const bool is_depth = judged.image.is_depth;
  std::vector<std::string> lines;
  if (r.different == 0) return lines;
  if (!r.first.empty()) {
    lines.push_back("the first " + (r.first.size() == 1 ? "pixel" : with_commas(r.first.size()) + " pixels") +
                    (r.first.size() == 1 ? " that differs" : " that differ"));
    lines.push_back(pixels_heading(is_depth));
    for (const ForeignPixel& pixel : r.first) lines.push_back(pixel_text(pixel, is_depth));
  }
  lines.push_back("`" + explain + " " + std::to_string(r.first_pixel->x) + " " + std::to_string(r.first_pixel->y) +
                  "` explains the model's first pixel that differs");
  return lines;
}

std::vector<NamedPanel> against_panels(const JudgedImage& judged) {
  const ForeignImage& image = judged.image;
  const AgainstResult& r = judged.result;
  const bool is_depth = image.is_depth;
  const std::string name = std::filesystem::path(judged.path).filename().string();
  NamedPanel other{"against", {}};
  std::vector<float> difference(image.value.size());
  for (std::size_t p = 0; p < image.value.size(); ++p)
    difference[p] =
        static_cast<float>(is_depth ? static_cast<double>(image.value[p]) - static_cast<double>(r.expected[p])
                                    : distance_between(image.value[p], r.expected[p], false));
  if (is_depth) {
    const std::vector<float> codes(image.value.begin(), image.value.end());
    const auto [least, most] = std::ranges::minmax(image.value);
    other.panel = error_panel("the other image, " + name + ": depth", image.width, image.height, codes, "codes", false,
                              "from " + with_commas(least) + " to " + with_commas(most));
  } else {
    Picture picture(image.width, image.height);
    for (std::size_t p = 0; p < image.value.size(); ++p)
      for (std::size_t c = 0; c < 3; ++c)
        picture.rgb[3 * p + c] = static_cast<std::uint8_t>(channel_of(image.value[p], static_cast<int>(c)));
    other.panel = picture_panel("the other image, " + name, picture);
  }
  // Hues of Okabe and Ito's palette.
  static constexpr std::array<PixelKind, 1 + kForeignDifferences.size()> kStyles{
      {{kNotCompared, "equal", 0, true},
       {{0xe6, 0x9f, 0x00}, kForeignDifferences[0], 2, false},
       {{0xd5, 0x5e, 0x00}, kForeignDifferences[1], 3, false},
       {{0xcc, 0x79, 0xa7}, kForeignDifferences[2], 4, false},
       {{0x56, 0xb4, 0xe9}, kForeignDifferences[3], 5, false},
       {{0x00, 0x9e, 0x73}, kForeignDifferences[4], 6, false},
       {{0xf0, 0xe4, 0x42}, kForeignDifferences[5], 7, false},
       {{0x00, 0x72, 0xb2}, kForeignDifferences[6], 8, false},
       {{0x9a, 0xa3, 0xb2}, kForeignDifferences[7], 1, false},
       {{0xff, 0xff, 0xff}, kForeignDifferences[8], 9, false}}};
  return {
      std::move(other),
      {"difference", error_panel(is_depth ? "difference, other - model" : "difference, worst channel", image.width,
                                 image.height, difference, is_depth ? "codes" : "LSB of 8 bits", is_depth)},
      {"kinds", kinds_panel("what explains the difference, pixels", image.width, image.height, r.kind_of, kStyles)}};
}

JunitCase against_case(const JudgedImage& judged) {
  JunitCase one;
  one.name = "against";
  const std::string count = judged.path + ": " + count_text(judged);
  if (judged.result.different == 0) {
    one.output = count;
    return one;
  }
  one.failure = count;
  for (std::size_t k = 0; k < judged.result.kinds.size(); ++k)
    if (judged.result.kinds[k].pixels != 0)
      one.failure += "; " + std::string(kForeignDifferences[k]) + " " + with_commas(judged.result.kinds[k].pixels);
  for (const Explanation& reason : judged.result.explanations)
    one.details += with_commas(reason.pixels) + " are what the scene shows with " + reason.change + "\n";
  one.details += pixels_heading(judged.image.is_depth) + "\n";
  for (const ForeignPixel& pixel : judged.result.first) one.details += pixel_text(pixel, judged.image.is_depth) + "\n";
  return one;
}

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> scenes_in(const fs::path& folder) {
  std::vector<fs::path> scenes;
  for (const auto& entry : fs::directory_iterator(folder))
    if (const auto ending = entry.path().extension();
        ending == ".hpt" || ending == ".obj" || ending == ".gltf" || ending == ".glb")
      scenes.push_back(entry.path());
  std::ranges::sort(scenes);
  if (scenes.empty())
    throw InputError(folder.string() + ": no scene in it; give a folder with .hpt, .obj, .gltf or .glb");
  return scenes;
}

/// The verdicts of one scene; its failures that are no image's are cases of their own.
struct JudgedScene {
  std::vector<JudgedImage> images;
  std::string failure;
};

JudgedScene judge(const CompareFolder& options, const fs::path& path, const Config& config, Progress& progress,
                  double done) {
  CommonOptions one = options.common;
  one.scene = path.string();
  double load_s = 0;
  const StudyRules rules = study_rules(options.study);
  JudgedScene judged;
  const Scene scene = interpolated(load_scene(one, config, load_s), options.study.interpolation);
  const auto report = [&progress, done](double) { progress(done); };
  std::optional<Comparison> c;
  for (const char* ending : {".png", ".npy"}) {
    const fs::path image = fs::path(options.against.path) / (path.stem().string() + ending);
    if (!fs::exists(image)) continue;
    if (!c) {
      CompareOptions comparing;
      comparing.rules = rules;
      comparing.progress = report;
      c = compare(scene, config, comparing);
    }
    JudgedImage next{image.string(),
                     read_foreign_image(image.string(), scene.width, scene.height),
                     parse_tolerance(options.against),
                     {}};
    next.result = compare_against(scene, config, *c, next.image,
                                  {rules, next.tolerance, static_cast<std::size_t>(options.against.listed), report});
    judged.images.push_back(std::move(next));
  }
  if (judged.images.empty())
    judged.failure = "no image " + path.stem().string() + ".png or .npy in " + options.against.path;
  return judged;
}

/// "snap 11, color 3"
std::string kinds_text(const AgainstResult& result) {
  std::string text;
  for (std::size_t k = 0; k < result.kinds.size(); ++k)
    if (result.kinds[k].pixels != 0)
      text +=
          (text.empty() ? "" : ", ") + std::string(kForeignDifferences[k]) + " " + with_commas(result.kinds[k].pixels);
  return text;
}

}  // namespace

int compare_folder(const CompareFolder& options) {
  const auto start = std::chrono::steady_clock::now();
  if (!fs::is_directory(options.against.path))
    throw InputError("--against: SCENE is a folder; give a folder of images here too, NAME.png or NAME.npy");
  const Config config = drawing_config(options.common);
  require_one_sample(config, "compare --against");
  const std::vector<fs::path> scenes = scenes_in(options.common.scene);
  Progress progress(options.common, "comparing", "scenes");
  std::vector<std::string> lines;
  std::vector<JunitCase> cases;
  Json rows = Json::array();
  std::size_t failed = 0;
  for (const fs::path& path : scenes) {
    progress(static_cast<double>(rows.size()) / static_cast<double>(scenes.size()), rows.size());
    JudgedScene judged;
    try {
      judged =
          judge(options, path, config, progress, static_cast<double>(rows.size()) / static_cast<double>(scenes.size()));
    } catch (const InputError& error) {
      judged.failure = error.what();
    }
    const std::string name = path.filename().string();
    Json images = Json::array();
    bool is_equal = judged.failure.empty();
    for (const JudgedImage& image : judged.images) {
      images.push_back(against_json(image));
      cases.push_back(against_case(image));
      cases.back().name = fs::path(image.path).filename().string();
      is_equal = is_equal && image.result.different == 0;
      lines.push_back((image.result.different == 0 ? "equal      " : "DIFFERENT  ") + cases.back().name + ": " +
                      with_commas(image.result.different) + " of " + with_commas(image.result.pixels) + " pixels" +
                      (image.result.different == 0 ? "" : ", " + kinds_text(image.result)));
    }
    if (!judged.failure.empty()) {
      cases.push_back({name, judged.failure, "", "", "", -1, {}});
      lines.push_back("FAILED     " + name + ": " + judged.failure);
    }
    failed += is_equal ? 0 : 1;
    rows.push_back(
        {{"scene", path.string()}, {"equal", is_equal}, {"failure", or_null(judged.failure)}, {"against", images}});
  }
  Json result = result_head("compare.folder", options.common, config);
  result["against"] = options.against.path;
  result["scenes"] = rows;
  result["failed"] = failed;
  finish_json(options.common, result, start);
  write_junit(options.junit_path, "compare." + label(config), cases, result["wall_s"], result, &config);
  std::ostream& out = human(options.common);
  for (const std::string& line : lines) out << line << '\n';
  out << with_commas(scenes.size() - failed) << " of " << with_commas(scenes.size()) << " scenes equal\n";
  return failed == 0 ? exit_ok : exit_mismatch;
}

}  // namespace halfplane
