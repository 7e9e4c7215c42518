// A scene in this pipeline and in Mesa's, side by side, with every pixel on which their coverage differs.
//
// Not part of the build: `tools/mesa/run` compiles it against OSMesa (Debian: libosmesa6-dev). Coverage is compared
// with the depth test off and one colour, so that it is the line rule alone that shows.
#include <GL/gl.h>
#include <GL/osmesa.h>

#include <cstdio>
#include <iostream>
#include <stdexcept>

#include "model/engines/functional.hpp"
#include "model/host/primitive_assembly.hpp"
#include "sim/scene/load.hpp"
#include "sim/show/image/framebuffer_files.hpp"
#include "sim/show/image/panel.hpp"
#include "sim/show/image/png.hpp"

namespace halfplane {
namespace {

/// OpenGL without a window, drawing into memory: RGBA bytes, row 0 at the top.
class Mesa {
 public:
  Mesa(int width, int height) : width_(width), height_(height), pixels_(static_cast<std::size_t>(width * height) * 4) {
    context_ = OSMesaCreateContextExt(OSMESA_RGBA, 24, 0, 0, nullptr);
    if (context_ == nullptr || OSMesaMakeCurrent(context_, pixels_.data(), GL_UNSIGNED_BYTE, width, height) == GL_FALSE)
      throw std::runtime_error("OSMesa gives no context");
    OSMesaPixelStore(OSMESA_Y_UP, 0);
    glViewport(0, 0, width, height);
    glDisable(GL_DITHER);
  }
  ~Mesa() { OSMesaDestroyContext(context_); }
  Mesa(const Mesa&) = delete;
  Mesa& operator=(const Mesa&) = delete;

  [[nodiscard]] Picture finish() const {
    glFinish();
    Picture picture(width_, height_);
    for (std::size_t i = 0; i < pixels_.size() / 4; ++i)
      for (std::size_t c = 0; c < 3; ++c) picture.rgb[3 * i + c] = pixels_[4 * i + c];
    return picture;
  }

