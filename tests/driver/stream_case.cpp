#include "stream_case.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "model/generate/raster_pkg.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/host/texture_memory.hpp"
#include "model/stages/fog_unit.hpp"
#include "model/stages/light_unit.hpp"
#include "model/stages/phong.hpp"
#include "sim/scene/vertex_transform.hpp"

namespace halfplane::test {
namespace {

/// Of tests/driver/CMakeLists.txt: no design has alpha in memory, a depth of more than 22 bits or a Q of more than 24, and
/// coordinates of 16 bits; none dithers without blending, or has a guard band of more than 4,096 pixels.
constexpr std::array<std::string_view, 2> kNoDesigns{
    "embedded lines.unit=0 depth.bits=32 hiz.bits=32 color.format=rgba8888 alpha.unit=1 blend.lanes=4 logic.unit=1 "
    "texture.unit=bilinear texture.constant=1 texture.border=1 perspective.colors=1 perspective.bits=26",
    "embedded depth.bits=24 hiz.bits=24 dither.unit=1 subpixel.bits=1 guard.band=8192"};

double real(hp_fixed v) { return std::ldexp(v, -16); }

class CaseMaker {
 public:
  CaseMaker(std::uint32_t seed, int primitives)
      : random_(seed),
        config_(driver_config()),
        primitives_(primitives),
        words_(1U << 20),
        context_(std::make_unique<hp_context>()) {}

  StreamCase make() {
    Scene& scene = out_.scene;
    scene.name = "random stream";
    scene.width = 1 + random_.index(std::min(config_.target_width, 300));
    scene.height = 1 + random_.index(std::min(config_.target_height, 200));
    hp_init(context_.get());
    hp_stream stream{words_.data(), static_cast<std::uint32_t>(words_.size()), nullptr, nullptr};
    hp_begin(context_.get(), &stream);
    const hp_target target = target_of(scene.width, scene.height);
    hp_set_target(context_.get(), &target);
    set_viewport();
    if (config_.texture_unit != TextureUnitKind::off) add_textures();
    if (config_.fog_units != 0) add_fogs();
    if (has_normals(config_)) add_lights();
    scene.states.push_back(base_);
    clear(HP_CLEAR_DEPTH | HP_CLEAR_COLOR);
    while (count_ < primitives_) {
      set_state();
      for (int draws = 1 + random_.index(3); draws > 0; --draws) draw();
      if (random_.index(6) == 0) clear(1U + static_cast<std::uint32_t>(random_.index(3)));
    }
    hp_flush(context_.get(), 0);
    hp_fence(context_.get(), 1);
    words_.resize(hp_written(context_.get()));
    out_.words = std::move(words_);
    out_.counts = *hp_count(context_.get());
    out_.status = hp_status(context_.get());
    return std::move(out_);
  }

 private:
  hp_fixed between(double low, double high) {
    return static_cast<hp_fixed>(std::lround(random_.between(low, high) * 65536));
  }
  bool chance(int of) { return random_.index(of) == 0; }

  void set_viewport() {
    if (chance(2)) return;
    const double room = 0.9 * std::min(config_.guard_band, 30000);
    hp_viewport v{};
    v.x = between(-0.5 * room, 0.3 * room);
    v.y = between(-0.5 * room, 0.3 * room);
    v.width = between(1, 0.6 * room);
    v.height = between(1, 0.6 * room);
    if (chance(2)) v = {0, 0, out_.scene.width * HP_ONE, out_.scene.height * HP_ONE, 0, 0, 0};
    if (chance(4)) v.x = v.y = 0, v.width = v.height = room > 256 ? 256 * HP_ONE : 16 * HP_ONE;
    if (chance(12)) {  // a side at the guard band, where the driver clips and snaps another way
      const hp_fixed end = std::min(config_.guard_band, 32767) * HP_ONE - 1;
      const hp_fixed inside = end + 1 - (HP_ONE >> config_.subpixel_bits);
      hp_fixed &first = chance(2) ? v.x : v.y, &size = &first == &v.x ? v.width : v.height;
      if (chance(2))
        first = -end;
      else
        size = (chance(2) ? end : inside) - first;
    }
    v.near_depth = chance(2) ? 0 : static_cast<std::uint32_t>(random_.between(0, 0x1p31));
    v.far_depth = chance(2) ? HP_DEPTH_ONE : static_cast<std::uint32_t>(random_.between(0, 0x1p31));
    v.zero_to_one = chance(2) ? 1 : 0;
    hp_set_viewport(context_.get(), &v);
    base_.viewport = Viewport{real(v.x), real(v.y), real(v.width), real(v.height)};
    base_.depth_range = {std::ldexp(v.near_depth, -31), std::ldexp(v.far_depth, -31)};
    base_.clip_z = v.zero_to_one != 0 ? ClipZ::zero_one : ClipZ::minus_one_one;
  }

