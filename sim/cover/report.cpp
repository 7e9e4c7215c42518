#include "sim/cover/report.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>
#include <set>

#include "model/capture/capture.hpp"
#include "model/capture/capture_states.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/input_error.hpp"
#include "sim/cover/bins.hpp"
#include "sim/show/image/whole_file.hpp"
#include "sim/show/report/page.hpp"
#include "sim/words.hpp"

namespace halfplane::cover {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::string_view kSchema = "halfplane.coverage/1";

/// The arrows that an event of packets looks at; none: it looks at more than packets.
std::span<const Arrow> arrows_of(Event event) {
  static constexpr std::array kTie{Arrow::triangle, Arrow::setup, Arrow::tile, Arrow::edges};
  static constexpr std::array kPrimitive{Arrow::primitive}, kTriangle{Arrow::triangle}, kSetup{Arrow::setup},
      kTile{Arrow::tile}, kStamp{Arrow::stamp}, kLine{Arrow::line}, kRetire{Arrow::retire}, kRequest{Arrow::request},
      kTexture{Arrow::texture};
  switch (event) {
    case Event::primitive: return kPrimitive;
    case Event::triangle: return kTriangle;
    case Event::setup: return kSetup;
    case Event::tile: return kTile;
    case Event::tie: return kTie;
    case Event::stamp: return kStamp;
    case Event::line: return kLine;
    case Event::retire: return kRetire;
    case Event::request: return kRequest;
    case Event::texture: return kTexture;
    default: return {};
  }
}

/// Why the source cannot hit the row, whatever the hardware has; empty: it can.
std::string not_seen(const BinRow& row, Source source, std::span<const Arrow> arrows, std::string_view stage) {
  if (source == Source::rtl) return "";
  if (row.event == Event::stream) return "needs cosim: the model alone has no cycles";
  if (row.name == "clear.bin") return "needs cosim: it sends scenes again as a next frame";
  if (source == Source::model) return "";
  const auto needed = arrows_of(row.event);
  const bool is_seen = !needed.empty() && std::ranges::all_of(needed, [&](Arrow arrow) {
    return std::ranges::find(arrows, arrow) != arrows.end();
  });
  // A tile alone has neither the primitive's constants nor its bound.
  const bool is_hiz = row.event == Event::tile && row.name.starts_with("hiz.");
  return is_seen && !is_hiz ? "" : "not at the ports of " + std::string(stage);
}

/// A triangle with a texture, to ask which states the hardware has.
Scene asked_scene() {
  return read_capture(
      "halfplane 1\ntarget 8 8\ntexture t pattern chequer 4 4\nspace window\nstate texture t\n"
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nt 0 1 2\n",
      "");
}

State state_with(const Dimension& a, int va, const Dimension& b, int vb) {
  State state;
  state.space = Space::window;
  for (const Dimension* whole : {&a, &b})
    if (!whole->part_of.empty())
      for (const Dimension& one : Hits::all_dimensions())
        if (one.name == whole->part_of) one.set(state, 1);
  a.set(state, va);
  b.set(state, vb);
  return state;
}

std::vector<std::string> strings(std::span<const std::string_view> words, int count) {
  return {words.begin(), words.begin() + count};
}

const Dimension& dimension(std::string_view name) {
  const auto& all = Hits::all_dimensions();
  const auto found = std::ranges::find(all, name, &Dimension::name);
  if (found == all.end()) throw InputError("no draw state '" + std::string(name) + "' in this version");
  return *found;
}

/// The knobs that draw these values alone.
std::string pair_knobs(const Dimension& a, int va, const Dimension& b, int vb) {
  const State state = state_with(a, va, b, vb);
  static const Scene kScene = asked_scene();
  std::set<std::string_view> rows;
  for (const Dimension* one : {&a, &b}) {
    rows.insert(one->row);
    if (!one->part_of.empty()) rows.insert(one->part_of);
  }
  if (state.texture) rows.erase("texture");  // no name of a texture is known here, and random scenes have some
  std::string text;
  for (const std::string_view name : rows) {
    std::string value;
    write_state_value(state, draw_state(name), kScene.textures, value);
    text += (text.empty() ? "" : ",") + std::string(name) + "=" + value.substr(1);
  }
  return "--random 2000 --random-only '" + text + "'";
}

/// The pairs of a configuration, with their hits.
std::vector<PairResult> pairs_of(const Hits& hits, const Config& config, bool is_possible_at_all) {
  Scene scene = asked_scene();
  const auto& all = Hits::all_dimensions();
  const auto is_there = [&](const State& state) {
    scene.states.front() = state;
    try {
      check_hardware_scene(scene, config);
      return true;
    } catch (const InputError&) {
      return false;
    }
  };
  // Values that the hardware has. Where it refuses most values of a part of a unit, the unit is not there: values that come
  // to the same as none, such as a blend of one and zero, are no stimulus.
  std::vector<std::vector<bool>> has(all.size());
  std::set<std::string_view> lacking;
  const auto unit = [](const Dimension& one) { return one.part_of.empty() ? one.name : one.part_of; };
  for (std::size_t n = 0; n < all.size(); ++n) {
    for (int v = 0; v < all[n].values; ++v) has[n].push_back(is_there(state_with(all[n], v, all[n], v)));
    if (2 * std::ranges::count(has[n], false) > all[n].values) lacking.insert(unit(all[n]));
  }
  for (std::size_t n = 0; n < all.size(); ++n) {
    if (!lacking.contains(unit(all[n]))) continue;
    has[n].assign(has[n].size(), false);
    if (all[n].part_of.empty()) has[n][static_cast<std::size_t>(all[n].value(State{}))] = true;
  }
  std::vector<PairResult> pairs;
  for (std::size_t a = 0; a < all.size(); ++a)
    for (std::size_t b = a + 1; b < all.size(); ++b) {
      PairResult& pair = pairs.emplace_back();
      pair.a = all[a].name;
      pair.b = all[b].name;
      pair.a_values = strings(all[a].words, all[a].values);
      pair.b_values = strings(all[b].words, all[b].values);
      for (int va = 0; va < all[a].values; ++va)
        for (int vb = 0; vb < all[b].values; ++vb) {
          const bool can = is_possible_at_all && has[a][static_cast<std::size_t>(va)] &&
                           has[b][static_cast<std::size_t>(vb)] && is_possible(all[a], va, all[b], vb) &&
                           is_there(state_with(all[a], va, all[b], vb));
          pair.hits.push_back(can ? std::optional<std::uint64_t>(hits.pairs.times(a, va, b, vb)) : std::nullopt);
        }
    }
  return pairs;
}

template <class Visit>
void for_each_pair(const PairResult& pair, Visit&& visit) {
  for (std::size_t n = 0; n < pair.hits.size(); ++n)
    if (pair.hits[n])
      visit(pair.a_values[n / pair.b_values.size()], pair.b_values[n % pair.b_values.size()], *pair.hits[n]);
}

int index_of(std::span<const std::string_view> all, const std::string& word) {
  return static_cast<int>(std::ranges::find(all, word) - all.begin());
}

}  // namespace

