// Shared by GLX and EGL: a connection to the X server, its pixel formats, and drawables that show themselves.
#pragma once

#include <algorithm>
#include <atomic>
#include <climits>
#include <cstdint>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "../core/context.hpp"

#include <X11/X.h>
#include <xcb/shm.h>

namespace halfplane::gl {

/// Options of this process, read once. Throws InputError.
[[nodiscard]] const Options& options();

/// Pixels along a side of a drawable, at most: the range of window coordinates.
[[nodiscard]] int largest_side();

/// Whether the options can be read; prints their errors on stderr. Writes `system` to the file that the environment
/// variable HALFPLANE_GL_ANSWERED names, so that `halfplane run` knows which libraries were loaded.
[[nodiscard]] bool answers(const char* system);

// Bits of every pixel, whatever the configuration stores of it.
inline constexpr int kColorBits = 8;  ///< of each of R, G, B, A
inline constexpr int kDepthBits = 24, kStencilBits = 8;
inline constexpr int kAccumBits = 16;  ///< of each of R, G, B, A

struct Visual {
  VisualID visualid = 0;  ///< 0: no visual
  int depth = 0;
  std::uint32_t red_mask = 0, green_mask = 0, blue_mask = 0;
};

/// Buffers that go with a visual.
struct PixelFormat {
  Visual visual;
  bool double_buffered = true;
};

/// A connection of the driver's own to an X server, by XCB: Xlib would hand errors (a window that is gone) to the program's
/// handler wherever it reads them without a reply. Any thread may use it.
class Server {
 public:
  /// The server of a display's name, null for that of the environment. Kept until the process ends. Null: no server answers.
  [[nodiscard]] static Server* open(const char* name);

  [[nodiscard]] int screens() const { return static_cast<int>(formats_.size()); }
  [[nodiscard]] int default_screen() const { return default_screen_; }
  /// A screen's TrueColor visuals. The default visual comes first, visuals with alpha last. The second visual of each
  /// depth is single-buffered; where there is none, the first stands for both.
  [[nodiscard]] const std::vector<PixelFormat>& formats(int screen) const {
    return formats_[static_cast<std::size_t>(screen)];
  }

  struct Geometry {
    int screen = 0, depth = 0, width = 0, height = 0;
  };
  /// The geometry of a window or pixmap, or of a window alone. None: there is no such drawable.
  [[nodiscard]] std::optional<Geometry> geometry(XID drawable, bool must_be_window = false) const;

  /// From now on changes of the window's size are seen.
  void watch(XID window) const;
  /// Whether the size may have changed since the last call. Asks nobody: the server tells.
  [[nodiscard]] bool has_changed(XID window);

 private:
  friend class Window;
  Server(xcb_connection_t* connection, int default_screen);
  void read_events();

  xcb_connection_t* connection_;
  int default_screen_;
  std::atomic<bool> has_shm_;
  std::vector<std::vector<PixelFormat>> formats_;  // by screen
  std::mutex mutex_;
  std::set<XID> changed_;
};

enum class DrawableKind { window, pixmap, pbuffer };

class Window final : public Drawable {
 public:
  /// Pbuffers have no `x_drawable`, and need no server. Throws InputError for a size that the configuration does not take.
  Window(DrawableKind what, Server* x_server, XID x_drawable, const PixelFormat& its_format, int width, int height);
  ~Window() override;

  void show(const Framebuffer& picture) override;
  void present() override;
  void finish() override;
  /// Ends the frame, shows it, and takes over the window's size.
  void swap();
  /// Shows the picture in `target`, a window or pixmap of the depth of the format.
  void show_in(XID target, const Framebuffer& picture);
  /// Takes over the size of the X window. False: the window is gone.
  bool follow_size();

  const DrawableKind kind;
  Server* const server;
  const XID xid;  ///< of the X window or pixmap
  const PixelFormat format;
  int swap_interval = 1;         ///< kept for queries: there is no vertical retrace to wait for
  unsigned long event_mask = 0;  ///< glXSelectEvent; no pbuffer is ever clobbered

 private:
  /// Memory for a picture of that size, from which the server reads.
  void make_image(int width, int height);
  /// Writes the picture there, in the visual's pixels.
  void convert(const Framebuffer& picture);
  void send_to(XID target);
  void free_image();
  void wait_for_server();

  // The picture as the server reads it.
  int width_ = 0, height_ = 0, bits_per_pixel_ = 0;
  std::size_t pitch_ = 0;          // bytes of a row
  std::uint8_t* bytes_ = nullptr;  // null: none yet
  xcb_shm_seg_t segment_ = 0;      // 0: in own_
  std::vector<std::uint8_t> own_;
  xcb_gcontext_t gc_ = 0;
  std::optional<xcb_get_input_focus_cookie_t> sent_;  // answered when the server has read the last picture
};

/// A pbuffer by `make(width, height)`. One that is to be the largest is halved until there is memory. Throws as make() does.
template <class Make>
auto make_pbuffer(std::intptr_t width, std::intptr_t height, bool largest, Make make) {
  const std::intptr_t most = largest ? largest_side() : INT_MAX;
  auto w = static_cast<int>(std::clamp<std::intptr_t>(width, 1, most));
  auto h = static_cast<int>(std::clamp<std::intptr_t>(height, 1, most));
  for (;; w -= w / 2, h -= h / 2) {
    try {
      return make(w, h);
    } catch (const std::exception&) {
      if (!largest || (w == 1 && h == 1)) throw;
    }
  }
}

/// A function that libglvnd asks for by its name.
struct Named {
  std::string_view name;
  void* function;
  void* dispatch = nullptr;  ///< of GLX extensions: data for finding the vendor's function
};
template <class Function>
void* address(Function* function) {
  return reinterpret_cast<void*>(function);
}

}  // namespace halfplane::gl
