#include "draw_states.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>

#include "enum_names.hpp"

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

constexpr std::array<std::string_view, 2> switch_words{"off", "on"};

/// A row for a member. An enum has the names of its values, unless the row says other words, one for each; a bool has
/// off and on.
template <auto member>
consteval DrawState row(DrawState state) {
  using Value = std::remove_cvref_t<decltype(std::declval<State>().*member)>;
  if (state.words.empty() && state.numbers.empty()) {
    if constexpr (std::is_enum_v<Value>) state.words = kNamesOf<Value>;
    if constexpr (std::is_same_v<Value, bool>) state.words = switch_words;
  }
  if constexpr (std::is_enum_v<Value>)
    if (state.words.size() != enumerators<Value>()) throw "an enumerator without a word, or a word too many";
  if (state.words.empty() && state.numbers.empty()) throw "a state without values";
  state.get_value = [](const State& from, std::size_t words) { return to_value(from.*member, words); };
  state.set_value = [](State& to, const StateValue& value, std::size_t words) { from_value(value, to.*member, words); };
  return state;
}

/// A row for a member whose value is a word; `words`: other ones than row() finds.
template <auto member>
consteval DrawState word_row(std::string_view name, std::string_view purpose, StateHome home = StateHome::host,
                             std::span<const std::string_view> words = {}) {
  return row<member>({.name = name, .words = words, .purpose = purpose, .home = home});
}
/// A row for a member whose value is numbers, or one of `words`.
template <auto member>
consteval DrawState number_row(std::string_view name, std::span<const StateNumber> numbers, std::string_view form,
                               std::string_view purpose, StateHome home = StateHome::host,
                               std::span<const std::string_view> words = {}) {
  return row<member>(
      {.name = name, .words = words, .numbers = numbers, .form = form, .purpose = purpose, .home = home});
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

constexpr std::array<Words, 1> viewport_words{"full"};
constexpr std::array<Words, 3> line_last_words{"off", "on", "rule"};

constexpr std::array<Words, 16> logic_op_words{
    "clear", "and",   "and_reverse", "copy",       "and_inverted",  "noop",        "xor",  "or",
    "nor",   "equiv", "invert",      "or_reverse", "copy_inverted", "or_inverted", "nand", "set"};
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
    {word_number("fog's kind", kNamesOf<FogKind>),
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
    {word_number("alpha_test's function", kNamesOf<DepthFunc>), byte_number("alpha_test's reference")}};
constexpr std::array<StateNumber, 4> blend_numbers{
    {word_number("the factor of the source", kNamesOf<BlendFactor>),
     word_number("the factor of the destination", kNamesOf<BlendFactor>),
     word_number("the factor of the source's alpha", kNamesOf<BlendFactor>, 2),
     word_number("the factor of the destination's alpha", kNamesOf<BlendFactor>, 2)}};
constexpr std::array<StateNumber, 2> blend_equation_numbers{
    {word_number("the equation of the colour", kNamesOf<BlendEquation>),
     word_number("the equation of alpha", kNamesOf<BlendEquation>, 1)}};
constexpr std::array<StateNumber, 4> blend_color_numbers{
    {byte_number("blend_color's red"), byte_number("blend_color's green"), byte_number("blend_color's blue"),
     byte_number("blend_color's alpha")}};
constexpr std::array<StateNumber, 4> color_mask_numbers{
    {word_number("color_mask of red", switch_words), word_number("color_mask of green", switch_words),
     word_number("color_mask of blue", switch_words), word_number("color_mask of alpha", switch_words)}};
// References, masks and stored values close together, so that all outcomes occur.
constexpr std::array<StateNumber, 7> stencil_numbers{
    {word_number("the stencil's function", kNamesOf<DepthFunc>), byte_number("the stencil's reference", 1, 4),
     byte_number("the mask that is read through", 85, 4), byte_number("the mask that is written through", 85, 4),
     word_number("what to do where the stencil test fails", kNamesOf<StencilOp>),
     word_number("what to do where the depth test fails", kNamesOf<StencilOp>),
     word_number("what to do where both pass", kNamesOf<StencilOp>)}};
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
    {"texture_wrap along u", 0, 4, true, false, 0, 1, 3, kNamesOf<TextureWrap>},
    {"texture_wrap along v", 0, 4, true, false, 0, 1, 3, kNamesOf<TextureWrap>},
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
                        .purpose = "what the coordinates of vertices mean; written as a line of its own",
                        .simplest = "window"}),
    word_row<&State::depth_test>("depth_test", "how a fragment's depth must compare with the stored one",
                                 StateHome::primitive),
    word_row<&State::depth_write>("depth_write", "whether a fragment that passes stores its depth",
                                  StateHome::primitive),
    word_row<&State::color_write>("color_write", "whether it stores its colour", StateHome::primitive),
    word_row<&State::cull>("cull", "which triangles are not drawn", StateHome::primitive),
    word_row<&State::front>("front", "which triangles are front faces, as seen on the screen", StateHome::primitive),
    row<&State::shade>({.name = "shade",
                        .purpose = "flat: the colour of the provoking vertex, all over the primitive; phong: of filled "
                                   "triangles, colours in the light of each fragment",
                        .refused = "phong"}),
    row<&State::color_interp>(
        {.name = "color_interp", .purpose = "how colours run over a primitive", .refused = "perspective"}),
    word_row<&State::clip_z>("clip_z", "where the near plane of clip space lies, at z = −w or at z = 0"),
    word_row<&State::pixel_center>(
        "pixel_center",
        "where the pixel centres of window-space vertices and of the viewport lie; the first one at ½ or at 0"),
    word_row<&State::origin>("origin",
                             "what window-space vertices, viewport and scissor count from, with y down from the top, y "
                             "up from the bottom; the y of a rectangle is that of its side at the origin"),
    row<&State::scissor>({.name = "scissor",
                          .words = off_words,
                          .numbers = scissor_numbers,
                          .form = "x y width height",
                          .unit = "pixels",
                          .purpose = "what may be drawn and cleared: whole pixels, numbered from the `origin`, the "
                                     "first one 0 under either `pixel_center`"}),
    row<&State::viewport>(
        {.name = "viewport",
         .words = viewport_words,
         .numbers = viewport_numbers,
         .form = "x y width height",
         .unit = "pixels",
         .purpose = "where clip space comes to lie: pixels in the window coordinates of `pixel_center` and `origin`, "
                    "fractions allowed (the whole target is `0 0 W H`, or `-0.5 -0.5 W H` under `integer`)"}),
    number_row<&State::depth_range>("depth_range", depth_range_numbers, "near far",
                                    "window z of the near and the far plane, in either order"),
    word_row<&State::provoking>("provoking", "the vertex whose colour `shade flat` takes"),
    word_row<&State::polygon_mode>("polygon_mode", "what is drawn of a triangle"),
    number_row<&State::polygon_offset>(
        "polygon_offset", polygon_offset_numbers, "factor constant",
        "added to a triangle's depth, factor times its steeper slope per pixel plus the constant, in depth codes"),
    word_row<&State::line_rule>(
        "line_rule", "which pixels a line covers; `rectangle`: the samples of a rectangle about it, by two triangles"),
    word_row<&State::line_last>("line_last", "whether a line's last pixel is drawn; `rule`: as its rule has it",
                                StateHome::host, line_last_words),
    row<&State::line_width>(
        {.name = "line_width",
         .numbers = line_width_numbers,
         .form = "width",
         .unit = "pixels",
         .purpose = "pixels that a line covers across its minor axis, rounded to a whole number, or the width of its "
                    "rectangle; the draw refuses lines that could reach the target from outside the guard band"}),
    word_row<&State::smooth>("smooth",
                             "what a line's rectangle, or a point, covers of a pixel multiplies alpha; blend it to see "
                             "it; with several samples a pixel nobody looks at it"),
    row<&State::point_size>({.name = "point_size",
                             .numbers = point_size_numbers,
                             .form = "size",
                             .unit = "pixels",
                             .purpose = "side of the square, fractions allowed; the draw refuses points that could "
                                        "reach the target from outside the guard band"}),
    word_row<&State::point_shape>("point_shape",
                                  "which of its square's pixels a point covers: all, or those whose centres lie in the "
                                  "disc that the square holds"),
    word_row<&State::point_clip>("point_clip", "what the view's sides clip of a point"),
    number_row<&State::texture>("texture", texture_numbers, "NAME",
                                "the texture of filled triangles, by the name of its line", StateHome::host, off_words),
    word_row<&State::texture_interp>("texture_interp", "how its coordinates run over a triangle"),
    word_row<&State::texture_min>("texture_min", "which texels count where a pixel holds more than one"),
    word_row<&State::texture_mag>("texture_mag", "which texels count where a pixel holds less than one"),
    number_row<&State::texture_wrap>(
        "texture_wrap", texture_wrap_numbers, "S T",
        "what lies beyond the image along u and v; `clamp` is to its edge, `border` a colour, `half_border` holds the "
        "coordinate in the image, so that a linear filter mixes half of that colour at its sides"),
    number_row<&State::texture_border>("texture_border", texture_border_numbers, "r g b a",
                                       "that colour; of a texture without alpha a counts as 255", StateHome::unit),
    number_row<&State::texture_lod>("texture_lod", texture_lod_numbers, "bias min max",
                                    "added to the level of detail, which is then held between min and max"),
    word_row<&State::texture_combine>("texture_combine",
                                      "what becomes of the triangle's colour and the texel; `blend`: from the colour "
                                      "to the constant, by the texel's channels"),
    number_row<&State::texture_constant>("texture_constant", texture_constant_numbers, "r g b",
                                         "the constant of `texture_combine blend`", StateHome::unit),
    number_row<&State::fog>("fog", fog_numbers, "kind start [end]",
                            "how much of the colour is left at a distance w from the eye: `linear start end` (end − w) "
                            "/ (end − start), `exp density` e^(−density·w), `exp2 density` e^(−(density·w)²)",
                            StateHome::unit, off_words),
    number_row<&State::fog_color>("fog_color", fog_color_numbers, "r g b",
                                  "the colour of fog, which takes the place of the rest", StateHome::unit),
    number_row<&State::light_direction>("light_direction", light_direction_numbers, "x y z",
                                        "of `shade phong`: to the light, in the space of the normals, of any length",
                                        StateHome::unit),
    number_row<&State::light_half>("light_half", light_half_numbers, "x y z",
                                   "the direction between that one and the one to the eye, in which highlights lie",
                                   StateHome::unit),
    number_row<&State::light_ambient>("light_ambient", light_ambient_numbers, "r g b",
                                      "what of a colour shows without light, 255 for all of it", StateHome::unit),
    number_row<&State::light_diffuse>("light_diffuse", light_diffuse_numbers, "r g b",
                                      "what shows besides where the light falls straight on it", StateHome::unit),
    number_row<&State::light_specular>("light_specular", light_specular_numbers, "r g b",
                                       "the colour of highlights, which is added", StateHome::unit),
    number_row<&State::light_shininess>("light_shininess", light_shininess_numbers, "power",
                                        "the power of N·H that a highlight is", StateHome::unit),
    number_row<&State::alpha_test>("alpha_test", alpha_test_numbers, "func ref",
                                   "how a fragment's alpha, after its texture, must compare with the reference",
                                   StateHome::unit),
    number_row<&State::blend>("blend", blend_numbers, "src dst [src_a dst_a]",
                              "what the fragment's and the stored colour are multiplied with before they are put "
                              "together; without the last two, alpha as the colour",
                              StateHome::unit, off_words),
    number_row<&State::blend_equation>("blend_equation", blend_equation_numbers, "eq [eq_a]",
                                       "how they are put together; `min` and `max` take no factors", StateHome::unit),
    number_row<&State::blend_color>("blend_color", blend_color_numbers, "r g b a", "the constant of blend factors",
                                    StateHome::unit),
    word_row<&State::logic_op>("logic_op",
                               "what is stored of the fragment's code and the stored one, bit by bit, instead of "
                               "blending; `copy`: no operation, `blend` holds",
                               StateHome::unit, logic_op_words),
    number_row<&State::color_mask>("color_mask", color_mask_numbers, "r g b a", "which channels `color_write` writes",
                                   StateHome::unit),
    number_row<&State::stencil>("stencil", stencil_numbers, "func ref read write sfail zfail zpass",
                                "how the reference must compare with the stored stencil value, both through the mask "
                                "`read`, and what becomes of that through the mask `write`",
                                StateHome::unit, off_words),
    number_row<&State::stencil_back>("stencil_back", stencil_numbers, "func ref read write sfail zfail zpass",
                                     "the same for triangles that show their back, while `stencil` is not off",
                                     StateHome::unit, same_words),
    word_row<&State::dither>(
        "dither", "whether a colour is spread over its neighbours where it is stored in fewer than 8 bits a channel",
        StateHome::unit),
    number_row<&State::sample_mask>("sample_mask", sample_mask_numbers, "HEX",
                                    "which samples of a pixel are drawn, in hexadecimal digits, sample 0 the lowest "
                                    "bit; does nothing where a pixel has one sample",
                                    StateHome::unit, all_words),
    word_row<&State::alpha_to_coverage>(
        "alpha_to_coverage",
        "whether alpha says how many of a pixel's samples are drawn; does nothing where a pixel has one sample",
        StateHome::unit),
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