  void add_textures() {
    constexpr std::array kFormats{TextureFormat::l8,       TextureFormat::la88,     TextureFormat::rgb565,
                                  TextureFormat::rgba5551, TextureFormat::rgba4444, TextureFormat::rgba8888};
    textures_.resize(3);
    for (hp_texture& t : textures_) {
      t.log2_width = static_cast<std::uint8_t>(random_.index(7));
      t.log2_height = static_cast<std::uint8_t>(random_.index(7));
      if (chance(4)) t.log2_width = 12, t.log2_height = 0;
      t.format = static_cast<std::uint8_t>(random_.index(6));
      TexelImage image{1 << t.log2_width, 1 << t.log2_height, {}};
      for (int i = 0; i < image.width * image.height; ++i)
        image.texel.push_back({static_cast<std::uint8_t>(random_.index(256)), static_cast<std::uint8_t>(i), 7, 200});
      out_.scene.textures.push_back(
          make_texture("texels" + std::to_string(out_.scene.textures.size()), image, kFormats[t.format],
                       config_.texture_unit == TextureUnitKind::trilinear && chance(2) ? Mips::box : Mips::none));
      t.levels = static_cast<std::uint8_t>(out_.scene.textures.back().level.size());
    }
    const TextureMemory memory(out_.scene, config_);
    for (std::size_t n = 0; n < textures_.size(); ++n) {
      hp_texture& t = textures_[n];
      t.address = memory.base(n);
      std::vector<std::uint8_t> texels;
      const Texture& texture = out_.scene.textures[n];
      for (const TextureLevel& level : texture.level)
        for (const std::uint32_t code : level.code)
          for (int byte = 0; byte < (texel_bits(texture.format) + 7) / 8; ++byte)
            texels.push_back(static_cast<std::uint8_t>(code >> (8 * byte)));
      const std::size_t end = t.address + hp_texture_bytes(&t);
      if (out_.textures.size() < end) out_.textures.resize(end);
      hp_upload_texture(context_.get(), out_.textures.data() + t.address, &t, texels.data());
      texels_.push_back(std::move(texels));
    }
  }

  /// A texture's texels once more, as of a picture that changes: a draw drops those that the unit has.
  void upload_again() {
    const auto n = static_cast<std::size_t>(random_.index(static_cast<int>(textures_.size())));
    const hp_texture& t = textures_[n];
    hp_upload_texture(context_.get(), out_.textures.data() + t.address, &t, texels_[n].data());
  }

  void add_fogs() {
    for (std::size_t n = 0; n < fogs_.size(); ++n) {
      FogOfBoth& both = fogs_[n];
      both.fog.kind = static_cast<FogKind>(n);
      both.fog.start = n == 0 ? random_.between(0, 5) : random_.between(0.01, 3);
      both.fog.end = both.fog.start + random_.between(0.1, 90);
      for (std::uint8_t& channel : both.color) channel = static_cast<std::uint8_t>(random_.index(256));
      const FogTable table(both.fog, both.color);
      for (const FogLine& line : table.lines()) both.lines.push_back({line.start, line.rise});
      both.of_driver = {both.lines.data(), static_cast<std::int16_t>(table.first()),
                        static_cast<std::uint8_t>(table.octave_bits())};
    }
  }

