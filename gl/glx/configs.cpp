// Configurations of frame buffers and the visuals that they stand for.
#include "glx.hpp"

namespace halfplane::gl::glx {
namespace {

/// GLX 1.4, table 3.1, with how glXChooseFBConfig() compares and its default (table 3.4).
constexpr ConfigAttribute<FbConfig> kAttributes[] = {
    {GLX_FBCONFIG_ID, Rule::exact, kDontCare, [](const FbConfig& c) { return c.id; }},
    {GLX_BUFFER_SIZE, Rule::at_least, 0, constant<4 * kColorBits>},
    {GLX_LEVEL, Rule::level, 0, constant<0>},
    {GLX_DOUBLEBUFFER, Rule::exact, kDontCare, [](const FbConfig& c) { return c.format.double_buffered ? 1 : 0; }},
    {GLX_STEREO, Rule::exact, 0, constant<0>},
    {GLX_AUX_BUFFERS, Rule::at_least, 0, constant<0>},
    {GLX_RED_SIZE, Rule::at_least, 0, constant<kColorBits>},
    {GLX_GREEN_SIZE, Rule::at_least, 0, constant<kColorBits>},
    {GLX_BLUE_SIZE, Rule::at_least, 0, constant<kColorBits>},
    {GLX_ALPHA_SIZE, Rule::at_least, 0, constant<kColorBits>},
    {GLX_DEPTH_SIZE, Rule::at_least, 0, constant<kDepthBits>},
    {GLX_STENCIL_SIZE, Rule::at_least, 0, constant<kStencilBits>},
    {GLX_ACCUM_RED_SIZE, Rule::at_least, 0, constant<kAccumBits>},
    {GLX_ACCUM_GREEN_SIZE, Rule::at_least, 0, constant<kAccumBits>},
    {GLX_ACCUM_BLUE_SIZE, Rule::at_least, 0, constant<kAccumBits>},
    {GLX_ACCUM_ALPHA_SIZE, Rule::at_least, 0, constant<kAccumBits>},
    {GLX_SAMPLE_BUFFERS, Rule::at_least, 0, constant<0>},
    {GLX_SAMPLES, Rule::at_least, 0, constant<0>},
    {GLX_RENDER_TYPE, Rule::mask, GLX_RGBA_BIT, constant<GLX_RGBA_BIT>},
    {GLX_DRAWABLE_TYPE, Rule::mask, GLX_WINDOW_BIT, constant<GLX_WINDOW_BIT | GLX_PIXMAP_BIT | GLX_PBUFFER_BIT>},
    {GLX_X_RENDERABLE, Rule::exact, kDontCare, constant<1>},
    {GLX_X_VISUAL_TYPE, Rule::exact, kDontCare, constant<GLX_TRUE_COLOR>},
    {GLX_CONFIG_CAVEAT, Rule::exact, kDontCare, constant<GLX_NONE>},
    {GLX_TRANSPARENT_TYPE, Rule::exact, GLX_NONE, constant<GLX_NONE>},
    {GLX_TRANSPARENT_INDEX_VALUE, Rule::not_compared, kDontCare, constant<0>},
    {GLX_TRANSPARENT_RED_VALUE, Rule::not_compared, kDontCare, constant<0>},
    {GLX_TRANSPARENT_GREEN_VALUE, Rule::not_compared, kDontCare, constant<0>},
    {GLX_TRANSPARENT_BLUE_VALUE, Rule::not_compared, kDontCare, constant<0>},
    {GLX_TRANSPARENT_ALPHA_VALUE, Rule::not_compared, kDontCare, constant<0>},
    {GLX_MAX_PBUFFER_WIDTH, Rule::not_compared, kDontCare, [](const FbConfig&) { return largest_side(); }},
    {GLX_MAX_PBUFFER_HEIGHT, Rule::not_compared, kDontCare, [](const FbConfig&) { return largest_side(); }},
    {GLX_MAX_PBUFFER_PIXELS, Rule::not_compared, kDontCare,
     [](const FbConfig&) { return largest_side() * largest_side(); }},
    {GLX_VISUAL_ID, Rule::not_compared, kDontCare,
     [](const FbConfig& c) { return static_cast<int>(c.format.visual.visualid); }},
};

XVisualInfo* visual_of(Display* display, const FbConfig& config) {
  XVisualInfo wanted{};
  wanted.screen = config.screen;
  wanted.visualid = config.format.visual.visualid;
  int count = 0;
  return XGetVisualInfo(display, VisualScreenMask | VisualIDMask, &wanted, &count);
}

std::vector<const FbConfig*> matching(Display* display, int screen, const Wishes& wishes) {
  std::vector<const FbConfig*> result;
  for (const FbConfig& config : fb_configs(display, screen))
    if (fits(kAttributes, config, wishes, GLX_FBCONFIG_ID)) result.push_back(&config);
  return result;
}

const FbConfig* find_config(Display* display, const XVisualInfo* visual) {
  if (visual != nullptr)
    for (const FbConfig& config : fb_configs(display, visual->screen))
      if (config.format.visual.visualid == visual->visualid && !config.shares_visual) return &config;
  return nullptr;
}

GLXFBConfig* handles(const std::vector<const FbConfig*>& configs, int* count) {
  *count = static_cast<int>(configs.size());
  if (configs.empty()) return nullptr;
  auto* const result = static_cast<GLXFBConfig*>(Xmalloc(sizeof(GLXFBConfig) * configs.size()));
  if (result != nullptr) std::ranges::transform(configs, result, &FbConfig::handle);
  return result;
}

XVisualInfo* choose_visual(Display* display, int screen, int* list) {
  Wishes wishes = defaults(kAttributes);
  wishes[GLX_DOUBLEBUFFER] = 0;
  bool rgba = false;
  for (; list != nullptr && *list != 0; ++list) switch (*list) {
      case GLX_USE_GL: break;
      case GLX_RGBA: rgba = true; break;
      case GLX_DOUBLEBUFFER:
      case GLX_STEREO: wishes[*list] = 1; break;
      default:
        if (!wishes.contains(list[0])) return nullptr;
        wishes[list[0]] = list[1];
        ++list;
    }
  if (!rgba) return nullptr;  // there are no colour indices
  for (const FbConfig* config : matching(display, screen, wishes))
    if (!config->shares_visual) return visual_of(display, *config);
  return nullptr;
}

GLXFBConfig* choose_fb_config(Display* display, int screen, const int* list, int* count) {
  Wishes wishes = defaults(kAttributes);
  *count = 0;
  return read_list<0>(list, wishes) ? handles(matching(display, screen, wishes), count) : nullptr;
}

GLXFBConfig* get_fb_configs(Display* display, int screen, int* count) {
  std::vector<const FbConfig*> all;
  for (const FbConfig& config : fb_configs(display, screen)) all.push_back(&config);
  return handles(all, count);
}

int get_attribute(const FbConfig& config, int name, int* value) {
  const auto* const a = find_attribute(kAttributes, name);
  if (a == nullptr) return GLX_BAD_ATTRIBUTE;
  *value = a->value(config);
  return 0;
}

int get_fb_config_attrib(Display* display, GLXFBConfig handle, int name, int* value) {
  return get_attribute(config_of(display, handle), name, value);
}

XVisualInfo* get_visual_from_fb_config(Display* display, GLXFBConfig handle) {
  return visual_of(display, config_of(display, handle));
}

int get_config(Display* display, XVisualInfo* visual, int name, int* value) {
  const FbConfig* const config = find_config(display, visual);
  if (name == GLX_USE_GL || (config != nullptr && name == GLX_RGBA)) {
    *value = config != nullptr ? 1 : 0;
    return 0;
  }
  return config == nullptr ? GLX_BAD_VISUAL : get_attribute(*config, name, value);
}

}  // namespace

Server* server_of(Display* display) { return Server::open(DisplayString(display)); }

/// The single-buffered ones come first: they differ in nothing else that glXChooseFBConfig() sorts by but their number.
const std::vector<FbConfig>& fb_configs(Display* display, int screen) {
  static std::mutex mutex;
  static auto* const all = new std::map<std::pair<Server*, int>, std::vector<FbConfig>>;  // handles point into it
  const std::lock_guard lock(mutex);
  Server* const server = server_of(display);
  std::vector<FbConfig>& configs = (*all)[{server, screen}];
  if (!configs.empty() || server == nullptr || screen < 0 || screen >= server->screens()) return configs;
  std::set<VisualID> seen;
  for (const PixelFormat& format : server->formats(screen))
    configs.push_back(
        {server, screen, static_cast<int>(configs.size()) + 1, format, !seen.insert(format.visual.visualid).second});
  std::ranges::stable_sort(configs, {}, [](const FbConfig& c) { return c.format.double_buffered; });
  return configs;
}

const FbConfig& config_of(Display* display, GLXFBConfig handle) {
  for (int screen = 0; screen < ScreenCount(display); ++screen)
    for (const FbConfig& config : fb_configs(display, screen))
      if (config.handle() == handle) return config;
  glx_error(GLXBadFBConfig);
}

const FbConfig& config_of(Display* display, const XVisualInfo* visual) {
  const FbConfig* const config = find_config(display, visual);
  if (config == nullptr) x_error(BadValue);
  return *config;
}

std::span<const Named> config_functions() {
  static const Named table[] = {
      {"glXChooseFBConfig", address(choose_fb_config)},
      {"glXChooseVisual", address(choose_visual)},
      {"glXGetConfig", address(get_config)},
      {"glXGetFBConfigAttrib", entry<get_fb_config_attrib, X_GLXGetFBConfigs, GLX_BAD_ATTRIBUTE>()},
      {"glXGetFBConfigs", address(get_fb_configs)},
      {"glXGetVisualFromFBConfig", entry<get_visual_from_fb_config, X_GLXGetFBConfigs>()},
  };
  return table;
}

}  // namespace halfplane::gl::glx
