// The vendor library that libglvnd loads for GLX 1.4. libGLX keeps each thread's current context and which library owns an
// object; the rest is here.
#include "glx.hpp"

#include <climits>

#include "../core/entry_points.hpp"

namespace halfplane::gl::glx {

Objects& objects() {
  static Objects* const objects = new Objects;  // threads may outlive main()
  return *objects;
}

void send(Display* display, const Error& error, int minor) {
  int opcode = 0, event = 0, first_error = 0;
  if (XQueryExtension(display, "GLX", &opcode, &event, &first_error) == 0 && error.is_glx) return;
  xError sent{};
  sent.type = X_Error;
  sent.errorCode = static_cast<BYTE>(error.is_glx ? first_error + error.code : error.code);
  sent.resourceID = static_cast<CARD32>(error.resource);
  sent.minorCode = static_cast<CARD16>(minor);
  sent.majorCode = static_cast<BYTE>(opcode);
  LockDisplay(display);
  sent.sequenceNumber = static_cast<CARD16>(display->request);
  _XError(display, &sent);
  UnlockDisplay(display);
}

namespace {

constexpr char kExtensions[] =
    "GLX_ARB_create_context GLX_ARB_create_context_profile GLX_ARB_get_proc_address GLX_ARB_multisample "
    "GLX_EXT_swap_control GLX_EXT_visual_info GLX_EXT_visual_rating GLX_MESA_swap_control GLX_SGI_swap_control";

const char* get_client_string(Display*, int name) {
  return name == GLX_VENDOR       ? "Halfplane"
         : name == GLX_VERSION    ? "1.4"
         : name == GLX_EXTENSIONS ? kExtensions
                                  : nullptr;
}
const char* query_server_string(Display* display, int, int name) { return get_client_string(display, name); }
const char* query_extensions_string(Display*, int) { return kExtensions; }

// Extensions: their functions, and how libGLX finds this library for it.

void swap_interval_ext(Display* display, GLXDrawable id, int interval) {
  const std::shared_ptr<GlxDrawable> drawable = find_drawable(display, id);
  if (interval < 0) x_error(BadValue, static_cast<XID>(interval));
  if (drawable == nullptr) x_error(BadWindow, id);
  drawable->window.swap_interval = interval;
}

int swap_interval_mesa(unsigned interval) {
  if (interval > INT_MAX) return GLX_BAD_VALUE;
  if (here() == nullptr) return GLX_BAD_CONTEXT;
  here()->draw->window.swap_interval = static_cast<int>(interval);
  return 0;
}
int swap_interval_sgi(int interval) {
  return interval <= 0 ? GLX_BAD_VALUE : swap_interval_mesa(static_cast<unsigned>(interval));
}
int get_swap_interval_mesa() { return here() == nullptr ? 0 : here()->draw->window.swap_interval; }

const __GLXapiExports* g_exports = nullptr;
int g_index[4];

template <class... Args>
__GLXvendorInfo* vendor(Args...) {
  return g_exports->getCurrentDynDispatch();
}
__GLXvendorInfo* vendor(Display* display, GLXDrawable drawable, int) {
  return g_exports->vendorFromDrawable(display, drawable);
}

/// Calls extension `Slot` of the vendor that its arguments belong to.
template <int Slot, class Result, class... Args>
Result dispatch(Args... args) {
  __GLXvendorInfo* const to = vendor(args...);
  const auto found = to == nullptr ? nullptr : g_exports->fetchDispatchEntry(to, g_index[Slot]);
  return found == nullptr ? Result() : reinterpret_cast<Result (*)(Args...)>(found)(args...);
}
template <int Slot, class Result, class... Args>
void* dispatcher(Result (*)(Args...)) {
  return address(dispatch<Slot, Result, Args...>);
}

const Named* find_function(std::string_view name) {
  for (const auto table : {extension_functions(), config_functions(), drawable_functions(), context_functions()})
    if (const auto found = std::ranges::find(table, name, &Named::name); found != table.end()) return &*found;
  return nullptr;
}

std::string_view text(const GLubyte* name) { return reinterpret_cast<const char*>(name); }

Bool is_screen_supported(Display* display, int screen) { return fb_configs(display, screen).empty() ? False : True; }

void* get_proc_address(const GLubyte* name) {
  const Named* const own = find_function(text(name));
  return own != nullptr ? own->function : const_cast<void*>(entry_point(text(name)));
}

void* get_dispatch_address(const GLubyte* name) {
  const Named* const own = find_function(text(name));
  return own != nullptr ? own->dispatch : nullptr;
}

void set_dispatch_index(const GLubyte* name, int index) {
  const Named* const own = find_function(text(name));
  if (own != nullptr && own->dispatch != nullptr) g_index[own - extension_functions().data()] = index;
}

}  // namespace

std::span<const Named> extension_functions() {
  static const Named table[] = {
      {"glXSwapIntervalEXT", entry<swap_interval_ext, X_GLXVendorPrivate>(), dispatcher<0>(swap_interval_ext)},
      {"glXSwapIntervalMESA", address(swap_interval_mesa), dispatcher<1>(swap_interval_mesa)},
      {"glXSwapIntervalSGI", address(swap_interval_sgi), dispatcher<2>(swap_interval_sgi)},
      {"glXGetSwapIntervalMESA", address(get_swap_interval_mesa), dispatcher<3>(get_swap_interval_mesa)},
      {"glXGetClientString", address(get_client_string)},
      {"glXQueryExtensionsString", address(query_extensions_string)},
      {"glXQueryServerString", address(query_server_string)},
  };
  return table;
}

}  // namespace halfplane::gl::glx

extern "C" __attribute__((visibility("default"))) Bool __glx_Main(uint32_t version, const __GLXapiExports* exports,
                                                                  __GLXvendorInfo*, __GLXapiImports* imports) {
  namespace glx = halfplane::gl::glx;
  if (GLX_VENDOR_ABI_GET_MAJOR_VERSION(version) != GLX_VENDOR_ABI_MAJOR_VERSION || !halfplane::gl::answers("GLX"))
    return False;
  glx::g_exports = exports;
  imports->isScreenSupported = glx::is_screen_supported;
  imports->getProcAddress = glx::get_proc_address;
  imports->getDispatchAddress = glx::get_dispatch_address;
  imports->setDispatchIndex = glx::set_dispatch_index;
  return True;
}