Report report_of(const Hits& hits, const Config& config, Run run, Source source, std::span<const Arrow> arrows,
                 std::string_view stage) {
  Report report;
  report.runs.push_back(std::move(run));
  for (std::size_t n = 0; n < bins().size(); ++n) {
    const Bin& bin = bins()[n];
    BinResult& result = report.bins.emplace_back();
    result.name = bin.name;
    result.what = bin.what;
    result.hit_by = bin.hit_by;
    result.faults = bin.row->faults;
    result.hits = hits.bins[n];
    const std::string setting = missing_setting(*bin.row, config);
    result.excluded = setting.empty() ? not_seen(*bin.row, source, arrows, stage) : "needs " + setting;
  }
  report.pairs = pairs_of(hits, config, source != Source::ports);
  return report;
}

void Report::merge(const Report& other) {
  if (bins.empty() && runs.empty()) {
    *this = other;
    return;
  }
  runs.insert(runs.end(), other.runs.begin(), other.runs.end());
  for (const BinResult& theirs : other.bins) {
    const auto ours = std::ranges::find(bins, theirs.name, &BinResult::name);
    if (ours == bins.end()) {
      bins.push_back(theirs);
      continue;
    }
    ours->hits += theirs.hits;
    if (theirs.excluded.empty()) ours->excluded.clear();
  }
  for (const PairResult& theirs : other.pairs) {
    const auto ours = std::ranges::find_if(pairs, [&](const PairResult& one) {
      return one.a == theirs.a && one.b == theirs.b && one.hits.size() == theirs.hits.size();
    });
    if (ours == pairs.end()) {
      pairs.push_back(theirs);
      continue;
    }
    for (std::size_t n = 0; n < theirs.hits.size(); ++n)
      if (theirs.hits[n]) ours->hits[n] = ours->hits[n].value_or(0) + *theirs.hits[n];
  }
}