 private:
  int width_, height_;
  std::vector<std::uint8_t> pixels_;
  OSMesaContext context_ = nullptr;
};

GLenum gl_func(DepthFunc func) {
  constexpr std::array<GLenum, 8> kFunctions{GL_NEVER,   GL_LESS,   GL_LEQUAL,   GL_EQUAL,
                                             GL_GREATER, GL_GEQUAL, GL_NOTEQUAL, GL_ALWAYS};
  return kFunctions[static_cast<std::size_t>(func)];
}

void apply(const State& state, const Scene& scene) {
  glMatrixMode(GL_PROJECTION);
  glLoadIdentity();
  if (state.space == Space::window) glOrtho(0, scene.width, scene.height, 0, 0, -1);  // z in [0, 1] passes as it is
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(gl_func(state.depth_test));
  glDepthMask(state.depth_write ? GL_TRUE : GL_FALSE);
  const GLboolean color = state.color_write ? GL_TRUE : GL_FALSE;
  glColorMask(color, color, color, color);
  glPolygonMode(GL_FRONT_AND_BACK, state.polygon_mode == PolygonMode::fill   ? GL_FILL
                                   : state.polygon_mode == PolygonMode::line ? GL_LINE
                                                                             : GL_POINT);
  const bool has_offset = state.polygon_offset != std::array<double, 2>{};
  for (const GLenum mode : {GL_POLYGON_OFFSET_FILL, GL_POLYGON_OFFSET_LINE, GL_POLYGON_OFFSET_POINT})
    has_offset ? glEnable(mode) : glDisable(mode);
  glPolygonOffset(static_cast<float>(state.polygon_offset[0]), static_cast<float>(state.polygon_offset[1]));
  glLineWidth(static_cast<float>(state.line_width));
  glPointSize(static_cast<float>(state.point_size));
  glShadeModel(state.shade == Shade::flat ? GL_FLAT : GL_SMOOTH);
}

void draw(const Scene& scene, const Draw& draw, bool is_white) {
  const State& state = scene.states[draw.state];
  apply(state, scene);
  for_each_primitive(scene, draw, state.provoking, [&](const AssembledPrimitive& primitive) {
    const std::size_t count = primitive.type == PrimitiveType::triangle ? 3
                              : primitive.type == PrimitiveType::line   ? 2
                                                                        : 1;
    glBegin(count == 3 ? GL_TRIANGLES : count == 2 ? GL_LINES : GL_POINTS);
    for (std::size_t i = 0; i < count; ++i) {
      const Vertex& v = scene.vertices[primitive.index[i]];
      is_white ? glColor3d(1, 1, 1) : glColor3d(v.rgba[0] / 255, v.rgba[1] / 255, v.rgba[2] / 255);
      state.space == Space::window ? glVertex3d(v.x, v.y, v.z) : glVertex4d(v.x, v.y, v.z, v.w);
    }
    glEnd();
  });
}

Picture render_mesa(const Scene& scene, bool is_white) {
  const Mesa mesa(scene.width, scene.height);
  for (const Command& command : scene.commands) {
    if (const auto* clear = std::get_if<Clear>(&command)) {
      const auto color = clear->color.value_or(std::array<double, 4>{0, 0, 0, 255});
      glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
      glDepthMask(GL_TRUE);
      glClearColor(static_cast<float>(is_white ? 0 : color[0] / 255), static_cast<float>(is_white ? 0 : color[1] / 255),
                   static_cast<float>(is_white ? 0 : color[2] / 255), 1);
      glClearDepth(clear->depth.value_or(1));
      glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    }
    if (const auto* next = std::get_if<Draw>(&command)) draw(scene, *next, is_white);
  }
  return mesa.finish();
}

/// Lines and points alone, each pixel of them, whatever lies in front.
Scene outlines_of(Scene scene) {
  std::vector<Command> kept;
  for (const Command& command : scene.commands) {
    const auto* draw = std::get_if<Draw>(&command);
    if (draw != nullptr && primitive_type(draw->topology) == PrimitiveType::triangle &&
        scene.states[draw->state].polygon_mode == PolygonMode::fill)
      continue;
    kept.push_back(command);
  }
  scene.commands = kept;
  for (State& state : scene.states) state.depth_test = DepthFunc::always;
  return scene;
}

Picture render_here(const Scene& scene) {
  const Config config = preset("full");
  const Rendering rendering = render_functional(scene, config);
  return color_picture(rendering.frame, config.color_format);
}

void run(const std::string& name, int width, int height, const std::string& out) {
  std::vector<std::string> warnings;
  const Scene scene = load_scene({name, width, height}, warnings);
  const Scene outlines = outlines_of(scene);
  RenderOptions options;
  options.want_count = true;
  const Rendering here = render_functional(outlines, preset("full"), options);
  const Picture there = render_mesa(outlines, true);
  Picture difference(scene.width, scene.height, {20, 20, 30});
  std::size_t both = 0, only_here = 0, only_there = 0;
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x) {
      const bool is_here = here.count[static_cast<std::size_t>(y * scene.width + x)] != 0;
      const bool is_there = there.get(x, y).r != 0;
      both += is_here && is_there;
      only_here += is_here && !is_there;
      only_there += !is_here && is_there;
      if (is_here || is_there)
        set_pixel(difference, x, y,
                  is_here && is_there ? Rgb{90, 90, 90}
                  : is_here           ? Rgb{255, 120, 0}
                                      : Rgb{0, 170, 255});
    }
  std::printf("%s %dx%d: %zu pixels in both, %zu only here, %zu only in Mesa\n", name.c_str(), scene.width,
              scene.height, both, only_here, only_there);
  std::vector<Panel> panels(3);
  panels[0].caption = "halfplane, diamond exit";
  panels[0].picture = render_here(scene);
  panels[1].caption = "Mesa";
  panels[1].picture = render_mesa(scene, false);
  panels[2].caption = "coverage, depth test off";
  panels[2].picture = difference;
  panels[2].legend = std::vector<LegendEntry>{{{90, 90, 90}, "both " + std::to_string(both)},
                                              {{255, 120, 0}, "only here " + std::to_string(only_here)},
                                              {{0, 170, 255}, "only in Mesa " + std::to_string(only_there)}};
  write_png(out, compose_sheet(name, panels, 3));
}

}  // namespace
}  // namespace halfplane

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << "usage: mesa_lines SCENE WIDTH HEIGHT OUT.png\n";
    return 2;
  }
  try {
    halfplane::run(argv[1], std::stoi(argv[2]), std::stoi(argv[3]), argv[4]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