  void add_lights() {
    for (LightOfBoth& both : lights_) {
      State& state = both.state;
      for (std::size_t c = 0; c < 3; ++c) {
        state.light_direction[c] = random_.between(-1, 1);
        state.light_half[c] = random_.between(-1, 1);
        for (auto* color : {&state.light_ambient, &state.light_diffuse, &state.light_specular})
          (*color)[c] = static_cast<std::uint8_t>(random_.index(256));
      }
      state.light_shininess = random_.between(1, 100);
      const PhongLight light(PhongLight::given_by(state));
      for (const FallingLine& line : light.lines())
        both.lines.push_back({static_cast<std::uint16_t>(line.start), static_cast<std::uint16_t>(line.fall)});
      hp_light& of = both.of_driver;
      for (std::size_t c = 0; c < 3; ++c) {
        of.direction[c] = static_cast<std::int16_t>(light.direction()[c]);
        of.half[c] = static_cast<std::int16_t>(light.half()[c]);
      }
      const auto rgb = [](const auto& color) { return HP_RGBA(color[0], color[1], color[2], 77); };
      of.ambient = rgb(state.light_ambient);
      of.diffuse = rgb(state.light_diffuse);
      of.specular = rgb(state.light_specular);
      of.lines = both.lines.data();
      of.narrow = static_cast<std::uint8_t>(light.narrow());
    }
  }

  /// The driver's scissor, and that of the scene's next states.
  void set_scissor() {
    const Scene& scene = out_.scene;
    Rect rect{random_.index(scene.width), random_.index(scene.height), random_.index(scene.width + 1),
              random_.index(scene.height + 1)};
    if (chance(8)) rect = {-5, -3, scene.width + 9, scene.height + 9};
    if (chance(3)) rect = {0, 0, scene.width, scene.height};
    hp_set_scissor(context_.get(), rect.x, rect.y, rect.width, rect.height);
    base_.scissor = rect;
  }

  template <class Enum>
  std::uint8_t choose(Enum& of_model, int count) {
    const int chosen = random_.index(count);
    of_model = static_cast<Enum>(chosen);
    return static_cast<std::uint8_t>(chosen);
  }

  void set_state() {
    State state = base_;
    hp_state s = hp_default_state();
    s.depth_test = choose(state.depth_test, 8);
    s.depth_write = chance(3) ? 0 : 1;
    state.depth_write = s.depth_write != 0;
    if (chance(5)) s.color_mask = 0, state.color_mask = {}, state.color_write = false;
    s.cull = choose(state.cull, 4);
    if (s.cull == 3 && !chance(10)) s.cull = 0, state.cull = Cull::none;
    s.front = choose(state.front, 2);
    if (config_.blend_lanes != 0) add_blend(s, state);
    if ((config_.dither_units != 0 || config_.color_format == ColorFormat::rgba8888) && chance(2))
      s.dithers = 1, state.dither = true;
    if (config_.alpha_units != 0 && config_.cache_kind == CacheKind::blocks && chance(2)) {
      s.alpha_func = choose(state.alpha_test.func, 8);
      s.alpha_reference = state.alpha_test.reference = static_cast<std::uint8_t>(random_.index(256));
    }
    if (config_.msaa_samples > 1 && chance(2)) {
      s.sample_mask = static_cast<std::uint8_t>(random_.index(256));
      state.sample_mask = s.sample_mask;
      if (tests_alpha(config_) && chance(2)) s.alpha_to_coverage = 1, state.alpha_to_coverage = true;
    }
    if (config_.stencil_bits != 0 && chance(2)) add_stencil(s, state);
    s.line_rule = choose(state.line_rule, 3);
    s.line_last = chance(2) ? 1 : 0;
    state.line_last = s.line_last != 0;
    if (chance(3)) state.line_width = s.line_width = static_cast<std::uint16_t>(1 + random_.index(6));
    if (chance(2)) s.point_size = between(1, 9);
    state.point_size = real(s.point_size);
    outline_ = s;
    outline_state_ = state;
    if (!textures_.empty() && !chance(3)) add_texture(s, state);
    if (config_.fog_units != 0 && s.is_affine == 0 && chance(2)) {
      const FogOfBoth& both = fogs_[static_cast<std::size_t>(random_.index(3))];
      s.fog = &both.of_driver;
      s.fog_color = HP_RGBA(both.color[0], both.color[1], both.color[2], 0);
      state.fog = both.fog;
      state.fog_color = both.color;
    }
    if (has_normals(config_) && s.is_affine == 0 && chance(2)) {
      const LightOfBoth& both = lights_[static_cast<std::size_t>(random_.index(2))];
      s.light = &both.of_driver;
      state.shade = Shade::phong;
      state.light_direction = both.state.light_direction;
      state.light_half = both.state.light_half;
      state.light_ambient = both.state.light_ambient;
      state.light_diffuse = both.state.light_diffuse;
      state.light_specular = both.state.light_specular;
      state.light_shininess = both.state.light_shininess;
    }
    filled_ = s;
    filled_state_ = state;
  }

