// A program that draws through OpenGL without a screen, as `halfplane run` starts it: egl_program FRAMES [EXIT_STATUS].
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>

#include <cstdio>
#include <cstdlib>

int main(int count, char** words) {
  constexpr int kFailed = 9;
  EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  const EGLint wishes[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  const EGLint size[] = {EGL_WIDTH, 64, EGL_HEIGHT, 48, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint configs = 0;
  if (eglInitialize(display, nullptr, nullptr) == EGL_FALSE || eglBindAPI(EGL_OPENGL_API) == EGL_FALSE ||
      eglChooseConfig(display, wishes, &config, 1, &configs) == EGL_FALSE || configs == 0)
    return kFailed;
  EGLSurface surface = eglCreatePbufferSurface(display, config, size);
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr);
  if (eglMakeCurrent(display, surface, surface, context) == EGL_FALSE) return kFailed;
  glEnable(GL_DEPTH_TEST);
  for (int i = 0; i < (count > 1 ? std::atoi(words[1]) : 1); ++i) {
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glRotatef(10, 0, 0, 1);
    glBegin(GL_TRIANGLES);
    glColor3f(1, 0, 0), glVertex2f(-0.8F, -0.7F);
    glColor3f(0, 1, 0), glVertex2f(0.8F, -0.7F);
    glColor3f(0, 0, 1), glVertex4f(0, 1.6F, 0, 2);
    glEnd();
    eglSwapBuffers(display, surface);
  }
  unsigned char pixel[4] = {};
  glReadPixels(32, 24, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
  std::printf("%s\n", reinterpret_cast<const char*>(glGetString(GL_VERSION)));
  return count > 2 ? std::atoi(words[2]) : 0;
}
