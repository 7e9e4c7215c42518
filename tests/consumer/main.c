/* What a stranger writes in C: a triangle, drawn through the installed shared library; and what the hardware writes for it. */
#include <halfplane.h>
#include <stdio.h>
#include <string.h>

/* Pixels that the hardware writes for a scene: a scoreboard compares each event with its design's. -1: something failed. */
static long long pixels_written(const halfplane_config* config, const halfplane_scene* scene) {
  uint32_t packet[64], line[64];
  long long pixels = 0;
  halfplane_event event;
  halfplane_host* host = halfplane_host_new(scene, config);
  halfplane_pipeline* model = halfplane_pipeline_new(config, halfplane_config_id(config), HALFPLANE_WRITES);
  while (halfplane_host_next(host, packet, line) > 0 && halfplane_pipeline_put_primitive(model, packet) == 0)
    while (halfplane_pipeline_get_event(model, &event) == 1) pixels += event.x < 8 && event.y < 8 - event.x;
  if (*halfplane_last_error() != '\0') pixels = -1;
  halfplane_pipeline_free(model);
  halfplane_host_free(host);
  return pixels;
}

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
  const long long covered = halfplane_frame_counter(frame, "covered"), written = pixels_written(config, scene);
  halfplane_frame_free(frame);
  halfplane_scene_free(scene);
  halfplane_config_free(config);
  printf("%lld pixels, %lld written by the hardware\n", covered, written);
  return covered == 28 && written == 28 ? 0 : 1;
}
