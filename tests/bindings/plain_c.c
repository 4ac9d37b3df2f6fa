/* The headers in plain C99: every function of reeb.h once, some of reeb_attributes.h. Returns the
 * line of the first surprise, or 0. */
#include <reeb.h>
#include <reeb_attributes.h>
#include <stdlib.h>
#include <string.h>

#define EXPECT(x) \
  if (!(x)) return __LINE__

int use_reeb_from_c(const void* bytes, size_t size);

static int use(reeb_decoder* decoder) {
  reeb_info info = {.struct_size = sizeof info};
  EXPECT(reeb_get_info(decoder, &info) == REEB_OK);
  EXPECT(info.frame_count == 8 && info.shot_count == 2 && info.group_count == 3);
  EXPECT(info.max_vertices == 48 && info.frame_rate == 25 && !info.truncated &&
         info.gap_count == 0);
  reeb_shot shot = {.struct_size = sizeof shot};
  EXPECT(reeb_get_shot(decoder, 1, &shot) == REEB_OK && shot.first_frame == 6);
  EXPECT(reeb_get_shot(decoder, 2, &shot) == REEB_INVALID_ARGUMENT);
  reeb_group group = {.struct_size = sizeof group};
  EXPECT(reeb_get_group(decoder, 1, &group) == REEB_OK && group.first_frame == 3);
  EXPECT(reeb_get_group(decoder, 3, &group) == REEB_INVALID_ARGUMENT);
  uint32_t first, count;
  EXPECT(reeb_get_gap(decoder, 0, &first, &count) == REEB_INVALID_ARGUMENT);
  const char *key = NULL, *value = NULL;
  EXPECT(reeb_get_metadata(decoder, 0, &key, &value) == REEB_OK && strcmp(key, "name") == 0);
  EXPECT(strcmp(reeb_find_metadata(decoder, "unit"), "cm") == 0);
  EXPECT(reeb_find_metadata(decoder, "colour") == NULL);
  const uint32_t* indices = NULL;
  size_t triangles = 0;
  EXPECT(reeb_get_triangles(decoder, 0, &indices, &triangles) == REEB_OK && triangles == 96);
  EXPECT(reeb_get_attribute_count(decoder, &count) == REEB_OK && count == 0);
  reeb_render_mesh* mesh = NULL;
  EXPECT(reeb_make_render_mesh(decoder, 0, NULL, 0, &mesh) == REEB_OK);
  reeb_render_info parts = {.struct_size = sizeof parts};
  EXPECT(reeb_get_render_info(mesh, &parts) == REEB_OK && parts.vertex_count == 48);
  EXPECT(parts.material_attribute == -1 && parts.range_count == 1);
  reeb_free_render_mesh(mesh);
  float xyz[48 * 3], normals[48 * 3];
  reeb_target target = {.struct_size = sizeof target};
  target.positions = xyz;
  target.normals = normals;
  target.vertex_capacity = 48;
  EXPECT(reeb_get_frame(decoder, 7, &target) == REEB_OK);
  EXPECT(reeb_get_between(decoder, 2.5, &target) == REEB_OK);
  double position = 0;
  EXPECT(reeb_position_of_time(decoder, 0.1, 0, &position) == REEB_OK && position == 2.5);
  reeb_set_loop(decoder, 1);
  reeb_cancel(decoder);
  reeb_stats stats = {.struct_size = sizeof stats};
  EXPECT(reeb_get_stats(decoder, &stats) == REEB_OK && stats.frames == 2);
  reeb_reset_stats(decoder);
  EXPECT(reeb_push(decoder, "", 0) == REEB_INVALID_ARGUMENT);
  EXPECT(reeb_push_end(decoder) == REEB_INVALID_ARGUMENT);
  char message[20];
  EXPECT(reeb_get_message(decoder, message, sizeof message) > 20 && strlen(message) == 19);
  return 0;
}

int use_reeb_from_c(const void* bytes, size_t size) {
  reeb_options options = {.struct_size = sizeof options};
  reeb_decoder* decoder = NULL;
  EXPECT(reeb_version() ==
         REEB_VERSION_MAJOR * 1000000 + REEB_VERSION_MINOR * 1000 + REEB_VERSION_PATCH);
  EXPECT(strcmp(reeb_version_string(), REEB_VERSION_STRING) == 0 && reeb_format_version() == 1);
  EXPECT(reeb_probe(bytes, size) == REEB_OK);
  EXPECT(reeb_open_memory(bytes, size, &options, &decoder) == REEB_OK);
  const int line = use(decoder);
  reeb_close(decoder);
  return line;
}