  void add_blend(hp_state& s, State& state) {
    if (chance(2)) {
      s.color_mask = static_cast<std::uint8_t>(random_.index(16));
      state.color_write = true;
      for (std::size_t c = 0; c < 4; ++c) state.color_mask[c] = (s.color_mask >> c & 1) != 0;
      if ((s.color_mask & (config_.color_format == ColorFormat::rgba8888 ? 15 : 7)) == 0) state.color_write = false;
    }
    if (config_.logic_units != 0 && chance(3)) s.logic_op = choose(state.logic_op, 16);
    if (chance(2)) return;
    s.blends = 1;
    state.blend.emplace();
    s.src = choose(state.blend->src, 15);
    s.dst = choose(state.blend->dst, 14);
    s.src_alpha = choose(state.blend->src_alpha, 15);
    s.dst_alpha = choose(state.blend->dst_alpha, 14);
    s.equation = choose(state.blend_equation[0], 5);
    s.equation_alpha = choose(state.blend_equation[1], 5);
    if (chance(4)) s.src = 1, s.dst = 0, state.blend->src = BlendFactor::one, state.blend->dst = BlendFactor::zero;
    for (std::size_t c = 0; c < 4; ++c) {
      state.blend_color[c] = static_cast<std::uint8_t>(random_.index(256));
      s.blend_color |= std::uint32_t{state.blend_color[c]} << (8 * c);
    }
  }

  void add_stencil(hp_state& s, State& state) {
    s.has_stencil = 1;
    std::array<Stencil, 2> sides;
    for (std::size_t n = 0; n < 2; ++n) {
      hp_stencil& to = s.stencil[n];
      Stencil& from = sides[n];
      if (n == 1 && chance(2)) {
        to = s.stencil[0];
        from = sides[0];
        continue;
      }
      to.func = chance(3) ? static_cast<std::uint8_t>(HP_ALWAYS) : choose(from.func, 8);
      from.func = static_cast<DepthFunc>(to.func);
      to.stencil_fails = chance(2) ? 0 : choose(from.stencil_fails, 8);
      to.depth_fails = chance(2) ? 0 : choose(from.depth_fails, 8);
      to.passes = chance(2) ? 0 : choose(from.passes, 8);
      to.reference = from.reference = static_cast<std::uint8_t>(random_.index(256));
      to.read_mask = from.read_mask = static_cast<std::uint8_t>(random_.index(256));
      to.write_mask = from.write_mask = static_cast<std::uint8_t>(chance(3) ? 0 : random_.index(256));
    }
    state.stencil = sides[0];
    state.stencil_back = sides[1];
  }

  void add_texture(hp_state& s, State& state) {
    const int n = random_.index(4);
    if (n < 3) {
      s.texture = &textures_[static_cast<std::size_t>(n)];
      state.texture = static_cast<std::uint32_t>(n);
      s.wrap_u = choose(state.texture_wrap[0], config_.texture_borders != 0 ? 5 : 3);
      s.wrap_v = choose(state.texture_wrap[1], config_.texture_borders != 0 ? 5 : 3);
      s.combine = choose(state.texture_combine, config_.texture_constants != 0 ? 5 : 4);
      for (std::size_t c = 0; c < 4; ++c) {
        state.texture_border[c] = static_cast<std::uint8_t>(random_.index(256));
        s.texture_border |= std::uint32_t{state.texture_border[c]} << (8 * c);
        if (c < 3) state.texture_constant[c] = static_cast<std::uint8_t>(random_.index(256));
        s.texture_constant |= std::uint32_t{c < 3 ? state.texture_constant[c] : std::uint8_t{9}} << (8 * c);
      }
      s.is_linear = config_.texture_unit != TextureUnitKind::nearest && chance(2) ? 1 : 0;
      state.texture_min = s.is_linear != 0 ? TextureMin::linear : TextureMin::nearest;
      if (config_.texture_unit == TextureUnitKind::trilinear) add_levels(s, state);
      state.texture_mag = s.is_linear != 0 ? TextureMag::linear : TextureMag::nearest;
      s.is_affine = chance(5) ? 1 : 0;
      if (s.is_affine != 0) state.texture_interp = TextureInterp::affine;
    }
    if (config_.perspective_colors != 0 && s.is_affine == 0 && (n == 3 || chance(2))) {
      s.perspective_colors = 1;
      state.color_interp = ColorInterp::perspective;
    }
  }

