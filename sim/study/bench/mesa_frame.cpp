#include "sim/study/bench/mesa_frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "model/config.hpp"
#include "model/host/primitives.hpp"
#include "sim/study/bench/mesa_operations.hpp"

namespace halfplane {
namespace {

constexpr const char* kInputs = "layout(location = 0) in vec4 position; layout(location = 1) in vec4 rgba;\n";

struct PeerVertex {
  std::array<float, 4> position;
  std::array<std::uint8_t, 4> rgba;
};
using PeerCoordinates = std::array<float, 2>;  // in a separate buffer: unused without a texture

struct Shaders {
  std::string vertex, fragment;
};

Shaders shaders_of(const State& state, bool has_texture, bool has_alpha) {
  const std::string head = "#version 330 core\n",
                    test = gl::fog_source(state) + gl::alpha_test_source(state.alpha_test);
  const std::string color = state.shade == Shade::flat                  ? "flat"
                            : state.color_interp == ColorInterp::affine ? "noperspective"
                                                                        : "smooth";
  if (!has_texture)
    return {head + color + " out vec4 color;\n" + kInputs + "void main() { gl_Position = position; color = rgba; }\n",
            head + color + " in vec4 color;\nout vec4 result; void main() { result = color; " + test + " }\n"};
  const std::string place = state.texture_interp == TextureInterp::affine ? "noperspective" : "smooth";
  return {head + color + " out vec4 color; " + place + " out vec2 place;\n" + kInputs +
              "layout(location = 2) in vec2 uv;\nvoid main() { gl_Position = position; color = rgba; place = uv; }\n",
          head + color + " in vec4 color; " + place + " in vec2 place;\nuniform sampler2D image; out vec4 result;\n" +
              "void main() { vec4 texel = texture(image, place); result = " + gl::combine_source(state, has_alpha) +
              "; " + test + " }\n"};
}

[[noreturn]] void refuse(const std::string& what) {
  throw InputError("llvmpipe: has no " + what + "; leave llvmpipe out for this scene");
}

// Consecutive draws of one list become one list.
bool continues(const Draw& last, const Draw& next) {
  const std::size_t step = last.topology == Topology::triangles ? 3 : last.topology == Topology::lines ? 2 : 0;
  return step != 0 && last.topology == next.topology && last.state == next.state &&
         last.first + last.count == next.first && last.count % step == 0;
}

PeerVertex peer_vertex(const Vertex& v, const Scene& scene, Space space) {
  PeerVertex out{};
  if (space == Space::clip)
    out.position = {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(v.w)};
  else
    out.position = {static_cast<float>((2 * v.x / scene.width - 1) * v.w),
                    static_cast<float>((1 - 2 * v.y / scene.height) * v.w), static_cast<float>((2 * v.z - 1) * v.w),
                    static_cast<float>(v.w)};
  for (std::size_t c = 0; c < 4; ++c) out.rgba[c] = static_cast<std::uint8_t>(std::lround(v.rgba[c]));
  return out;
}

gl::Name shader(const gl::Functions& gl, gl::Enum kind, const std::string& source) {
  const gl::Name name = gl.create_shader(kind);
  const char* text = source.c_str();
  gl.shader_source(name, 1, &text, nullptr);
  gl.compile_shader(name);
  int is_compiled = 0;
  gl.get_shaderiv(name, gl::kCompiled, &is_compiled);
  if (is_compiled == 0) throw std::runtime_error("llvmpipe: does not compile GLSL 3.30; install Mesa 22.3 or newer");
  return name;
}

gl::Enum mode_of(Topology topology) {
  switch (topology) {
    case Topology::triangles: return gl::kTriangles;
    case Topology::triangle_strip: return gl::kTriangleStrip;
    case Topology::triangle_fan: return gl::kTriangleFan;
    case Topology::lines: return gl::kLines;
    case Topology::line_strip: return gl::kLineStrip;
    case Topology::line_loop: return gl::kLineLoop;
    case Topology::points: break;
  }
  return gl::kPoints;
}

}  // namespace

MesaFrame::MesaFrame(int width, int height, int depth_bits, int samples)
    : gl_(gl::start_osmesa()), width_(width), height_(height), depth_bits_(depth_bits), samples_(samples) {
  resolved_ = make_target(1);
  drawn_ = samples > 1 ? make_target(samples) : resolved_;
  gl_.disable(gl::kDither);
  gl_.enable(gl::kDepthTest);
  gl_.primitive_restart_index(kRestart);
}

/// A new framebuffer, bound from here on.
gl::Name MesaFrame::make_target(int samples) const {
  gl::Name framebuffer = 0;
  std::array<gl::Name, 2> buffers{};
  gl_.gen_framebuffers(1, &framebuffer);
  gl_.bind_framebuffer(gl::kFramebuffer, framebuffer);
  gl_.gen_renderbuffers(2, buffers.data());
  const bool has_stencil = depth_bits_ > 16;
  const std::array<gl::Enum, 2> formats{gl::kRgba8, has_stencil ? gl::kDepth24Stencil8 : gl::kDepth16};
  const std::array<gl::Enum, 2> attachments{gl::kColorAttachment,
                                            has_stencil ? gl::kDepthStencilAttachment : gl::kDepthAttachment};
  for (std::size_t i = 0; i < 2; ++i) {
    gl_.bind_renderbuffer(gl::kRenderbuffer, buffers[i]);
    if (samples > 1)
      gl_.renderbuffer_storage_multisample(gl::kRenderbuffer, samples, formats[i], width_, height_);
    else
      gl_.renderbuffer_storage(gl::kRenderbuffer, formats[i], width_, height_);
    gl_.framebuffer_renderbuffer(gl::kFramebuffer, attachments[i], gl::kRenderbuffer, buffers[i]);
  }
  if (gl_.check_framebuffer_status(gl::kFramebuffer) != gl::kComplete)
    throw std::runtime_error("llvmpipe: has no target of this size; give a smaller --size");
  return framebuffer;
}

gl::Name MesaFrame::program_of(const State& state) {
  const Shaders source = shaders_of(state, state.texture.has_value(), state.texture && have_alpha_[*state.texture]);
  gl::Name& program = programs_[source.vertex + source.fragment];
  if (program != 0) return program;
  program = gl_.create_program();
  gl_.attach_shader(program, shader(gl_, gl::kVertexShader, source.vertex));
  gl_.attach_shader(program, shader(gl_, gl::kFragmentShader, source.fragment));
  gl_.link_program(program);
  int is_linked = 0;
  gl_.get_programiv(program, gl::kLinked, &is_linked);
  if (is_linked == 0) throw std::runtime_error("llvmpipe: does not link GLSL 3.30; install Mesa 22.3 or newer");
  return program;
}

void MesaFrame::make_vertices(const Scene& scene, Space space) {
  std::vector<PeerVertex> vertices;
  vertices.reserve(scene.vertices.size());
  for (const Vertex& v : scene.vertices) vertices.push_back(peer_vertex(v, scene, space));
  gl::Name buffer = 0;
  gl_.bind_vertex_array(arrays_[static_cast<std::size_t>(space)]);
  gl_.gen_buffers(1, &buffer);
  gl_.bind_buffer(gl::kArrayBuffer, buffer);
  gl_.buffer_data(gl::kArrayBuffer, static_cast<std::ptrdiff_t>(vertices.size() * sizeof(PeerVertex)), vertices.data(),
                  gl::kStaticDraw);
  constexpr int kStride = sizeof(PeerVertex);
  gl_.vertex_attrib_pointer(0, 4, gl::kFloat, 0, kStride, 0);
  gl_.vertex_attrib_pointer(1, 4, gl::kUnsignedByte, 1, kStride, offsetof(PeerVertex, rgba));
  gl_.enable_vertex_attrib_array(0);
  gl_.enable_vertex_attrib_array(1);
  if (scene.textures.empty()) return;
  std::vector<PeerCoordinates> coordinates;
  for (const Vertex& v : scene.vertices) coordinates.push_back({static_cast<float>(v.u), static_cast<float>(v.v)});
  gl_.gen_buffers(1, &buffer);
  gl_.bind_buffer(gl::kArrayBuffer, buffer);
  gl_.buffer_data(gl::kArrayBuffer, static_cast<std::ptrdiff_t>(coordinates.size() * sizeof(PeerCoordinates)),
                  coordinates.data(), gl::kStaticDraw);
  gl_.vertex_attrib_pointer(2, 2, gl::kFloat, 0, sizeof(PeerCoordinates), 0);
  gl_.enable_vertex_attrib_array(2);
}

void MesaFrame::check_draw_state(const State& state, Topology topology) const {
  if (state.origin != Origin::top_left && state.space == Space::window) refuse("window coordinates from bottom_left");
  if (samples_ > 1 && state.sample_mask != State{}.sample_mask) refuse("sample_mask");
  if (samples_ > 1 && state.alpha_to_coverage) refuse("alpha_to_coverage");
  if (state.pixel_center != PixelCenter::half) refuse("pixel_center integer");
  const bool is_triangle = primitive_type(topology) == PrimitiveType::triangle;
  if (state.shade == Shade::phong && drawn_as(state, topology) == PrimitiveType::triangle) refuse("shade phong");
  if (state.fog && drawn_as(state, topology) == PrimitiveType::line) refuse("fog at the ends of lines");
  const bool is_line = is_triangle ? state.polygon_mode == PolygonMode::line : topology != Topology::points;
  if (drawn_as(state, topology) == PrimitiveType::point) {
    const bool is_round = state.point_shape == PointShape::round, is_smooth = state.smooth && samples_ == 1;
    if (is_round && !is_smooth) refuse("point_shape round without smooth");
    if (is_smooth && !is_round) refuse("smooth points that are square");
  }
  if (!is_line || is_smooth_line(state, topology)) return;
  if (state.line_rule == LineRule::midpoint) refuse("line_rule midpoint");
  if (state.line_rule == LineRule::bresenham) refuse("line_rule bresenham");
  if (state.line_rule == LineRule::rectangle && samples_ == 1) refuse("line_rule rectangle with one sample a pixel");
  if (state.line_rule != LineRule::rectangle && samples_ > 1) refuse("thin lines with several samples a pixel");
  if (state.line_last.value_or(false)) refuse("line_last on");
}

/// Whether GL_LINE_SMOOTH draws it: a coverage that resembles the area which `smooth` means.
bool MesaFrame::is_smooth_line(const State& state, Topology topology) const {
  return state.smooth && samples_ == 1 && drawn_as(state, topology) == PrimitiveType::line;
}

void MesaFrame::add_draw(const Scene& scene, const Draw& draw) {
  if (draw.outside != 0 || draw.count == 0) return;
  const State& state = scene.states[draw.state];
  check_draw_state(state, draw.topology);
  if (state.stencil && depth_bits_ <= 16) refuse("stencil beside a depth of 16 bits");
  const auto first = scene.indices.begin() + static_cast<std::ptrdiff_t>(draw.first);
  const auto last = first + static_cast<std::ptrdiff_t>(draw.count);
  const bool has_restart = std::find(first, last, kRestart) != last;
  if (!calls_.empty() && !calls_.back().is_clear && !calls_.back().has_restart && !has_restart &&
      continues(calls_.back().draw, draw)) {
    calls_.back().draw.count += draw.count;
    return;
  }
  State drawn = state;
  if (drawn_as(state, draw.topology) != PrimitiveType::triangle) drawn.texture.reset();
  const gl::Name texture = drawn.texture ? textures_[*drawn.texture] : 0;
  calls_.push_back({drawn, {}, draw, false, has_restart, program_of(drawn), texture});
}

void MesaFrame::upload(const Scene& scene) {
  calls_.clear();
  textures_ = gl::make_textures(gl_, scene);
  have_alpha_.clear();
  for (const Texture& texture : scene.textures) have_alpha_.push_back(has_alpha(texture.format));
  for (const Command& command : scene.commands) {
    if (const auto* next = std::get_if<Clear>(&command)) {
      const State& state = scene.states[next->state];
      calls_.push_back({state, *next, {}, true, false, 0, 0});
    }
    if (const auto* next = std::get_if<Draw>(&command)) add_draw(scene, *next);
  }
  gl::Name indices = 0;
  gl_.gen_vertex_arrays(2, arrays_);
  gl_.gen_buffers(1, &indices);
  for (const Space space : {Space::clip, Space::window}) {
    const auto is_used = [space](const Call& call) { return !call.is_clear && call.state.space == space; };
    if (std::ranges::none_of(calls_, is_used)) continue;
    make_vertices(scene, space);
    gl_.bind_buffer(gl::kElementBuffer, indices);
  }
  gl_.buffer_data(gl::kElementBuffer, static_cast<std::ptrdiff_t>(scene.indices.size() * sizeof(std::uint32_t)),
                  scene.indices.data(), gl::kStaticDraw);
}

void MesaFrame::apply_target(const State& state) const {
  if (!state.scissor) return gl_.disable(gl::kScissorTest);
  gl_.enable(gl::kScissorTest);
  const Rect& r = *state.scissor;
  gl_.scissor(r.x, state.origin == Origin::bottom_left ? r.y : height_ - r.y - r.height, r.width, r.height);
}

void MesaFrame::apply(const Call& call) const {
  const State& state = call.state;
  apply_target(state);
  const bool is_window = state.space == Space::window;
  const double width = width_, height = height_;
  Viewport view{0, 0, width, height};
  if (state.viewport && !is_window) view = *state.viewport;
  const double bottom = state.origin == Origin::bottom_left ? view.y : height - view.y - view.height;
  gl_.viewport_indexedf(0, static_cast<float>(view.x), static_cast<float>(bottom), static_cast<float>(view.width),
                        static_cast<float>(view.height));
  gl_.depth_range(is_window ? 0 : state.depth_range[0], is_window ? 1 : state.depth_range[1]);
  gl_.clip_control(gl::kLowerLeft, !is_window && state.clip_z == ClipZ::zero_one ? gl::kZeroToOne : gl::kMinusOneToOne);
  gl_.depth_func(gl::comparison(state.depth_test));
  gl_.depth_mask(state.depth_write ? 1 : 0);
  gl::apply_operations(gl_, state);
  state.cull == Cull::none ? gl_.disable(gl::kCullFace) : gl_.enable(gl::kCullFace);
  if (state.cull != Cull::none)
    gl_.cull_face(state.cull == Cull::back ? gl::kBack : state.cull == Cull::front ? gl::kFront : gl::kFrontAndBack);
  gl_.front_face(state.front == FrontFace::ccw ? gl::kCcw : gl::kCw);
  gl_.polygon_mode(gl::kFrontAndBack, state.polygon_mode == PolygonMode::fill   ? gl::kFill
                                      : state.polygon_mode == PolygonMode::line ? gl::kLine
                                                                                : gl::kPoint);
  const bool has_offset =
      primitive_type(call.draw.topology) == PrimitiveType::triangle && state.polygon_offset != std::array<double, 2>{};
  for (const gl::Enum mode : {gl::kOffsetFill, gl::kOffsetLine, gl::kOffsetPoint})
    has_offset ? gl_.enable(mode) : gl_.disable(mode);
  gl_.polygon_offset(static_cast<float>(state.polygon_offset[0]), static_cast<float>(state.polygon_offset[1]));
  gl_.line_width(static_cast<float>(state.line_width));
  gl_.point_size(static_cast<float>(state.point_size));
  is_smooth_line(state, call.draw.topology) ? gl_.enable(gl::kLineSmooth) : gl_.disable(gl::kLineSmooth);
  // Sprites are squares of the exact size, as the core profile's points are.
  const bool is_round = state.smooth && samples_ == 1 && state.point_shape == PointShape::round;
  is_round ? gl_.enable(gl::kPointSmooth) : gl_.disable(gl::kPointSmooth);
  is_round ? gl_.disable(gl::kPointSprite) : gl_.enable(gl::kPointSprite);
  gl_.provoking_vertex(state.provoking == Provoking::first ? gl::kFirstVertex : gl::kLastVertex);
  gl_.use_program(call.program);
  if (call.texture != 0) gl::apply_texture(gl_, call.texture, state);
  gl_.bind_vertex_array(arrays_[static_cast<std::size_t>(state.space)]);
}

void MesaFrame::clear(const Call& call) const {
  apply_target(call.state);
  gl_.color_mask(1, 1, 1, 1);
  gl_.depth_mask(1);
  for (const gl::Enum side : {gl::kFront, gl::kBack}) gl_.stencil_mask_separate(side, 255);
  if (call.clear.color) {
    const auto& c = *call.clear.color;
    gl_.clear_color(static_cast<float>(c[0] / 255), static_cast<float>(c[1] / 255), static_cast<float>(c[2] / 255),
                    static_cast<float>(c[3] / 255));
  }
  if (call.clear.depth) gl_.clear_depth(*call.clear.depth);
  if (call.clear.stencil) gl_.clear_stencil(*call.clear.stencil);
  gl_.clear((call.clear.color ? gl::kColorBuffer : 0) | (call.clear.depth ? gl::kDepthBuffer : 0) |
            (call.clear.stencil ? gl::kStencilBuffer : 0));
}

void MesaFrame::render() {
  gl_.bind_framebuffer(gl::kFramebuffer, drawn_);
  for (const Call& call : calls_) {
    if (call.is_clear) {
      clear(call);
      continue;
    }
    apply(call);
    call.has_restart ? gl_.enable(gl::kPrimitiveRestart) : gl_.disable(gl::kPrimitiveRestart);
    gl_.draw_elements(mode_of(call.draw.topology), static_cast<int>(call.draw.count), gl::kUnsignedInt,
                      call.draw.first * sizeof(std::uint32_t));
  }
  if (drawn_ != resolved_) {
    gl_.bind_framebuffer(gl::kReadFramebuffer, drawn_);
    gl_.bind_framebuffer(gl::kDrawFramebuffer, resolved_);
    gl_.disable(gl::kScissorTest);
    gl_.blit_framebuffer(0, 0, width_, height_, 0, 0, width_, height_, gl::kColorBuffer, gl::kNearest);
    gl_.bind_framebuffer(gl::kFramebuffer, resolved_);
  }
  gl_.finish();
  if (const gl::Enum error = gl_.get_error(); error != 0)
    throw std::runtime_error("llvmpipe: OpenGL error " + std::to_string(error));
}

std::vector<std::uint32_t> MesaFrame::color() const {
  const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  std::vector<std::uint32_t> pixels(width * height);
  gl_.read_pixels(0, 0, width_, height_, gl::kRgba, gl::kUnsignedByte, pixels.data());
  for (std::size_t y = 0; y < height / 2; ++y)
    std::swap_ranges(pixels.begin() + static_cast<std::ptrdiff_t>(y * width),
                     pixels.begin() + static_cast<std::ptrdiff_t>((y + 1) * width),
                     pixels.begin() + static_cast<std::ptrdiff_t>((height - 1 - y) * width));
  return pixels;
}

std::string MesaFrame::name() const { return reinterpret_cast<const char*>(gl_.get_string(gl::kRenderer)); }

}  // namespace halfplane
