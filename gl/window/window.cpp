#include "window.hpp"

#include <sys/ipc.h>
#include <sys/shm.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "../../model/stages/color_ops.hpp"

#include <X11/Xlibint.h>
#undef min
#undef max

/// A thread of the program may draw while another ends the process, so nothing static of this library (the symbol does not
/// leave it) is ever destroyed.
extern "C" int __cxa_atexit(void (*)(void*), void*, void*) { return 0; }  // NOLINT: the name is the runtime's

namespace halfplane::gl {
namespace {

/// X errors on connections of the driver's own. Each request that can fail is followed by XSync() in the same thread.
thread_local int g_errors = 0;

int count_error(Display*, xError*, XExtCodes*, int* result_of_reply) {
  ++g_errors;
  *result_of_reply = 0;
  return 1;  // handled
}

std::vector<PixelFormat> true_color_formats(Display* display, int screen) {
  XVisualInfo wanted{};
  wanted.screen = screen;
  wanted.c_class = TrueColor;
  int count = 0;
  XVisualInfo* const found = XGetVisualInfo(display, VisualScreenMask | VisualClassMask, &wanted, &count);
  std::vector<XVisualInfo> visuals(found, found + count);
  if (found != nullptr) XFree(found);
  const VisualID usual = XVisualIDFromVisual(DefaultVisual(display, screen));
  std::ranges::stable_sort(visuals, {}, [&](const XVisualInfo& v) {
    return v.visualid == usual ? -1 : v.depth > 24 ? 100 + v.depth : 24 - v.depth;
  });
  std::vector<PixelFormat> formats;
  std::map<int, int> of_depth;  // visuals so far
  for (const XVisualInfo& visual : visuals) formats.push_back({visual, ++of_depth[visual.depth] != 2});
  for (const XVisualInfo& visual : visuals)
    if (of_depth[visual.depth] == 1) formats.push_back({visual, false});
  return formats;
}

/// 0xaarrggbb of a stored code.
constexpr std::uint32_t argb(ColorFormat format, std::uint32_t code) {
  const auto [r, g, b, a] = widen_color(format, code);
  return a << 24 | r << 16 | g << 8 | b;
}

/// An 8-bit channel as one of as many bits as `mask` has.
unsigned long in_mask(std::uint32_t channel, unsigned long mask) {
  if (mask == 0) return 0;
  const int shift = __builtin_ctzl(mask);
  return (channel * (mask >> shift) + 127) / 255 << shift;
}

bool is_little_endian_argb(const XImage& image) {
  return image.bits_per_pixel == 32 && image.byte_order == LSBFirst && image.red_mask == 0xff0000 &&
         image.green_mask == 0xff00 && image.blue_mask == 0xff && std::endian::native == std::endian::little;
}

}  // namespace

const Options& options() {
  static const Options options = options_from_environment();
  return options;
}

int largest_side() { return std::min(options().config.guard_band, kLargestSide); }

bool answers(const char* system) {
  if (const char* path = std::getenv("HALFPLANE_GL_ANSWERED"); path != nullptr && *path != 0)
    std::ofstream(path, std::ios::app) << (std::string(system) + '\n');
  try {
    static_cast<void>(options());
    return true;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "halfplane: %s\n", e.what());
    return false;
  }
}

Server* Server::open(const char* name) {
  static std::mutex mutex;
  static std::map<std::string, std::unique_ptr<Server>>* servers = new std::map<std::string, std::unique_ptr<Server>>;
  const std::lock_guard lock(mutex);
  std::unique_ptr<Server>& server = (*servers)[XDisplayName(name)];
  if (server == nullptr)
    if (Display* const display = XOpenDisplay(name); display != nullptr) server.reset(new Server(display));
  return server.get();
}

Server::Server(Display* display) : display_(display), has_shm_(XShmQueryExtension(display) != 0) {
  if (const XExtCodes* codes = XAddExtension(display); codes != nullptr)
    XESetError(display, codes->extension, count_error);
  for (int screen = 0; screen < ScreenCount(display); ++screen) formats_.push_back(true_color_formats(display, screen));
}

std::optional<Server::Geometry> Server::geometry(XID drawable, bool must_be_window) {
  const std::lock_guard lock(mutex_);
  ::Window root = 0;
  int x = 0, y = 0;
  unsigned width = 0, height = 0, border = 0, depth = 0;
  XWindowAttributes attributes;
  if (drawable == 0 || (must_be_window && XGetWindowAttributes(display_, drawable, &attributes) == 0) ||
      XGetGeometry(display_, drawable, &root, &x, &y, &width, &height, &border, &depth) == 0)
    return std::nullopt;
  Geometry result{0, static_cast<int>(depth), static_cast<int>(width), static_cast<int>(height)};
  for (int screen = 0; screen < screens(); ++screen)
    if (RootWindow(display_, screen) == root) result.screen = screen;
  return result;
}

Window::Window(DrawableKind what, Server* x_server, XID x_drawable, const PixelFormat& its_format, int width,
               int height)
    : Drawable(options(), width, height), kind(what), server(x_server), xid(x_drawable), format(its_format) {
  single_buffered = !format.double_buffered || kind == DrawableKind::pixmap;
}

Window::~Window() {
  frame.wait();
  if (server == nullptr) return;
  const std::lock_guard lock(server->mutex_);
  free_image();
  if (gc_ != nullptr) XFreeGC(server->display_, gc_);
  XSync(server->display_, 0);
}

