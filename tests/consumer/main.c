/* What a stranger writes in C: a triangle, drawn through the installed shared library. */
#include <halfplane.h>
#include <stdio.h>
#include <string.h>

int main(void) {
  const char* text =
      "halfplane 1\ntarget 8 8\nspace window\nclear color 0 0 0 255 depth 1\nv 0 0 0\nv 8 0 0\nv 0 8 0\nt 0 1 2\n";
  halfplane_config* config = halfplane_config_new("tiny");
  halfplane_scene* scene = halfplane_scene_read(text, strlen(text));
  halfplane_frame* frame = halfplane_render(scene, config, "functional");
  if (frame == NULL) {
    fprintf(stderr, "%s\n", halfplane_last_error());
    return 1;
  }
  const long long covered = halfplane_frame_counter(frame, "covered");
  halfplane_frame_free(frame);
  halfplane_scene_free(scene);
  halfplane_config_free(config);
  printf("%lld pixels\n", covered);
  return covered == 28 ? 0 : 1;
}
