#include "sim/cli/compare_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <ostream>

#include "sim/cli/progress.hpp"

namespace halfplane {
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
