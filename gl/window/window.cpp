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

/// A thread of the program may draw while another ends the process, so nothing static of this library (the symbol does not
/// leave it) is ever destroyed.
extern "C" int __cxa_atexit(void (*)(void*), void*, void*) { return 0; }  // NOLINT: the name is the runtime's

namespace halfplane::gl {
namespace {

/// An answer or event of the server's.
template <class T>
using Reply = std::unique_ptr<T, decltype([](T* reply) { std::free(reply); })>;

std::vector<PixelFormat> true_color_formats(xcb_screen_t* screen) {
  std::vector<Visual> visuals;
  for (auto depth = xcb_screen_allowed_depths_iterator(screen); depth.rem != 0; xcb_depth_next(&depth))
    for (auto it = xcb_depth_visuals_iterator(depth.data); it.rem != 0; xcb_visualtype_next(&it))
      if (const xcb_visualtype_t& v = *it.data; v._class == XCB_VISUAL_CLASS_TRUE_COLOR && depth.data->depth >= 8)
        visuals.push_back({v.visual_id, depth.data->depth, v.red_mask, v.green_mask, v.blue_mask});
  std::ranges::stable_sort(visuals, {}, [&](const Visual& v) {
    return v.visualid == screen->root_visual ? -1 : v.depth > 24 ? 100 + v.depth : 24 - v.depth;
  });
  std::vector<PixelFormat> formats;
  std::map<int, int> of_depth;  // visuals so far
  for (const Visual& visual : visuals) formats.push_back({visual, ++of_depth[visual.depth] != 2});
  for (const Visual& visual : visuals)
    if (of_depth[visual.depth] == 1) formats.push_back({visual, false});
  return formats;
}

/// 0xaarrggbb of a stored code.
constexpr std::uint32_t argb(ColorFormat format, std::uint32_t code) {
  const auto [r, g, b, a] = widen_color(format, code);
  return a << 24 | r << 16 | g << 8 | b;
}

/// An 8-bit channel as one of as many bits as `mask` has.
std::uint32_t in_mask(std::uint32_t channel, std::uint32_t mask) {
  if (mask == 0) return 0;
  const int shift = std::countr_zero(mask);
  return (channel * (mask >> shift) + 127) / 255 << shift;
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
  if (name == nullptr || *name == 0) name = std::getenv("DISPLAY");
  std::unique_ptr<Server>& server = (*servers)[name == nullptr ? "" : name];
  if (server == nullptr) {
    int screen = 0;
    xcb_connection_t* const connection = xcb_connect(name, &screen);
    if (xcb_connection_has_error(connection) == 0)
      server.reset(new Server(connection, screen));
    else
      xcb_disconnect(connection);
  }
  return server.get();
}

Server::Server(xcb_connection_t* connection, int default_screen)
    : connection_(connection),
      default_screen_(default_screen),
      has_shm_(xcb_get_extension_data(connection, &xcb_shm_id)->present != 0) {
  for (auto it = xcb_setup_roots_iterator(xcb_get_setup(connection)); it.rem != 0; xcb_screen_next(&it))
    formats_.push_back(true_color_formats(it.data));
}

std::optional<Server::Geometry> Server::geometry(XID drawable, bool must_be_window) const {
  const auto id = static_cast<xcb_drawable_t>(drawable);
  if (id == 0) return std::nullopt;
  if (must_be_window) {
    const auto asked = xcb_get_window_attributes(connection_, id);
    if (!Reply<xcb_get_window_attributes_reply_t>(xcb_get_window_attributes_reply(connection_, asked, nullptr)))
      return std::nullopt;
  }
  const auto asked = xcb_get_geometry(connection_, id);
  const Reply<xcb_get_geometry_reply_t> has(xcb_get_geometry_reply(connection_, asked, nullptr));
  if (has == nullptr) return std::nullopt;
  int screen = 0;
  for (auto it = xcb_setup_roots_iterator(xcb_get_setup(connection_)); it.rem != 0; xcb_screen_next(&it), ++screen)
    if (it.data->root == has->root) return Geometry{screen, has->depth, has->width, has->height};
  return std::nullopt;
}

void Server::watch(XID window) const {
  const std::uint32_t events = XCB_EVENT_MASK_STRUCTURE_NOTIFY;
  xcb_change_window_attributes(connection_, static_cast<xcb_window_t>(window), XCB_CW_EVENT_MASK, &events);
}

void Server::read_events() {
  const std::lock_guard lock(mutex_);
  // Errors come this way as well: of windows that are gone, which is no matter.
  while (const Reply<xcb_generic_event_t> event{xcb_poll_for_event(connection_)})
    if ((event->response_type & 0x7f) == XCB_CONFIGURE_NOTIFY)
      changed_.insert(reinterpret_cast<const xcb_configure_notify_event_t*>(event.get())->window);
}

bool Server::has_changed(XID window) {
  read_events();
  const std::lock_guard lock(mutex_);
  return changed_.erase(window) != 0;
}

Window::Window(DrawableKind what, Server* x_server, XID x_drawable, const PixelFormat& its_format, int width,
               int height)
    : Drawable(options(), width, height), kind(what), server(x_server), xid(x_drawable), format(its_format) {
  single_buffered = !format.double_buffered || kind == DrawableKind::pixmap;
}

Window::~Window() {
  frame.wait();
  if (server == nullptr) return;
  free_image();
  xcb_flush(server->connection_);
}

void Window::present() {
  frame.end([this](const Framebuffer& picture) { show(picture); });
  finish();
}

void Window::finish() {
  Drawable::finish();
  wait_for_server();
}

void Window::wait_for_server() {
  if (!sent_) return;
  Reply<xcb_get_input_focus_reply_t>(xcb_get_input_focus_reply(server->connection_, *sent_, nullptr));
  sent_.reset();
  server->read_events();  // also where no swap asks for them
}

void Window::show(const Framebuffer& picture) {
  if (kind != DrawableKind::pbuffer) show_in(xid, picture);
}

void Window::swap() {
  if (single_buffered) return;
  Drawable::swap();
  if (kind == DrawableKind::window && server->has_changed(xid)) follow_size();
}

bool Window::follow_size() {
  if (kind != DrawableKind::window) return true;
  server->watch(xid);  // again: another window may have this one's id now
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
  wait_for_server();
  if (segment_ != 0) {
    xcb_shm_detach(server->connection_, segment_);
    shmdt(bytes_);
  }
  bytes_ = nullptr;
  segment_ = 0;
}

void Window::make_image(int width, int height) {
  if (bytes_ != nullptr && width_ == width && height_ == height) return;
  free_image();
  xcb_connection_t* const connection = server->connection_;
  int padding = 32;
  for (auto it = xcb_setup_pixmap_formats_iterator(xcb_get_setup(connection)); it.rem != 0; xcb_format_next(&it))
    if (it.data->depth == format.visual.depth)
      bits_per_pixel_ = it.data->bits_per_pixel, padding = it.data->scanline_pad;
  width_ = width, height_ = height;
  pitch_ = static_cast<std::size_t>((width * bits_per_pixel_ + padding - 1) / padding * padding / 8);
  const std::size_t size = pitch_ * static_cast<std::size_t>(height);
  if (server->has_shm_) {
    const int id = shmget(IPC_PRIVATE, size, IPC_CREAT | 0600);
    void* const memory = id < 0 ? nullptr : shmat(id, nullptr, 0);
    if (memory != nullptr && reinterpret_cast<std::intptr_t>(memory) != -1) {
      segment_ = xcb_generate_id(connection);
      bytes_ = static_cast<std::uint8_t*>(memory);
      const auto asked = xcb_shm_attach_checked(connection, segment_, static_cast<std::uint32_t>(id), 1);
      if (const Reply<xcb_generic_error_t> error{xcb_request_check(connection, asked)}) {
        shmdt(memory);
        segment_ = 0;
        server->has_shm_ = false;  // a server on another machine
      }
    }
    if (id >= 0) shmctl(id, IPC_RMID, nullptr);  // goes with the last process that has it
    if (segment_ != 0) return;
  }
  own_.resize(size);
  bytes_ = own_.data();
}

void Window::show_in(XID target, const Framebuffer& picture) {
  wait_for_server();
  make_image(picture.width, picture.height);
  convert(picture);
  send_to(target);
}

void Window::convert(const Framebuffer& picture) {
  const ColorFormat color_format = frame.options().config.color_format;
  const int width = width_, height = height_;
  const Visual& visual = format.visual;
  const bool is_lsb_first = xcb_get_setup(server->connection_)->image_byte_order == XCB_IMAGE_ORDER_LSB_FIRST;
  const bool is_direct = bits_per_pixel_ == 32 && is_lsb_first && visual.red_mask == 0xff0000 &&
                         visual.green_mask == 0xff00 && visual.blue_mask == 0xff &&
                         std::endian::native == std::endian::little;
  const int pitch = is_direct ? static_cast<int>(pitch_ / 4) : width;
  std::vector<std::uint32_t> converted(is_direct ? 0 : static_cast<std::size_t>(pitch) * static_cast<unsigned>(height));
  const std::span<std::uint32_t> pixels(is_direct ? reinterpret_cast<std::uint32_t*>(bytes_) : converted.data(),
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
    const std::uint32_t alpha_mask = visual.depth == 32 ? ~(visual.red_mask | visual.green_mask | visual.blue_mask) : 0;
    const int bytes = bits_per_pixel_ / 8;
    for (int y = 0; y < height; ++y) {
      std::uint8_t* to = bytes_ + static_cast<std::size_t>(y) * pitch_;
      for (const std::uint32_t c : pixels.subspan(static_cast<std::size_t>(y) * static_cast<unsigned>(width))
                                       .first(static_cast<unsigned>(width))) {
        const std::uint32_t value = in_mask(c >> 16 & 255, visual.red_mask) | in_mask(c >> 8 & 255, visual.green_mask) |
                                    in_mask(c & 255, visual.blue_mask) | in_mask(c >> 24, alpha_mask);
        for (int i = 0; i < bytes; ++i)
          *to++ = static_cast<std::uint8_t>(value >> 8 * (is_lsb_first ? i : bytes - 1 - i));
      }
    }
  }
}

void Window::send_to(XID target) {
  xcb_connection_t* const connection = server->connection_;
  const auto to = static_cast<xcb_drawable_t>(target);
  const auto w = static_cast<std::uint16_t>(width_), h = static_cast<std::uint16_t>(height_);
  const auto depth = static_cast<std::uint8_t>(format.visual.depth);
  // Anew for each picture: the target's screen may be another one, and the last target may have been gone.
  if (gc_ == 0) gc_ = xcb_generate_id(connection);
  xcb_create_gc(connection, gc_, to, 0, nullptr);
  if (segment_ != 0) {
    xcb_shm_put_image(connection, to, gc_, w, h, 0, 0, w, h, 0, 0, depth, XCB_IMAGE_FORMAT_Z_PIXMAP, 0, segment_, 0);
  } else {
    const std::size_t most =
        xcb_get_maximum_request_length(connection) * std::size_t{4} - sizeof(xcb_put_image_request_t) - 4;
    const int rows = static_cast<int>(std::clamp<std::size_t>(most / pitch_, 1, h));
    for (int y = 0; y < height_; y += rows) {
      const int count = std::min(rows, height_ - y);
      xcb_put_image(connection, XCB_IMAGE_FORMAT_Z_PIXMAP, to, gc_, w, static_cast<std::uint16_t>(count), 0,
                    static_cast<std::int16_t>(y), 0, depth,
                    static_cast<std::uint32_t>(pitch_) * static_cast<unsigned>(count),
                    bytes_ + static_cast<std::size_t>(y) * pitch_);
    }
  }
  xcb_free_gc(connection, gc_);
  sent_ = xcb_get_input_focus(connection);  // the server reads the picture beside the next frame
  xcb_flush(connection);
}

}  // namespace halfplane::gl
