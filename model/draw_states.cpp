#include "draw_states.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>

namespace halfplane {
namespace {

// ---- conversion of a member to a StateValue and back: one pair of functions for each kind of type

// An optional value has the word for none as its last word.

template <class Value>
requires(std::is_enum_v<Value> || std::is_same_v<Value, bool>) StateValue to_value(Value value, std::size_t) {
  return {static_cast<std::size_t>(value), {}};
}

StateValue to_value(double value, std::size_t words) { return {words, {value}}; }
StateValue to_value(std::uint32_t value, std::size_t words) { return {words, {static_cast<double>(value)}}; }
template <class Value, std::size_t count>
StateValue to_value(const std::array<Value, count>& v, std::size_t words) {
  StateValue value{words, {}};
  std::ranges::transform(v, value.numbers.begin(), [](Value number) { return static_cast<double>(number); });
  return value;
}
template <class Box>
requires(std::is_same_v<Box, Rect> || std::is_same_v<Box, Viewport>) StateValue
    to_value(const Box& box, std::size_t words) {
  return {words,
          {static_cast<double>(box.x), static_cast<double>(box.y), static_cast<double>(box.width),
           static_cast<double>(box.height)}};
}

/// References to the numbers of a struct, in the order in which they are written.
constexpr auto numbers_of(
    auto& alpha) requires std::is_same_v<std::remove_const_t<std::remove_reference_t<decltype(alpha)>>, AlphaTest> {
  return std::tie(alpha.func, alpha.reference);
}
constexpr auto numbers_of(
    auto& blend) requires std::is_same_v<std::remove_const_t<std::remove_reference_t<decltype(blend)>>, BlendFactors> {
  return std::tie(blend.src, blend.dst, blend.src_alpha, blend.dst_alpha);
}
constexpr auto numbers_of(
    auto& s) requires std::is_same_v<std::remove_const_t<std::remove_reference_t<decltype(s)>>, Stencil> {
  return std::tie(s.func, s.reference, s.read_mask, s.write_mask, s.stencil_fails, s.depth_fails, s.passes);
}
template <class Value>
concept HasNumbers = requires(Value& value) {
  numbers_of(value);
};

template <HasNumbers Value>
StateValue to_value(const Value& from, std::size_t words) {
  StateValue value{words, {}};
  auto to = value.numbers.begin();
  std::apply([&to](const auto&... number) { ((*to++ = static_cast<double>(number)), ...); }, numbers_of(from));
  return value;
}

/// The end of a fog without one equals its density, and is not written; a value in a capture is dropped.
StateValue to_value(const Fog& fog, std::size_t words) {
  return {words, {static_cast<double>(fog.kind), fog.start, fog.kind == FogKind::linear ? fog.end : fog.start}};
}

template <class Value>
StateValue to_value(const std::optional<Value>& value, std::size_t words) {
  return value ? to_value(*value, words) : StateValue{words - 1, {}};
}

template <class Value>
requires(std::is_enum_v<Value> || std::is_same_v<Value, bool>) void from_value(const StateValue& from, Value& to,
                                                                               std::size_t) {
  to = static_cast<Value>(from.word);
}

void from_value(const StateValue& from, double& to, std::size_t) { to = from.numbers[0]; }
void from_value(const StateValue& from, std::uint32_t& to, std::size_t) {
  to = static_cast<std::uint32_t>(from.numbers[0]);
}
template <class Value, std::size_t count>
void from_value(const StateValue& from, std::array<Value, count>& to, std::size_t) {
  std::transform(from.numbers.begin(), from.numbers.begin() + count, to.begin(),
                 [](double number) { return static_cast<Value>(number); });
}
template <class Box>
requires(std::is_same_v<Box, Rect> || std::is_same_v<Box, Viewport>) void from_value(const StateValue& from, Box& to,
                                                                                     std::size_t) {
  using Number = decltype(to.x);
  const auto [x, y, width, height, f, g, h] = from.numbers;
  to = {static_cast<Number>(x), static_cast<Number>(y), static_cast<Number>(width), static_cast<Number>(height)};
}

template <HasNumbers Value>
void from_value(const StateValue& from, Value& to, std::size_t) {
  auto number = from.numbers.begin();
  std::apply(
      [&number](auto&... member) {
        ((member = static_cast<std::remove_reference_t<decltype(member)>>(*number++)), ...);
      },
      numbers_of(to));
}

void from_value(const StateValue& from, Fog& to, std::size_t) {
  to = {static_cast<FogKind>(from.numbers[0]), from.numbers[1], from.numbers[2]};
  if (to.kind != FogKind::linear) to.end = to.start;
}

template <class Value>
void from_value(const StateValue& from, std::optional<Value>& to, std::size_t words) {
  if (from.word == words - 1)
    to.reset();
  else
    from_value(from, to.emplace(), words);
}

// ---- conditions on every row, as far as the compiler can check them

/// Whether E has the value: compilers print a value without a name as a cast, "(E)7".
template <auto value>
consteval bool is_enumerator() {
  constexpr std::string_view function = __PRETTY_FUNCTION__;
  return function[function.find("value = ") + 8] != '(';
}

template <class E, int n = 0>
consteval std::size_t enumerators() {
  if constexpr (is_enumerator<static_cast<E>(n)>())
    return enumerators<E, n + 1>();
  else
    return n;
}

/// A row for a member. Does not compile for an enum if only some of its values have names, or none has.
template <auto member>
consteval DrawState row(DrawState state) {
  using Value = std::remove_cvref_t<decltype(std::declval<State>().*member)>;
  if constexpr (std::is_enum_v<Value>)
    if (state.words.size() != enumerators<Value>()) throw "an enumerator without a word, or a word too many";
  if (state.words.empty() && state.numbers.empty()) throw "a state without values";
  state.get_value = [](const State& from, std::size_t words) { return to_value(from.*member, words); };
  state.set_value = [](State& to, const StateValue& value, std::size_t words) { from_value(value, to.*member, words); };
  return state;
}

/// Converts to any member type, so that members can be counted.
struct AnyMember {
  template <class T>
  constexpr operator T() const {  // NOLINT(google-explicit-constructor)
    return T{};
  }
};

template <class T, class... Members>
consteval std::size_t count_members() {
  if constexpr (requires { T{Members()..., AnyMember()}; })
    return count_members<T, Members..., AnyMember>();
  else
    return sizeof...(Members);
}

// ---- the table

using Words = std::string_view;

// Rectangles stay small enough that sums of their numbers fit an int: far beyond any target (16384 pixels).
constexpr double far_away = 1 << 20;    // pixels
constexpr double farthest = 1e12;       // eye-space units
constexpr double widest_offset = 1e12;  // more than any slope between two codes of 32 bits

constexpr std::array<Words, 2> space_words{"clip", "window"};
constexpr std::array<Words, 8> depth_words{"never",   "less",   "lequal",   "equal",
                                           "greater", "gequal", "notequal", "always"};
constexpr std::array<Words, 2> switch_words{"off", "on"};
constexpr std::array<Words, 4> cull_words{"none", "back", "front", "both"};
constexpr std::array<Words, 2> front_words{"ccw", "cw"};
constexpr std::array<Words, 3> shade_words{"smooth", "flat", "phong"};
constexpr std::array<Words, 2> interp_words{"affine", "perspective"};
constexpr std::array<Words, 2> clip_z_words{"minus_one_one", "zero_one"};
constexpr std::array<Words, 2> pixel_center_words{"half", "integer"};
constexpr std::array<Words, 2> origin_words{"top_left", "bottom_left"};
constexpr std::array<Words, 1> scissor_words{"off"};
constexpr std::array<Words, 1> viewport_words{"full"};
constexpr std::array<Words, 2> provoking_words{"first", "last"};
constexpr std::array<Words, 3> polygon_mode_words{"fill", "line", "point"};
constexpr std::array<Words, 4> line_rule_words{"midpoint", "bresenham", "diamond", "rectangle"};
constexpr std::array<Words, 3> line_last_words{"off", "on", "rule"};
constexpr std::array<Words, 2> point_shape_words{"square", "round"};
constexpr std::array<Words, 2> point_clip_words{"pixel", "center"};

constexpr std::array<Words, 1> texture_words{"off"};
constexpr std::array<Words, 2> texture_interp_words{"perspective", "affine"};
constexpr std::array<Words, 6> texture_min_words{"nearest",
                                                 "linear",
                                                 "nearest_mipmap_nearest",
                                                 "linear_mipmap_nearest",
                                                 "nearest_mipmap_linear",
                                                 "linear_mipmap_linear"};
constexpr std::array<Words, 2> texture_mag_words{"nearest", "linear"};
constexpr std::array<Words, 5> wrap_words{"repeat", "clamp", "mirror", "border", "half_border"};
static_assert(wrap_words.size() == enumerators<TextureWrap>());
constexpr std::array<Words, 5> combine_words{"modulate", "replace", "decal", "add", "blend"};
static_assert(combine_words.size() == enumerators<TextureCombine>());

constexpr std::array<Words, 3> fog_words{"linear", "exp", "exp2"};
static_assert(fog_words.size() == enumerators<FogKind>());
constexpr std::array<Words, 15> factor_words{"zero",
                                             "one",
                                             "src_color",
                                             "one_minus_src_color",
                                             "dst_color",
                                             "one_minus_dst_color",
                                             "src_alpha",
                                             "one_minus_src_alpha",
                                             "dst_alpha",
                                             "one_minus_dst_alpha",
                                             "constant_color",
                                             "one_minus_constant_color",
                                             "constant_alpha",
                                             "one_minus_constant_alpha",
                                             "src_alpha_saturate"};
static_assert(factor_words.size() == enumerators<BlendFactor>());
constexpr std::array<Words, 5> equation_words{"add", "subtract", "reverse_subtract", "min", "max"};
static_assert(equation_words.size() == enumerators<BlendEquation>());
constexpr std::array<Words, 16> logic_op_words{
    "clear", "and",   "and_reverse", "copy",       "and_inverted",  "noop",        "xor",  "or",
    "nor",   "equiv", "invert",      "or_reverse", "copy_inverted", "or_inverted", "nand", "set"};
constexpr std::array<Words, 8> stencil_op_words{"keep", "zero",   "replace",   "incr",
                                                "decr", "invert", "incr_wrap", "decr_wrap"};
static_assert(stencil_op_words.size() == enumerators<StencilOp>());
constexpr std::array<Words, 1> off_words{"off"};
constexpr std::array<Words, 1> same_words{"same"};
constexpr std::array<Words, 1> all_words{"all"};

/// One of a list of words.
constexpr StateNumber word_number(Words what, std::span<const Words> words, std::size_t repeats = 0) {
  return {.what = what,
          .low = 0,
          .high = static_cast<double>(words.size() - 1),
          .is_whole = true,
          .random_step = 1,
          .random_count = static_cast<unsigned>(words.size()),
          .words = words,
          .repeats = repeats};
}
/// A code of 8 bits.
constexpr StateNumber byte_number(Words what, double random_step = 51, unsigned random_count = 6) {
  return {
      .what = what, .low = 0, .high = 255, .is_whole = true, .random_step = random_step, .random_count = random_count};
}
// At most as far as the vertices of random scenes, and denser than visible.
constexpr std::array<StateNumber, 3> fog_numbers{
    {word_number("fog's kind", fog_words),
     {"fog's start or density", 0, farthest, false, false, 0, 0.125, 9},
     {.what = "fog's end", .low = 0, .high = farthest, .random_step = 0.25, .random_count = 13, .repeats = 1}}};
constexpr std::array<StateNumber, 3> fog_color_numbers{
    {byte_number("fog_color's red"), byte_number("fog_color's green"), byte_number("fog_color's blue")}};
constexpr std::array<StateNumber, 3> light_direction_numbers{
    {{"light_direction's x", -farthest, farthest, false, false, -1, 0.5, 5},
     {"light_direction's y", -farthest, farthest, false, false, -1, 0.5, 5},
     {"light_direction's z", -farthest, farthest, false, false, -1, 0.5, 5}}};
constexpr std::array<StateNumber, 3> light_half_numbers{
    {{"light_half's x", -farthest, farthest, false, false, -1, 0.5, 5},
     {"light_half's y", -farthest, farthest, false, false, -1, 0.5, 5},
     {"light_half's z", -farthest, farthest, false, false, -1, 0.5, 5}}};
constexpr std::array<StateNumber, 3> light_ambient_numbers{
    {byte_number("light_ambient's red"), byte_number("light_ambient's green"), byte_number("light_ambient's blue")}};
constexpr std::array<StateNumber, 3> light_diffuse_numbers{
    {byte_number("light_diffuse's red"), byte_number("light_diffuse's green"), byte_number("light_diffuse's blue")}};
constexpr std::array<StateNumber, 3> light_specular_numbers{
    {byte_number("light_specular's red"), byte_number("light_specular's green"), byte_number("light_specular's blue")}};
constexpr std::array<StateNumber, 1> light_shininess_numbers{{{"light_shininess", 1, 128, false, false, 1, 0.75, 170}}};
constexpr std::array<StateNumber, 2> alpha_test_numbers{
    {word_number("alpha_test's function", depth_words), byte_number("alpha_test's reference")}};
constexpr std::array<StateNumber, 4> blend_numbers{
    {word_number("the factor of the source", factor_words), word_number("the factor of the destination", factor_words),
     word_number("the factor of the source's alpha", factor_words, 2),
     word_number("the factor of the destination's alpha", factor_words, 2)}};
constexpr std::array<StateNumber, 2> blend_equation_numbers{{word_number("the equation of the colour", equation_words),
                                                             word_number("the equation of alpha", equation_words, 1)}};
constexpr std::array<StateNumber, 4> blend_color_numbers{
    {byte_number("blend_color's red"), byte_number("blend_color's green"), byte_number("blend_color's blue"),
     byte_number("blend_color's alpha")}};
constexpr std::array<StateNumber, 4> color_mask_numbers{
    {word_number("color_mask of red", switch_words), word_number("color_mask of green", switch_words),
     word_number("color_mask of blue", switch_words), word_number("color_mask of alpha", switch_words)}};
// References, masks and stored values close together, so that all outcomes occur.
constexpr std::array<StateNumber, 7> stencil_numbers{
    {word_number("the stencil's function", depth_words), byte_number("the stencil's reference", 1, 4),
     byte_number("the mask that is read through", 85, 4), byte_number("the mask that is written through", 85, 4),
     word_number("what to do where the stencil test fails", stencil_op_words),
     word_number("what to do where the depth test fails", stencil_op_words),
     word_number("what to do where both pass", stencil_op_words)}};
constexpr std::array<StateNumber, 1> sample_mask_numbers{{{.what = "sample_mask",
                                                           .low = 0,
                                                           .high = 255,
                                                           .is_whole = true,
                                                           .random_step = 1,
                                                           .random_count = 256,
                                                           .is_hex = true}}};

constexpr std::array<StateNumber, 1> texture_numbers{{
    {"texture", 0, 65535, true, false, 0, 1, 0, {}, true},
}};
constexpr std::array<StateNumber, 2> texture_wrap_numbers{{
    {"texture_wrap along u", 0, 4, true, false, 0, 1, 3, wrap_words},
    {"texture_wrap along v", 0, 4, true, false, 0, 1, 3, wrap_words},
}};
constexpr std::array<StateNumber, 4> texture_border_numbers{
    {byte_number("texture_border's red"), byte_number("texture_border's green"), byte_number("texture_border's blue"),
     byte_number("texture_border's alpha")}};
constexpr std::array<StateNumber, 3> texture_lod_numbers{{
    {"texture_lod's bias", -16, 16, false, false, -2, 0.25, 17},
    {"texture_lod's least level", 0, 12, false, false, 0, 0.5, 4},
    {"texture_lod's largest level", 0, 12, false, false, 2, 0.5, 21},
}};
constexpr std::array<StateNumber, 3> texture_constant_numbers{{byte_number("texture_constant's red"),
                                                               byte_number("texture_constant's green"),
                                                               byte_number("texture_constant's blue")}};
constexpr std::array<StateNumber, 4> scissor_numbers{{
    {"scissor x", -far_away, far_away, true, false, -5, 1, 26},
    {"scissor y", -far_away, far_away, true, false, -5, 1, 26},
    {"scissor width", 0, far_away, true, false, 0, 1, 49},
    {"scissor height", 0, far_away, true, false, 0, 1, 49},
}};
constexpr std::array<StateNumber, 4> viewport_numbers{{
    {"viewport x", -far_away, far_away, false, false, -4, 0.25, 33},
    {"viewport y", -far_away, far_away, false, false, -4, 0.25, 33},
    {"viewport width", 0, far_away, false, true, 1, 0.25, 100},
    {"viewport height", 0, far_away, false, true, 1, 0.25, 100},
}};
constexpr std::array<StateNumber, 2> depth_range_numbers{{
    {"a bound of depth_range", 0, 1, false, false, 0, 0.125, 9},
    {"a bound of depth_range", 0, 1, false, false, 0, 0.125, 9},
}};
constexpr std::array<StateNumber, 2> polygon_offset_numbers{{
    {"polygon_offset's slope factor", -widest_offset, widest_offset, false, false, -4, 0.5, 17},
    {"polygon_offset's constant", -widest_offset, widest_offset, false, false, -4, 1, 9},
}};
constexpr std::array<StateNumber, 1> line_width_numbers{{{"line_width", 1, far_away, false, false, 1, 0.25, 24}}};
constexpr std::array<StateNumber, 1> point_size_numbers{{{"point_size", 1, far_away, false, false, 1, 0.0625, 200}}};

constexpr std::array table{
    row<&State::space>({.name = "space",
                        .words = space_words,
                        .purpose = "what the coordinates of vertices mean; written as a line of its own",
                        .simplest = "window"}),
    row<&State::depth_test>({.name = "depth_test",
                             .words = depth_words,
                             .purpose = "how a fragment's depth must compare with the stored one",
                             .home = StateHome::primitive}),
    row<&State::depth_write>({.name = "depth_write",
                              .words = switch_words,
                              .purpose = "whether a fragment that passes stores its depth",
                              .home = StateHome::primitive}),
    row<&State::color_write>({.name = "color_write",
                              .words = switch_words,
                              .purpose = "whether it stores its colour",
                              .home = StateHome::primitive}),
    row<&State::cull>({.name = "cull",
                       .words = cull_words,
                       .purpose = "which triangles are not drawn",
                       .home = StateHome::primitive}),
    row<&State::front>({.name = "front",
                        .words = front_words,
                        .purpose = "which triangles are front faces, as seen on the screen",
                        .home = StateHome::primitive}),
    row<&State::shade>({.name = "shade",
                        .words = shade_words,
                        .purpose = "flat: the colour of the provoking vertex, all over the primitive; phong: of filled "
                                   "triangles, colours in the light of each fragment",
                        .refused = "phong"}),
    row<&State::color_interp>({.name = "color_interp",
                               .words = interp_words,
                               .purpose = "how colours run over a primitive",
                               .refused = "perspective"}),
    row<&State::clip_z>({.name = "clip_z",
                         .words = clip_z_words,
                         .purpose = "where the near plane of clip space lies, at z = −w or at z = 0"}),
    row<&State::pixel_center>({.name = "pixel_center",
                               .words = pixel_center_words,
                               .purpose = "where the pixel centres of window-space vertices and of the viewport lie; "
                                          "the first one at ½ or at 0"}),
    row<&State::origin>({.name = "origin",
                         .words = origin_words,
                         .purpose = "what window-space vertices, viewport and scissor count from, with y down from "
                                    "the top, y up from the bottom; the y of a rectangle is that of its side at the "
                                    "origin"}),
    row<&State::scissor>({.name = "scissor",
                          .words = scissor_words,
                          .numbers = scissor_numbers,
                          .form = "x y width height",
                          .unit = "pixels",
                          .purpose = "what may be drawn and cleared: whole pixels, numbered from the `origin`, the "
                                     "first one 0 under either `pixel_center`"}),
    row<&State::viewport>({.name = "viewport",
                           .words = viewport_words,
                           .numbers = viewport_numbers,
                           .form = "x y width height",
                           .unit = "pixels",
                           .purpose = "where clip space comes to lie: pixels in the window coordinates of "
                                      "`pixel_center` and `origin`, fractions allowed (the whole target is `0 0 W H`, "
                                      "or `-0.5 -0.5 W H` under `integer`)"}),
    row<&State::depth_range>({.name = "depth_range",
                              .numbers = depth_range_numbers,
                              .form = "near far",
                              .purpose = "window z of the near and the far plane, in either order"}),
    row<&State::provoking>(
        {.name = "provoking", .words = provoking_words, .purpose = "the vertex whose colour `shade flat` takes"}),
    row<&State::polygon_mode>(
        {.name = "polygon_mode", .words = polygon_mode_words, .purpose = "what is drawn of a triangle"}),
    row<&State::polygon_offset>({.name = "polygon_offset",
                                 .numbers = polygon_offset_numbers,
                                 .form = "factor constant",
                                 .purpose = "added to a triangle's depth, factor times its steeper slope per pixel "
                                            "plus the constant, in depth codes"}),
    row<&State::line_rule>({.name = "line_rule",
                            .words = line_rule_words,
                            .purpose = "which pixels a line covers; `rectangle`: the samples of a rectangle about it, "
                                       "by two triangles"}),
    row<&State::line_last>({.name = "line_last",
                            .words = line_last_words,
                            .purpose = "whether a line's last pixel is drawn; `rule`: as its rule has it"}),
    row<&State::line_width>({.name = "line_width",
                             .numbers = line_width_numbers,
                             .form = "width",
                             .unit = "pixels",
                             .purpose = "pixels that a line covers across its minor axis, rounded to a whole number, "
                                        "or the width of its rectangle; the draw refuses lines that could reach the "
                                        "target from outside the guard band"}),
    row<&State::smooth>(
        {.name = "smooth",
         .words = switch_words,
         .purpose = "what a line's rectangle, or a point, covers of a pixel multiplies alpha; blend it to see it; with "
                    "several samples a pixel nobody looks at it"}),
    row<&State::point_size>({.name = "point_size",
                             .numbers = point_size_numbers,
                             .form = "size",
                             .unit = "pixels",
                             .purpose = "side of the square, fractions allowed; the draw refuses points that could "
                                        "reach the target from outside the guard band"}),
    row<&State::point_shape>({.name = "point_shape",
                              .words = point_shape_words,
                              .purpose = "which of its square's pixels a point covers: all, or those whose centres "
                                         "lie in the disc that the square holds"}),
    row<&State::point_clip>(
        {.name = "point_clip", .words = point_clip_words, .purpose = "what the view's sides clip of a point"}),
    row<&State::texture>({.name = "texture",
                          .words = texture_words,
                          .numbers = texture_numbers,
                          .form = "NAME",
                          .purpose = "the texture of filled triangles, by the name of its line"}),
    row<&State::texture_interp>({.name = "texture_interp",
                                 .words = texture_interp_words,
                                 .purpose = "how its coordinates run over a triangle"}),
    row<&State::texture_min>({.name = "texture_min",
                              .words = texture_min_words,
                              .purpose = "which texels count where a pixel holds more than one"}),
    row<&State::texture_mag>({.name = "texture_mag",
                              .words = texture_mag_words,
                              .purpose = "which texels count where a pixel holds less than one"}),
    row<&State::texture_wrap>({.name = "texture_wrap",
                               .numbers = texture_wrap_numbers,
                               .form = "S T",
                               .purpose = "what lies beyond the image along u and v; `clamp` is to its edge, `border` "
                                          "a colour, `half_border` holds the coordinate in the image, so that a "
                                          "linear filter mixes half of that colour at its sides"}),
    row<&State::texture_border>({.name = "texture_border",
                                 .numbers = texture_border_numbers,
                                 .form = "r g b a",
                                 .purpose = "that colour; of a texture without alpha a counts as 255",
                                 .home = StateHome::unit}),
    row<&State::texture_lod>({.name = "texture_lod",
                              .numbers = texture_lod_numbers,
                              .form = "bias min max",
                              .purpose = "added to the level of detail, which is then held between min and max"}),
    row<&State::texture_combine>({.name = "texture_combine",
                                  .words = combine_words,
                                  .purpose = "what becomes of the triangle's colour and the texel; `blend`: from the "
                                             "colour to the constant, by the texel's channels"}),
    row<&State::texture_constant>({.name = "texture_constant",
                                   .numbers = texture_constant_numbers,
                                   .form = "r g b",
                                   .purpose = "the constant of `texture_combine blend`",
                                   .home = StateHome::unit}),
    row<&State::fog>({.name = "fog",
                      .words = off_words,
                      .numbers = fog_numbers,
                      .form = "kind start [end]",
                      .purpose = "how much of the colour is left at a distance w from the eye: `linear start end` "
                                 "(end − w) / (end − start), `exp density` e^(−density·w), `exp2 density` "
                                 "e^(−(density·w)²)",
                      .home = StateHome::unit}),
    row<&State::fog_color>({.name = "fog_color",
                            .numbers = fog_color_numbers,
                            .form = "r g b",
                            .purpose = "the colour of fog, which takes the place of the rest",
                            .home = StateHome::unit}),
    row<&State::light_direction>({.name = "light_direction",
                                  .numbers = light_direction_numbers,
                                  .form = "x y z",
                                  .purpose = "of `shade phong`: to the light, in the space of the normals, of any "
                                             "length",
                                  .home = StateHome::unit}),
    row<&State::light_half>(
        {.name = "light_half",
         .numbers = light_half_numbers,
         .form = "x y z",
         .purpose = "the direction between that one and the one to the eye, in which highlights lie",
         .home = StateHome::unit}),
    row<&State::light_ambient>({.name = "light_ambient",
                                .numbers = light_ambient_numbers,
                                .form = "r g b",
                                .purpose = "what of a colour shows without light, 255 for all of it",
                                .home = StateHome::unit}),
    row<&State::light_diffuse>({.name = "light_diffuse",
                                .numbers = light_diffuse_numbers,
                                .form = "r g b",
                                .purpose = "what shows besides where the light falls straight on it",
                                .home = StateHome::unit}),
    row<&State::light_specular>({.name = "light_specular",
                                 .numbers = light_specular_numbers,
                                 .form = "r g b",
                                 .purpose = "the colour of highlights, which is added",
                                 .home = StateHome::unit}),
    row<&State::light_shininess>({.name = "light_shininess",
                                  .numbers = light_shininess_numbers,
                                  .form = "power",
                                  .purpose = "the power of N·H that a highlight is",
                                  .home = StateHome::unit}),
    row<&State::alpha_test>({.name = "alpha_test",
                             .numbers = alpha_test_numbers,
                             .form = "func ref",
                             .purpose = "how a fragment's alpha, after its texture, must compare with the reference",
                             .home = StateHome::unit}),
    row<&State::blend>({.name = "blend",
                        .words = off_words,
                        .numbers = blend_numbers,
                        .form = "src dst [src_a dst_a]",
                        .purpose = "what the fragment's and the stored colour are multiplied with before they are put "
                                   "together; without the last two, alpha as the colour",
                        .home = StateHome::unit}),
    row<&State::blend_equation>({.name = "blend_equation",
                                 .numbers = blend_equation_numbers,
                                 .form = "eq [eq_a]",
                                 .purpose = "how they are put together; `min` and `max` take no factors",
                                 .home = StateHome::unit}),
    row<&State::blend_color>({.name = "blend_color",
                              .numbers = blend_color_numbers,
                              .form = "r g b a",
                              .purpose = "the constant of blend factors",
                              .home = StateHome::unit}),
    row<&State::logic_op>({.name = "logic_op",
                           .words = logic_op_words,
                           .purpose = "what is stored of the fragment's code and the stored one, bit by bit, instead "
                                      "of blending; `copy`: no operation, `blend` holds",
                           .home = StateHome::unit}),
    row<&State::color_mask>({.name = "color_mask",
                             .numbers = color_mask_numbers,
                             .form = "r g b a",
                             .purpose = "which channels `color_write` writes",
                             .home = StateHome::unit}),
    row<&State::stencil>({.name = "stencil",
                          .words = off_words,
                          .numbers = stencil_numbers,
                          .form = "func ref read write sfail zfail zpass",
                          .purpose = "how the reference must compare with the stored stencil value, both through the "
                                     "mask `read`, and what becomes of that through the mask `write`",
                          .home = StateHome::unit}),
    row<&State::stencil_back>({.name = "stencil_back",
                               .words = same_words,
                               .numbers = stencil_numbers,
                               .form = "func ref read write sfail zfail zpass",
                               .purpose = "the same for triangles that show their back, while `stencil` is not off",
                               .home = StateHome::unit}),
    row<&State::dither>({.name = "dither",
                         .words = switch_words,
                         .purpose = "whether a colour is spread over its neighbours where it is stored in fewer than 8 "
                                    "bits a channel",
                         .home = StateHome::unit}),
    row<&State::sample_mask>({.name = "sample_mask",
                              .words = all_words,
                              .numbers = sample_mask_numbers,
                              .form = "HEX",
                              .purpose =
                                  "which samples of a pixel are drawn, in hexadecimal digits, sample 0 the lowest "
                                  "bit; does nothing where a pixel has one sample",
                              .home = StateHome::unit}),
    row<&State::alpha_to_coverage>({.name = "alpha_to_coverage",
                                    .words = switch_words,
                                    .purpose =
                                        "whether alpha says how many of a pixel's samples are drawn; does nothing "
                                        "where a pixel has one sample",
                                    .home = StateHome::unit}),
};

static_assert(table.size() == count_members<State>(), "a member of State has no row, or two");

}  // namespace

StateValue DrawState::simplest_value() const {
  if (simplest.empty()) return default_value();
  return {static_cast<std::size_t>(std::ranges::find(words, simplest) - words.begin()), {}};
}

std::span<const DrawState> draw_states() { return table; }

const DrawState& draw_state(std::string_view name) { return *std::ranges::find(table, name, &DrawState::name); }

Signature signature_of(const State& state) {
  SignatureHash hash;
  for (const DrawState& row : table) {
    const StateValue value = row.value(state);
    hash.add(value.word);
    for (const double number : std::span(value.numbers).first(row.numbers.size()))
      hash.add(std::bit_cast<std::uint64_t>(number + 0.0));  // -0 is 0
  }
  return hash.signature();
}

std::size_t StateHash::operator()(const State& state) const {
  return static_cast<std::size_t>(signature_of(state).low);
}

}  // namespace halfplane
