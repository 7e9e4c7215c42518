// A context: the state of OpenGL 1.5, objects shared with other contexts, and its drawable. Commands are functions on it
// (commands.hpp); entry points are a table of them (entry_points.cpp).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "frame.hpp"
#include "objects.hpp"
#include "state.hpp"
#include "vertices.hpp"

namespace halfplane::gl {

/// A target of contexts: a window, a pbuffer. Made by the window system's side (glx/, egl/), which shows pictures in show().
struct Drawable {
  Drawable(const Options& options, int width, int height) : frame(options, width, height) {}
  virtual ~Drawable() { frame.wait(); }
  Drawable(const Drawable&) = delete;
  Drawable& operator=(const Drawable&) = delete;

  /// Shows the picture of `frame`. Any thread may call it, one at a time.
  virtual void show(const Framebuffer& /*picture*/) {}
  /// Ends the frame and shows it; called by glFlush and glFinish where the drawn buffer is the front one.
  virtual void present() {}
  /// Waits until all frames that have ended are drawn, and seen where they are shown.
  virtual void finish() { frame.wait(); }
  /// Ends the frame of the back buffer and copies it to the front one.
  void swap();

  // There are two colour buffers from the first call on that names the front one. Until then the front buffer has the colours
  // of the back buffer, as after a swap.

  /// Makes `frame` draw to the front or the back buffer.
  void draw_to(bool front);
  /// Colours of the front or the back buffer, as `frame` has them. Valid until the next call.
  [[nodiscard]] const Framebuffer::Image& colors(bool front);
  /// Makes a front buffer with the colours of the picture, where there is none or `copies`.
  void make_front(bool copies = false);

  Frame frame;
  bool single_buffered = false;

 private:
  std::unique_ptr<Framebuffer> other_;  ///< colours of the buffer that `frame` does not draw to
  bool draws_to_front_ = false;
};

using Mat4 = std::array<double, 16>;  ///< column by column, as OpenGL has them
inline constexpr Mat4 kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

struct EvaluatorMap {
  int components = 0;
  std::array<int, 2> order{1, 1};
  std::array<double, 4> range{0, 1, 0, 1};
  std::vector<double> point;  ///< order[0] * order[1] * components, v fastest
};

struct SavedAttributes {
  GLbitfield mask = 0;
  State state;
  std::vector<TextureParameters> textures;  ///< GL_TEXTURE_BIT: bound textures, unit by unit, as kTextureTargets
};

struct Query {
  bool exists = false;  ///< has been begun, not only named
  bool active = false;
  std::uint64_t begun_at = 0, samples = 0;
};

struct DrawSetup;         // batch.hpp
struct ShadingConstants;  // shading.hpp

struct Context {
  explicit Context(std::shared_ptr<SharedObjects> shared_objects = std::make_shared<SharedObjects>());
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  State state;
  ClientState client;
  std::shared_ptr<SharedObjects> shared;
  Drawable* drawable = nullptr;       ///< null: nothing is drawn
  Drawable* read_drawable = nullptr;  ///< source of glReadPixels
  bool was_current = false;           ///< viewport and scissor have been set to the size of the first drawable
  bool is_embedded = false;           ///< a context of OpenGL ES-CM, for glGetString
  std::string renderer;               ///< the answer of glGetString to GL_RENDERER

  GLenum error = GL_NO_ERROR;
  /// Keeps the first error until glGetError.
  void fail(GLenum code) {
    if (error == GL_NO_ERROR) error = code;
  }

  // Matrices (matrix.cpp). The last one of each stack is current.
  std::vector<Mat4> modelview{kIdentity}, projection{kIdentity};
  std::array<std::vector<Mat4>, kTextureUnits> texture_matrix;

  // Between glBegin and glEnd (vertex.cpp).
  static constexpr GLenum kNoPrimitive = ~0U;
  GLenum primitive = kNoPrimitive;
  InputVertices input;    ///< the vertices since glBegin, or of a draw of arrays
  ShadedVertices shaded;  ///< of the current primitive, draw or list
  [[nodiscard]] bool inside_begin() const { return primitive != kNoPrimitive; }

  /// Raised by every command that is not a vertex or an attribute of one, so that values derived from state are computed once.
  std::uint64_t revision = 1;
  std::shared_ptr<ShadingConstants> shading;  ///< shade.cpp
  std::shared_ptr<DrawSetup> draw_setup;      ///< batch.cpp

  std::map<GLenum, EvaluatorMap> maps;              ///< by GL_MAP1_... and GL_MAP2_...
  std::map<GLenum, std::vector<float>> pixel_maps;  ///< by GL_PIXEL_MAP_...
  std::vector<SavedAttributes> attributes;          ///< glPushAttrib
  std::vector<std::pair<GLbitfield, ClientState>> client_attributes;
  std::array<TextureObject, 4> default_textures;  ///< name 0, by kTextureTargets
  /// Textures named by TextureUnit::bound, kept while another context deletes them. Another name: out of date.
  std::array<std::array<std::shared_ptr<TextureObject>, 4>, kTextureUnits> bound_textures;
  std::array<std::array<TextureImage, 13>, 4> proxies;
  std::map<std::uint64_t, std::uint32_t> texture_fits;  ///< how the model combines a texture (texture_upload.cpp)
  std::map<GLuint, Query> queries;
  GLuint active_query = 0;

  // glRenderMode (feedback.cpp).
  GLenum render_mode = GL_RENDER;
  std::vector<GLuint> names;
  GLuint* select_buffer = nullptr;
  GLfloat* feedback_buffer = nullptr;
  GLsizei select_size = 0, feedback_size = 0;
  GLenum feedback_type = GL_2D;
  std::size_t feedback_used = 0, select_used = 0;
  GLint hits = 0;
  bool overflowed = false, was_hit = false;
  double hit_low = 1, hit_high = 0;

  std::vector<std::array<float, 4>> accumulation;  ///< RGBA of each pixel, rows from the bottom; empty until it is used

  // Display lists (list.cpp).
  std::shared_ptr<DisplayList> compiling;  ///< null: none
  GLuint compiling_name = 0;
  bool compiles_and_executes = false;
  int list_depth = 0;
};

/// Gives a program names that are not in use; they are from now on.
template <class Object>
void generate(Context& context, std::map<GLuint, Object>& objects, GLsizei n, GLuint* names) {
  if (n < 0) return context.fail(GL_INVALID_VALUE);
  GLuint name = objects.empty() ? 1 : objects.rbegin()->first + 1;
  for (GLsizei i = 0; i < n; ++i, ++name) {
    while (name == 0 || objects.contains(name)) ++name;
    names[i] = name;
    objects[name];
  }
}

/// The context of this thread; null: none.
[[nodiscard]] Context* current();
/// Makes it that of this thread, draws and reads where it says. Null: none.
void make_current(Context* context, Drawable* draw, Drawable* read);

}  // namespace halfplane::gl