  void add_levels(hp_state& s, State& state) {
    s.minifies_otherwise = chance(3) ? 1 : 0;
    s.levels = static_cast<std::uint8_t>(random_.index(3));
    state.texture_min = static_cast<TextureMin>(2 * s.levels + (s.is_linear ^ s.minifies_otherwise));
    if (chance(2)) return;
    s.level_bias = static_cast<std::int16_t>(random_.index(1600) - 800);
    s.least_level = static_cast<std::uint16_t>(random_.index(chance(2) ? 3073 : 300));
    s.largest_level = chance(4) ? s.least_level : static_cast<std::uint16_t>(random_.index(3073));
    state.texture_lod = {s.level_bias / 256.0, s.least_level / 256.0, s.largest_level / 256.0};
  }

  void clear(std::uint32_t buffers) {
    const bool is_first = out_.scene.commands.empty();
    if (!is_first) set_scissor();
    const std::uint32_t color = static_cast<std::uint32_t>(random_.between(0, 0x1p32));
    const std::uint32_t depth = static_cast<std::uint32_t>(random_.between(0, 0x1p31));
    const auto stencil = static_cast<std::uint8_t>(random_.index(256));
    hp_clear(context_.get(), buffers, color, depth, stencil);
    Clear command;
    command.state = static_cast<std::uint32_t>(out_.scene.states.size());
    out_.scene.states.push_back(base_);
    if ((buffers & HP_CLEAR_DEPTH) != 0) command.depth = std::ldexp(depth, -31);
    if ((buffers & HP_CLEAR_DEPTH) != 0 && config_.stencil_bits != 0) command.stencil = stencil;
    if ((buffers & HP_CLEAR_COLOR) != 0) {
      command.color.emplace();
      for (std::size_t c = 0; c < 4; ++c) (*command.color)[c] = color >> (8 * c) & 255;
    }
    out_.scene.commands.emplace_back(command);
  }

  /// x y z w of a vertex: in the view, about a plane of it, far out, and where w is next to nothing.
  std::array<hp_fixed, 4> position() {
    const hp_fixed w = chance(12)   ? between(-4, 4)
                       : chance(40) ? between(16384, 32767)
                       : chance(8)  ? static_cast<hp_fixed>(random_.index(40)) - 3
                                    : between(0.01, std::exp2(random_.between(-4, 8)));
    const auto beside = [&](double reach) {
      return static_cast<hp_fixed>(std::clamp(random_.between(-reach, reach) * w, -0x1.0p31, 0x1.fffffep30));
    };
    const double reach = chance(6) ? std::exp2(random_.between(0, 12)) : 1.3;
    const hp_fixed x = beside(reach), y = beside(reach), z = beside(chance(6) ? 20 : 1);
    return {x, y, chance(9) ? w : chance(9) ? -w : z, w};
  }

  /// Vertex k of a triangle whose numbers are as far apart as any: w by 2^22 and more, two places by a subpixel or two.
  std::array<hp_fixed, 4> far_apart(int k) {
    const hp_fixed w = k == 0 ? 1 + random_.index(64) : between(4096, 32767);
    const double reach = std::array{0.0, 0.001, 0.9}[static_cast<std::size_t>(k)];
    const auto beside = [&] { return static_cast<hp_fixed>(random_.between(-reach, reach) * w); };
    return {beside(), beside(), 0, w};
  }

  Mat4 matrix(std::array<hp_fixed, 16>& out, double size) {
    Mat4 result{};
    for (std::size_t i = 0; i < 16; ++i) {
      out[i] = between(-size, size) + (i % 5 == 0 ? HP_ONE : 0);
      result[i / 4][i % 4] = real(out[i]);
    }
    return result;
  }

