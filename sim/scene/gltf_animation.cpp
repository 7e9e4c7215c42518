#include "sim/scene/gltf_animation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "model/as_number.hpp"
#include "model/config.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {
namespace {

using Element = std::array<double, 4>;

Element blend(double a, const Element& left, double b, const Element& right) {
  Element result{};
  for (std::size_t i = 0; i < 4; ++i) result[i] = a * left[i] + b * right[i];
  return result;
}

double inner(const Element& a, const Element& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }

Element unit(const Element& q) {
  const double norm = std::sqrt(inner(q, q));
  return norm > 0 ? blend(1 / norm, q, 0, q) : Element{0, 0, 0, 1};  // a spline may pass through 0
}

// Along the great circle; q and -q are one rotation, so there is always an arc of at most 90 degrees.
Element slerp(const Element& from, Element to, double part) {
  double cosine = inner(from, to);
  if (cosine < 0) {
    to = blend(-1, to, 0, to);
    cosine = -cosine;
  }
  constexpr double kStraight = 1 - 1e-12;  // arc and chord are equal in binary64, and the quotient below approaches 0/0
  if (cosine > kStraight) return unit(blend(1 - part, from, part, to));
  const double angle = std::acos(cosine);
  return blend(std::sin((1 - part) * angle) / std::sin(angle), from, std::sin(part * angle) / std::sin(angle), to);
}

// Hermite's polynomial; tangents are per second, so they are scaled by the distance of the keyframes.
Element spline(const GltfTrack& track, std::size_t key, double part, double seconds) {
  const Element &from = track.values[3 * key + 1], &out = track.values[3 * key + 2];
  const Element &in = track.values[3 * key + 3], &to = track.values[3 * key + 4];
  const double t2 = part * part, t3 = t2 * part;
  return blend(1, blend(2 * t3 - 3 * t2 + 1, from, seconds * (t3 - 2 * t2 + part), out), 1,
               blend(-2 * t3 + 3 * t2, to, seconds * (t3 - t2), in));
}

std::optional<GltfTrack::Path> path_of(const std::string& word) {
  if (word == "translation") return GltfTrack::Path::translation;
  if (word == "rotation") return GltfTrack::Path::rotation;
  if (word == "scale") return GltfTrack::Path::scale;
  if (word == "weights") return GltfTrack::Path::weight;
  return std::nullopt;
}

GltfTrack::Interpolation interpolation_of(const JsonPlace& sampler) {
  // The format has no numbers here, but an exporter for Maya and 3ds Max writes 0, the first of its own list: LINEAR.
  const std::optional<JsonPlace> given = sampler.find("interpolation");
  if (given && !given->is_text() && given->number() == 0) return GltfTrack::Interpolation::linear;
  const std::string word = sampler.text_or("interpolation", "LINEAR");
  if (word == "LINEAR") return GltfTrack::Interpolation::linear;
  if (word == "STEP") return GltfTrack::Interpolation::step;
  if (word == "CUBICSPLINE") return GltfTrack::Interpolation::cubic_spline;
  sampler.fail("interpolation " + in_quotes(word), "it is LINEAR, STEP or CUBICSPLINE");
}

void read_times(const GltfAccessor& input, const JsonPlace& place, GltfTrack& track) {
  if (input.width != 1 || input.component != GltfComponent::f32)
    place.fail("times that are no binary32 numbers", "use SCALAR and component type 5126");
  for (std::uint64_t i = 0; i < input.count; ++i) {
    const double time = read_element(input, i)[0];
    if (time < 0 || (i > 0 && time <= track.times.back()))
      place.fail("keyframe " + std::to_string(i) + " is not later than the one before", "export the file again");
    track.times.push_back(time);
  }
}

void read_values(const GltfAccessor& output, const JsonPlace& place, GltfTrack& track) {
  const int width = track.path == GltfTrack::Path::rotation ? 4 : 3;
  if (output.width != width)
    place.fail("an accessor of " + std::to_string(output.width) + " numbers an element",
               "use VEC" + std::to_string(width));
  const bool is_spline = track.interpolation == GltfTrack::Interpolation::cubic_spline;
  const std::uint64_t wanted = track.times.size() * (is_spline ? 3U : 1U);
  if (output.count != wanted)
    place.fail(std::to_string(output.count) + " elements where keyframes need " + std::to_string(wanted),
               "export the file again");
  for (std::uint64_t i = 0; i < output.count; ++i) {
    Element value = read_element(output, i);
    const bool is_tangent = is_spline && i % 3 != 1;
    if (width == 4 && !is_tangent) {
      if (!(inner(value, value) > 0)) place.fail("a rotation of length 0", "write 0, 0, 0, 1 for none");
      value = unit(value);  // exporters write binary32 or less
    }
    track.values.push_back(value);
  }
}

/// Adds a channel of weights: for each keyframe the weights of all targets; for a spline all in-tangents, then all values,
/// then all out-tangents.
void add_weights(const GltfAccessor& output, const JsonPlace& place, const GltfTrack& common,
                 std::vector<GltfTrack>& tracks) {
  const std::uint64_t parts = common.interpolation == GltfTrack::Interpolation::cubic_spline ? 3 : 1;
  const std::uint64_t rows = common.times.size() * parts, targets = output.count / rows;
  if (output.width != 1)
    place.fail("an accessor of " + std::to_string(output.width) + " numbers an element", "use SCALAR");
  if (targets * rows != output.count || targets == 0)
    place.fail(std::to_string(output.count) + " weights for " + std::to_string(rows) + " keyframes and tangents",
               "export the file again");
  for (std::uint64_t k = 0; k < targets; ++k) {
    GltfTrack& track = tracks.emplace_back(common);
    track.target = static_cast<std::size_t>(k);
    for (std::uint64_t row = 0; row < rows; ++row) track.values.push_back(read_element(output, row * targets + k));
  }
}

}  // namespace

