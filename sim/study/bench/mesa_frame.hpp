// A Scene drawn by OpenGL into a framebuffer object: runs inside MesaPeer's process.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "model/scene.hpp"
#include "sim/study/bench/mesa_gl.hpp"

namespace halfplane {

/// One per process: OSMesa's context and its threads cannot be shut down.
class MesaFrame {
 public:
  /// `samples` of a pixel. Throws std::runtime_error when libOSMesa is missing or too old, or cannot make a target of that
  /// size.
  MesaFrame(int width, int height, int depth_bits, int samples);

  /// Vertices in binary32, colours in RGBA8, draws merged. Throws InputError for a state unsupported by OpenGL.
  void upload(const Scene& scene);

  /// Draws every command of the scene, and waits for the last pixel. Throws std::runtime_error for an error of OpenGL.
  void render();

  /// RGBA8, R in the low byte, rows from the top; with several samples their mean.
  [[nodiscard]] std::vector<std::uint32_t> color() const;

  /// GL_RENDERER: the rasterizer, its vector width and its compiler.
  [[nodiscard]] std::string name() const;

 private:
  struct Call {
    State state;
    Clear clear;  // of an empty scene
    Draw draw;
    bool is_clear = false, has_restart = false;
    gl::Name program = 0, texture = 0;
  };

  [[nodiscard]] gl::Name make_target(int samples) const;
  void check_draw_state(const State& state, Topology topology) const;
  [[nodiscard]] bool is_smooth_line(const State& state, Topology topology) const;
  [[nodiscard]] gl::Name program_of(const State& state);
  void make_vertices(const Scene& scene, Space space);
  void add_draw(const Scene& scene, const Draw& draw);
  void apply_target(const State& state) const;
  void apply(const Call& call) const;
  void clear(const Call& call) const;

  gl::Functions gl_;
  int width_, height_, depth_bits_, samples_;
  gl::Name drawn_ = 0, resolved_ = 0;         // targets; the same one with one sample per pixel
  std::map<std::string, gl::Name> programs_;  // by the source of their shaders
  std::vector<gl::Name> textures_;            // of the scene
  std::vector<bool> have_alpha_;              // likewise
  gl::Name arrays_[2]{};                      // of vertices given in clip space and in window space
  std::vector<Call> calls_;
};

}  // namespace halfplane