std::vector<MissingPair> Report::missing_pairs() const {
  std::vector<MissingPair> missing;
  for (const PairResult& pair : pairs)
    for_each_pair(pair, [&](const std::string& a, const std::string& b, std::uint64_t hits) {
      if (hits != 0) return;
      const Dimension &of_a = dimension(pair.a), &of_b = dimension(pair.b);
      missing.push_back(
          {pair.a, a, pair.b, b, pair_knobs(of_a, index_of(of_a.words, a), of_b, index_of(of_b.words, b))});
    });
  return missing;
}

Totals totals_of(const Report& report) {
  Totals totals;
  std::map<std::string, bool> faults;
  for (const BinResult& bin : report.bins) {
    ++totals.bins;
    totals.hit += bin.hits != 0 ? 1 : 0;
    totals.holes += bin.is_hole() ? 1 : 0;
    totals.excluded += bin.excluded.empty() ? 0 : 1;
    for (const std::string& fault : words_of(bin.faults, ' ')) faults[fault] |= bin.hits != 0;
  }
  for (const PairResult& pair : report.pairs)
    for_each_pair(pair, [&](const std::string&, const std::string&, std::uint64_t hits) {
      ++totals.pairs;
      totals.pairs_hit += hits != 0 ? 1 : 0;
    });
  for (const auto& [fault, is_met] : faults) {
    ++totals.faults;
    totals.faults_met += is_met ? 1 : 0;
    if (!is_met) totals.faults_unmet.push_back(fault);
  }
  return totals;
}

Json coverage_json(const Report& report) {
  const Totals t = totals_of(report);
  Json json;
  json["totals"] = {{"bins", t.bins},     {"hit", t.hit},
                    {"holes", t.holes},   {"excluded", t.excluded},
                    {"pairs", t.pairs},   {"pairs_hit", t.pairs_hit},
                    {"faults", t.faults}, {"faults_met", t.faults_met}};
  json["faults_unmet"] = Json::array();
  for (const std::string& fault : t.faults_unmet) json["faults_unmet"].push_back(std::stoi(fault));
  json["runs"] = Json::array();
  for (const Run& run : report.runs)
    json["runs"].push_back(
        {{"command", run.command}, {"stimulus", run.stimulus}, {"config", run.config}, {"seed", run.seed}});
  json["bins"] = Json::array();
  for (const BinResult& bin : report.bins) {
    Json faults = Json::array();
    for (const std::string& fault : words_of(bin.faults, ' ')) faults.push_back(std::stoi(fault));
    json["bins"].push_back({{"name", bin.name},
                            {"what", bin.what},
                            {"hits", bin.hits},
                            {"excluded", bin.excluded.empty() ? Json(nullptr) : Json(bin.excluded)},
                            {"hit_by", bin.hit_by},
                            {"faults", faults}});
  }
  json["pairs"] = Json::array();
  for (const PairResult& pair : report.pairs) {
    Json hits = Json::array();
    for (const auto& one : pair.hits) hits.push_back(one ? Json(*one) : Json(nullptr));
    json["pairs"].push_back(
        {{"a", pair.a}, {"b", pair.b}, {"a_values", pair.a_values}, {"b_values", pair.b_values}, {"hits", hits}});
  }
  return json;
}

Report read_coverage(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError("cannot read file '" + path + "'; give a file that --coverage has written");
  try {
    const Json json = Json::parse(file);
    if (json.at("schema") != kSchema)
      throw InputError(path + ": its schema is " + json.at("schema").dump() + ", not \"" + std::string(kSchema) + "\"");
    Report report;
    for (const Json& run : json.at("runs"))
      report.runs.push_back({run.at("command"), run.at("stimulus"), run.at("config"), run.at("seed")});
    for (const Json& bin : json.at("bins")) {
      BinResult& result = report.bins.emplace_back();
      result.name = bin.at("name");
      result.what = bin.at("what");
      result.hit_by = bin.at("hit_by");
      result.hits = bin.at("hits");
      if (!bin.at("excluded").is_null()) result.excluded = bin.at("excluded");
      for (const Json& fault : bin.at("faults"))
        result.faults += (result.faults.empty() ? "" : " ") + std::to_string(fault.get<int>());
    }
    for (const Json& pair : json.at("pairs")) {
      PairResult& result = report.pairs.emplace_back();
      result.a = pair.at("a");
      result.b = pair.at("b");
      result.a_values = pair.at("a_values").get<std::vector<std::string>>();
      result.b_values = pair.at("b_values").get<std::vector<std::string>>();
      for (const Json& hits : pair.at("hits"))
        result.hits.push_back(hits.is_null() ? std::nullopt : std::optional(hits.get<std::uint64_t>()));
      if (result.hits.size() != result.a_values.size() * result.b_values.size())
        throw InputError(path + ": the pair " + result.a + ", " + result.b + " has not as many hits as values");
    }
    return report;
  } catch (const Json::exception& error) {
    throw InputError(path + ": not a coverage file (" + error.what() + "); give one that --coverage has written");
  }
}