std::size_t choose_animation(const GltfFile& file, const std::string& name) {
  const std::size_t count = file.count("animations");
  if (count == 0) throw InputError("--time: " + file.name() + " has no animations; leave out --time and --animation");
  if (name.empty()) return 0;
  std::string names;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string known = file.item("animations", i).text_or("name", std::to_string(i));
    if (known == name) return i;
    if (names.size() < 200) names += (names.empty() ? "" : ", ") + printable(known);
  }
  // Many exporters give no names.
  if (const auto number = as_number<std::size_t>(name); number && *number < count) return *number;
  throw InputError("--animation: no animation " + in_quotes(name) + " in this scene; there are " + names);
}

GltfAnimation read_animation(GltfFile& file, std::size_t number) {
  GltfAnimation result;
  const JsonPlace animation = file.item("animations", number);
  const JsonPlace channels = animation.at("channels"), samplers = animation.at("samplers");
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const JsonPlace target = channels[i].at("target");
    const std::optional<JsonPlace> node = target.find("node");
    const std::optional<GltfTrack::Path> path = path_of(target.at("path").text());
    if (!node || !path) continue;
    GltfTrack track;
    track.node = node->index(file.count("nodes"), "nodes");
    track.path = *path;
    const bool is_weight = track.path == GltfTrack::Path::weight;
    if (!is_weight && file.item("nodes", track.node).find("matrix"))
      node->fail("it moves a node that has a matrix", "give the node translation, rotation and scale");
    const JsonPlace sampler = samplers[channels[i].at("sampler").index(samplers.size(), "samplers")];
    track.interpolation = interpolation_of(sampler);
    read_times(file.accessor(sampler.at("input")), sampler.at("input"), track);
    result.end = std::max(result.end, track.times.back());
    const JsonPlace output = sampler.at("output");
    if (is_weight) {
      add_weights(file.accessor(output), output, track, result.tracks);
    } else {
      read_values(file.accessor(output), output, track);
      result.tracks.push_back(std::move(track));
    }
  }
  return result;
}

std::array<double, 4> value_at(const GltfTrack& track, double time) {
  const bool is_spline = track.interpolation == GltfTrack::Interpolation::cubic_spline;
  const auto key_value = [&](std::size_t key) { return track.values[is_spline ? 3 * key + 1 : key]; };
  const auto later = std::upper_bound(track.times.begin(), track.times.end(), time);
  if (later == track.times.begin()) return key_value(0);
  const auto key = static_cast<std::size_t>(later - track.times.begin()) - 1;
  if (later == track.times.end() || track.interpolation == GltfTrack::Interpolation::step) return key_value(key);
  const double seconds = *later - track.times[key], part = (time - track.times[key]) / seconds;
  const bool is_rotation = track.path == GltfTrack::Path::rotation;
  if (is_spline) {
    const Element value = spline(track, key, part, seconds);
    return is_rotation ? unit(value) : value;
  }
  if (is_rotation) return slerp(key_value(key), key_value(key + 1), part);
  return blend(1 - part, key_value(key), part, key_value(key + 1));
}

void apply(const GltfTrack& track, double time, NodeTransform& transform) {
  if (track.path == GltfTrack::Path::weight) return;
  const Element value = value_at(track, time);
  if (track.path == GltfTrack::Path::rotation) {
    transform.rotation = value;
    return;
  }
  std::array<double, 3>& part = track.path == GltfTrack::Path::translation ? transform.translation : transform.scale;
  std::copy_n(value.begin(), 3, part.begin());
}

}  // namespace halfplane