  /// New vertices, for the scene and the driver.
  void make_vertices(int count) {
    position_.clear();
    color_.clear();
    texcoord_.clear();
    normal_.clear();
    first_ = static_cast<std::uint32_t>(out_.scene.vertices.size());
    const bool is_white = chance(6), is_black = chance(9), is_untextured = chance(6), is_unlit = chance(9);
    const bool is_grid = chance(6);  // ties, and powers of two where the viewport's size is one
    const bool is_far_apart = !is_grid && chance(12);
    const bool transforms = !is_grid && !is_far_apart && chance(3);
    std::array<hp_fixed, 16> view{}, projection{};
    Mat4 v = matrix(view, 0.3), p = matrix(projection, 0.3);
    if (chance(2)) {
      for (std::size_t i = 12; i < 16; ++i) view[i] = i == 15 ? HP_ONE : 0;
      v[3] = {0, 0, 0, 1};
      if (const auto near_it = static_cast<std::size_t>(random_.index(30)); near_it < 4) {
        view[12 + near_it] += 3;
        v[3][near_it] = real(view[12 + near_it]);
      }
    }
    if (chance(2)) { /* perspective */
      constexpr std::array<std::size_t, 5> kPlaces{0, 5, 10, 11, 14};
      std::array<hp_fixed, 16> only{};
      for (const std::size_t i : kPlaces) only[i] = i == 14 ? -HP_ONE : projection[i];
      if (chance(9)) only[(kPlaces[static_cast<std::size_t>(random_.index(5))] + 4) % 16] += 3;
      projection = only;
      for (std::size_t i = 0; i < 16; ++i) p[i / 4][i % 4] = real(only[i]);
    }
    const VertexTransform transform(v, p, TransformNumbers::s15_16);
    for (int i = 0; i < count; ++i) {
      std::array<hp_fixed, 4> at = position();
      const auto quarter = [&] { return (random_.index(9) - 4) * HP_ONE / 4; };
      if (is_grid) at = {quarter(), quarter(), quarter(), HP_ONE};
      if (is_far_apart) at = far_apart(i % 3);
      Vertex vertex;
      if (transforms) {
        for (hp_fixed& part : at) part = between(-2, 2);
        const Vec4 clip = transform.clip({real(at[0]), real(at[1]), real(at[2])});
        vertex.x = clip[0], vertex.y = clip[1], vertex.z = clip[2], vertex.w = clip[3];
        position_.insert(position_.end(), at.begin(), at.begin() + 3);
      } else {
        vertex.x = real(at[0]), vertex.y = real(at[1]), vertex.z = real(at[2]), vertex.w = real(at[3]);
        position_.insert(position_.end(), at.begin(), at.end());
      }
      if (!is_white) {
        color_.push_back(is_black ? 0xff000000 : static_cast<std::uint32_t>(random_.between(0, 0x1p32)));
        for (std::size_t c = 0; c < 4; ++c) vertex.rgba[c] = color_.back() >> (8 * c) & 255;
      }
      if (!is_untextured) {
        const double reach = chance(10) ? 30000 : chance(3) ? 40 : 1;
        for (double* of_model : {&vertex.u, &vertex.v}) {
          constexpr std::array kEnds{INT32_MAX, -INT32_MAX, 1 - INT32_MAX, 0, 0, 1};
          const int end = is_far_apart && !chance(4) ? (i % 3) + 3 * chance(3) : random_.index(6);
          texcoord_.push_back(is_far_apart || (is_grid && chance(2)) ? kEnds[static_cast<std::size_t>(end)]
                              : is_grid                              ? quarter()
                                                                     : between(-reach, reach));
          *of_model = real(texcoord_.back());
        }
      }
      out_.scene.vertices.push_back(vertex);
      if (has_normals(config_)) out_.scene.normals.push_back(is_unlit ? Vec3{} : normal());
    }
    hp_set_matrices(context_.get(), transforms ? view.data() : nullptr, transforms ? projection.data() : nullptr);
    const auto parts = static_cast<std::uint16_t>(transforms ? 12 : 16);
    vertices_ = {position_.data(),
                 is_white ? nullptr : color_.data(),
                 is_untextured ? nullptr : texcoord_.data(),
                 parts,
                 4,
                 8,
                 static_cast<std::uint8_t>(transforms ? 0 : 1),
                 is_unlit ? nullptr : normal_.data(),
                 12};
  }