void write_coverage(const std::string& path, const Report& report) {
  Json json{{"schema", kSchema}};
  json.update(coverage_json(report));
  write_text_file(path, json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::string summary_line(const Report& report) {
  const Totals t = totals_of(report);
  const auto number = [](std::uint64_t n) { return std::to_string(n); };
  return number(t.hit) + " of " + number(t.hit + t.holes) + " bins, " + number(t.pairs_hit) + " of " + number(t.pairs) +
         " pairs of states; " + number(t.excluded) + " bins excluded";
}

void print_coverage(std::ostream& out, const Report& report, std::size_t most) {
  const Totals t = totals_of(report);
  out << "runs        " << report.runs.size() << '\n'
      << "bins        " << t.hit << " of " << t.hit + t.holes << " hit, " << t.excluded << " excluded\n"
      << "pairs       " << t.pairs_hit << " of " << t.pairs << " pairs of values of two draw states\n"
      << "faults      " << t.faults_met << " of the " << t.faults << " seeded faults that a bin names\n";
  std::size_t width = 0;
  for (const BinResult& bin : report.bins)
    if (bin.is_hole()) width = std::max(width, bin.name.size());
  if (t.holes != 0) out << "\nnever hit\n";
  for (const BinResult& bin : report.bins)
    if (bin.is_hole())
      out << "  " << bin.name << std::string(width - bin.name.size() + 2, ' ') << bin.what << '\n'
          << std::string(width + 4, ' ') << bin.hit_by << '\n';
  const auto missing = report.missing_pairs();
  if (!missing.empty()) out << "\nnever drawn together\n";
  for (std::size_t n = 0; n < std::min(most, missing.size()); ++n)
    out << "  " << missing[n].a << ' ' << missing[n].a_value << " with " << missing[n].b << ' ' << missing[n].b_value
        << "\n      " << missing[n].hit_by << '\n';
  if (missing.size() > most) out << "  and " << missing.size() - most << " more pairs\n";
  std::map<std::string, std::vector<std::string>> reasons;
  for (const BinResult& bin : report.bins)
    if (!bin.excluded.empty()) reasons[bin.excluded].push_back(bin.name);
  if (!reasons.empty()) out << "\nexcluded\n";
  for (const auto& [reason, names] : reasons)
    out << "  " << reason << ": " << names.size() << (names.size() == 1 ? " bin, " : " bins, ") << names.front()
        << (names.size() > 1 ? " ...\n" : "\n");
}

void write_verilator_coverage(const std::string& path, const Report& report) {
  const std::string lines_path = path + ".txt";
  std::string data = "# SystemC::Coverage-3\n", lines;
  std::size_t line = 0;
  const auto add = [&](const std::string& page, const std::string& name, std::uint64_t hits) {
    const auto item = [](std::string_view key, const std::string& value) {
      return "\x01" + std::string(key) + "\x02" + value;
    };
    data += "C '" + item("f", lines_path) + item("l", std::to_string(++line)) + item("n", "0") + item("t", "user") +
            item("page", "v_user/" + page) + item("o", name) + item("h", "halfplane") + "' " + std::to_string(hits) +
            '\n';
    lines += name + '\n';
  };
  for (const BinResult& bin : report.bins)
    if (bin.excluded.empty()) add("bins", bin.name, bin.hits);
  for (const PairResult& pair : report.pairs)
    for_each_pair(pair, [&](const std::string& a, const std::string& b, std::uint64_t hits) {
      add("pairs", pair.a + "=" + a + " " + pair.b + "=" + b, hits);
    });
  write_text_file(lines_path, lines);
  write_text_file(path, data);
}

void write_coverage_page(const std::string& path, const Report& report, const std::string& command) {
  Json data{{"schema", kSchema}};
  data.update(coverage_json(report));
  data["missing_pairs"] = Json::array();
  for (const MissingPair& pair : report.missing_pairs())
    data["missing_pairs"].push_back(
        {{"a", pair.a}, {"a_value", pair.a_value}, {"b", pair.b}, {"b_value", pair.b_value}, {"hit_by", pair.hit_by}});
  data["version"] = HALFPLANE_VERSION;
  data["command"] = command;
  write_page(path, kCoveragePage, data);
}

}  // namespace halfplane::cover