void Window::present() {
  frame.end([this](const Framebuffer& picture) { show(picture); });
  frame.wait();
}

void Window::show(const Framebuffer& picture) {
  if (kind != DrawableKind::pbuffer) show_in(xid, picture);
}

void Window::swap() {
  if (single_buffered) return;
  Drawable::swap();
  follow_size();
}

bool Window::follow_size() {
  if (kind != DrawableKind::window) return true;
  const std::optional<Server::Geometry> now = server->geometry(xid);
  if (!now) return false;
  if (now->width != frame.width() || now->height != frame.height()) {
    try {
      frame.resize(now->width, now->height);
    } catch (const InputError& e) {
      frame.missing(e.what(), "the window keeps the size that it had");
    }
  }
  return true;
}

void Window::free_image() {
  if (image_ == nullptr) return;
  if (segment_.shmaddr != nullptr) {
    XShmDetach(server->display_, &segment_);
    XSync(server->display_, 0);
    image_->data = nullptr;
    shmdt(segment_.shmaddr);
    segment_ = {};
  }
  XDestroyImage(image_);
  image_ = nullptr;
}

bool Window::make_image(int width, int height) {
  if (image_ != nullptr && image_->width == width && image_->height == height) return true;
  free_image();
  Display* const display = server->display_;
  const auto w = static_cast<unsigned>(width), h = static_cast<unsigned>(height);
  const auto depth = static_cast<unsigned>(format.visual.depth);
  const auto bytes = [&] { return static_cast<std::size_t>(image_->bytes_per_line) * h; };
  if (server->has_shm_) {
    image_ = XShmCreateImage(display, format.visual.visual, depth, ZPixmap, nullptr, &segment_, w, h);
    segment_.shmid = image_ == nullptr ? -1 : shmget(IPC_PRIVATE, bytes(), IPC_CREAT | 0600);
    void* const memory = segment_.shmid < 0 ? nullptr : shmat(segment_.shmid, nullptr, 0);
    if (memory != nullptr && reinterpret_cast<std::intptr_t>(memory) != -1) {
      segment_.shmaddr = image_->data = static_cast<char*>(memory);
      segment_.readOnly = 1;
      g_errors = 0;
      XShmAttach(display, &segment_);
      XSync(display, 0);
    }
    if (segment_.shmid >= 0) shmctl(segment_.shmid, IPC_RMID, nullptr);  // goes with the last process that has it
    if (segment_.shmaddr != nullptr && g_errors == 0) return true;
    server->has_shm_ = false;  // a server on another machine
    free_image();
    segment_ = {};
  }
  image_ = XCreateImage(display, format.visual.visual, depth, ZPixmap, 0, nullptr, w, h, 32, 0);
  if (image_ == nullptr) return false;
  image_->data = static_cast<char*>(std::malloc(bytes()));
  if (image_->data == nullptr) free_image();
  return image_ != nullptr;
}

void Window::show_in(XID target, const Framebuffer& picture) {
  const ColorFormat color_format = frame.options().config.color_format;
  const std::lock_guard lock(server->mutex_);
  const int width = picture.width, height = picture.height;
  if (!make_image(width, height)) return;
  const bool is_direct = is_little_endian_argb(*image_);
  const int pitch = is_direct ? image_->bytes_per_line / 4 : width;
  std::vector<std::uint32_t> converted(is_direct ? 0 : static_cast<std::size_t>(pitch) * static_cast<unsigned>(height));
  const std::span<std::uint32_t> pixels(is_direct ? reinterpret_cast<std::uint32_t*>(image_->data) : converted.data(),
                                        static_cast<std::size_t>(pitch) * static_cast<unsigned>(height));
  for (int y = 0; y < height; ++y) {
    const auto row = pixels.begin() + static_cast<std::ptrdiff_t>(y) * pitch;
    const auto codes = picture.color.begin() + static_cast<std::ptrdiff_t>(picture.at(0, y));
    if (color_format == ColorFormat::rgba8888)  // in lanes
      std::transform(codes, codes + width, row, [](std::uint32_t code) { return argb(ColorFormat::rgba8888, code); });
    else
      std::transform(codes, codes + width, row, [=](std::uint32_t code) { return argb(color_format, code); });
  }
  frame.draw_hud(pixels, width, height, pitch);
  if (!is_direct) {
    const unsigned long others = ~(image_->red_mask | image_->green_mask | image_->blue_mask);
    const unsigned long alpha_mask = format.visual.depth == 32 ? others & 0xffffffff : 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const std::uint32_t c =
            pixels[static_cast<std::size_t>(y) * static_cast<unsigned>(pitch) + static_cast<unsigned>(x)];
        XPutPixel(image_, x, y,
                  in_mask(c >> 16 & 255, image_->red_mask) | in_mask(c >> 8 & 255, image_->green_mask) |
                      in_mask(c & 255, image_->blue_mask) | in_mask(c >> 24, alpha_mask));
      }
  }
  Display* const display = server->display_;
  if (gc_ == nullptr) gc_ = XCreateGC(display, target, 0, nullptr);
  const auto w = static_cast<unsigned>(width), h = static_cast<unsigned>(height);
  if (segment_.shmaddr != nullptr)
    XShmPutImage(display, target, gc_, image_, 0, 0, 0, 0, w, h, 0);
  else
    XPutImage(display, target, gc_, image_, 0, 0, 0, 0, w, h);
  XSync(display, 0);  // the image is free again, and glFinish has to wait for the server
}

}  // namespace halfplane::gl