  /// The next normal: any length, along an axis, short, 0; and with a z whose code is next to a tie.
  Vec3 normal() {
    const double size = std::exp2(random_.between(-15, 14));
    const bool is_short = chance(4), is_axis = chance(8);
    Vec3 made{};
    for (double& part : made) {
      hp_fixed n = is_short ? static_cast<hp_fixed>(random_.index(9)) - 4 : between(-size, size);
      if (is_axis && chance(2)) n = chance(4) ? INT32_MIN : 0;
      if (&part == &made[2] && chance(3)) {
        const double code = (random_.index(30000) + 0.5) / 32768;
        n = static_cast<hp_fixed>(
            std::lround(65536 * std::hypot(made[0], made[1]) * code / std::sqrt(1 - code * code)));
      }
      normal_.push_back(n);
      part = real(n);
    }
    return made;
  }

  void draw() {
    if (chance(3)) set_scissor();
    if (!textures_.empty() && chance(6)) upload_again();
    const int count = 3 + random_.index(40);
    make_vertices(count);
    const int last = config_.line_units != 0 ? 7 : 4;
    int topology = random_.index(last);
    if (topology == 3 && config_.line_units == 0) topology = 6;
    const bool is_filled = topology <= 2;
    hp_set_state(context_.get(), is_filled ? &filled_ : &outline_);
    State state = is_filled ? filled_state_ : outline_state_;
    state.scissor = base_.scissor;

    std::vector<std::uint16_t> indices;
    const int length = count + random_.index(20);
    if (!chance(4))
      for (int i = 0; i < length; ++i)
        indices.push_back(static_cast<std::uint16_t>(chance(25)  ? HP_RESTART
                                                     : chance(3) ? random_.index(count)
                                                                 : i % count));
    const auto size = static_cast<std::uint32_t>(indices.empty() ? count : length);
    hp_draw(context_.get(), static_cast<hp_topology>(topology), &vertices_, indices.empty() ? nullptr : indices.data(),
            size);

    Scene& scene = out_.scene;
    Draw command;
    command.state = static_cast<std::uint32_t>(scene.states.size());
    command.topology = static_cast<Topology>(topology);
    command.first = scene.indices.size();
    command.count = size;
    scene.states.push_back(state);
    for (std::uint32_t i = 0; i < size; ++i)
      scene.indices.push_back(indices.empty() ? first_ + i : indices[i] == HP_RESTART ? kRestart : first_ + indices[i]);
    scene.commands.emplace_back(command);
    count_ += static_cast<int>(size);
  }

  Random random_;
  const Config& config_;
  int primitives_, count_ = 0;
  std::vector<std::uint32_t> words_;
  std::unique_ptr<hp_context> context_;
  StreamCase out_;
  State base_;  ///< viewport and scissor
  hp_state filled_{}, outline_{};
  State filled_state_, outline_state_;
  std::vector<hp_texture> textures_;
  std::vector<std::vector<std::uint8_t>> texels_;  ///< of each
  struct FogOfBoth {
    Fog fog;
    std::array<std::uint8_t, 3> color{};
    std::vector<hp_fog_line> lines;
    hp_fog of_driver{};
  };
  std::array<FogOfBoth, 3> fogs_;  ///< of each kind
  struct LightOfBoth {
    State state;  ///< its light alone
    std::vector<hp_light_line> lines;
    hp_light of_driver{};
  };
  std::array<LightOfBoth, 2> lights_;
  std::vector<hp_fixed> position_, texcoord_, normal_;
  std::vector<std::uint32_t> color_;
  std::uint32_t first_ = 0;
  hp_vertices vertices_{};
};

}  // namespace

const Config& driver_config() {
  static const Config config = [] {
    for (const Design& design : designs())
      if (config_id(design.config) == hp_config_id()) return design.config;
    for (const std::string_view label : kNoDesigns)
      if (const Config other = labelled(label); config_id(other) == hp_config_id()) return other;
    throw InputError("the driver is compiled for a configuration that the tests do not know");
  }();
  return config;
}

hp_target target_of(int width, int height) {
  const Config& config = driver_config();
  const int tiles = (width + config.tile_size - 1) / config.tile_size;
  const auto stride = static_cast<std::uint32_t>(tiles) << derive_widths(config).memory.tile();
  return {static_cast<std::uint16_t>(width), static_cast<std::uint16_t>(height), 0, 0, 0, 0, stride, 0};
}

StreamCase random_case(std::uint32_t seed, int primitives) { return CaseMaker(seed, primitives).make(); }

}  // namespace halfplane::test
