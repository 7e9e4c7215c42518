// A program that draws into windows, as `halfplane run` starts it under an X server. Exit status: the number of the check that
// does not hold, 0 where all do.
#include <GL/gl.h>
#include <GL/glx.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <cstdio>
#include <initializer_list>

namespace {

int g_errors = 0;

struct Screen {
  Display* display = XOpenDisplay(nullptr);
  XVisualInfo* visual = nullptr;
  Colormap colors = 0;

  [[nodiscard]] Window window(int width, int height) const {
    XSetWindowAttributes attributes{};
    attributes.colormap = colors;
    const Window made = XCreateWindow(display, DefaultRootWindow(display), 0, 0, static_cast<unsigned>(width),
                                      static_cast<unsigned>(height), 0, visual->depth, InputOutput, visual->visual,
                                      CWColormap | CWBorderPixel, &attributes);
    XMapWindow(display, made);
    return made;
  }

  /// The pixel at (x, y), from the top left, that the server shows.
  [[nodiscard]] unsigned long shown(Window window, int x, int y) const {
    XImage* const image = XGetImage(display, window, x, y, 1, 1, AllPlanes, ZPixmap);
    if (image == nullptr) return ~0UL;
    const unsigned long pixel = XGetPixel(image, 0, 0) & 0xffffff;
    XDestroyImage(image);
    return pixel;
  }
};

void clear(float r, float g, float b) {
  glClearColor(r, g, b, 1);
  glClear(GL_COLOR_BUFFER_BIT);
}

int check() {
  Screen screen;
  if (screen.display == nullptr) return 1;
  int wishes[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_RED_SIZE, 8, None};
  screen.visual = glXChooseVisual(screen.display, DefaultScreen(screen.display), wishes);
  if (screen.visual == nullptr) return 2;
  screen.colors = XCreateColormap(screen.display, DefaultRootWindow(screen.display), screen.visual->visual, AllocNone);
  const GLXContext context = glXCreateContext(screen.display, screen.visual, nullptr, True);
  const Window first = screen.window(60, 40);
  if (glXMakeCurrent(screen.display, first, context) == False) return 3;

  // Each picture is seen once the program has waited for it, also when the next one is drawn at once.
  for (const float red : {0.F, 1.F}) {
    clear(red, 0, 0);
    glXSwapBuffers(screen.display, first);
  }
  glXWaitGL();
  if (screen.shown(first, 59, 39) != 0xff0000) return 4;

  // A window takes its new size at a swap, and at once where the program lets the server know first.
  for (const int side : {90, 30, 120}) {
    XResizeWindow(screen.display, first, static_cast<unsigned>(side), static_cast<unsigned>(side));
    XSync(screen.display, False);
    glXSwapBuffers(screen.display, first);
    clear(0, 1, 0);
    unsigned char corner[4] = {};
    glReadPixels(side - 1, side - 1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, corner);
    if (corner[1] != 255) return 5;
    glXSwapBuffers(screen.display, first);
    glFinish();
    if (screen.shown(first, side - 1, side - 1) != 0x00ff00) return 6;
  }

  // A window that is gone ends nothing, and what the server says of it reaches no handler of the program's.
  XDestroyWindow(screen.display, first);
  XSync(screen.display, False);
  for (int i = 0; i < 3; ++i) {
    clear(0, 0, 1);
    glXSwapBuffers(screen.display, first);
    glFinish();
  }
  if (g_errors != 0) return 7;

  const Window second = screen.window(20, 20);
  if (glXMakeCurrent(screen.display, second, context) == False) return 8;
  clear(0, 0, 1);
  glXSwapBuffers(screen.display, second);
  glXWaitGL();
  return screen.shown(second, 10, 10) == 0x0000ff ? 0 : 9;
}

}  // namespace

int main() {
  XSetErrorHandler([](Display*, XErrorEvent*) { return ++g_errors; });
  const int failed = check();
  if (failed != 0) std::printf("check %d\n", failed);
  return failed;
}
