/* render_mesh FILE: what a renderer does with a .reeb file, without its window. Makes the mesh that
 * graphics interfaces take, with vertices split where texture coordinates or normals are; fills the
 * buffers that stay once and those that move every frame; tells what it would draw. */
#include <reeb_attributes.h>
#include <stdio.h>
#include <stdlib.h>

/* What would be buffers of the graphics card. */
typedef struct buffers {
  float* positions; /* every frame */
  float* normals;   /* every frame */
  void* uvs;        /* once */
} buffers;

typedef struct scene {
  reeb_decoder* decoder;
  uint32_t frame; /* first of the shot */
  reeb_render_mesh* mesh;
  reeb_render_info info;
  int has_normals, has_uvs; /* in the file */
  reeb_attribute normals, uvs;
} scene;

/* The attribute of the shot that means this; 0 where there is none. */
static int find(scene* s, reeb_semantic semantic, reeb_attribute* out) {
  uint32_t index = 0, count = 0;
  reeb_shot shot = {.struct_size = sizeof shot};
  if (reeb_find_semantic(s->decoder, s->frame, semantic, &index) != REEB_OK) return 0;
  if (reeb_get_attribute_count(s->decoder, &count) != REEB_OK) return 0;
  for (uint32_t i = 0; i < count; ++i) {
    out->struct_size = sizeof *out;
    if (reeb_get_attribute(s->decoder, i, out) != REEB_OK || out->index != index) continue;
    if (reeb_get_shot(s->decoder, out->shot, &shot) != REEB_OK) continue;
    if (shot.first_frame == s->frame) return 1;
  }
  return 0;
}

static size_t bytes_of(const reeb_attribute* a) {
  const size_t number = a->type == REEB_TYPE_BINARY32 || a->type == REEB_TYPE_I32         ? 4
                        : a->type == REEB_TYPE_U16 || a->type == REEB_TYPE_U16_NORMALISED ? 2
                                                                                          : 1;
  return number * a->channels;
}

static reeb_result make_mesh(scene* s) {
  uint32_t split_by[2];
  size_t count = 0;
  s->has_normals = find(s, REEB_SEMANTIC_NORMAL, &s->normals) && s->normals.channels == 3 &&
                   s->normals.type == REEB_TYPE_BINARY32;
  s->has_uvs = find(s, REEB_SEMANTIC_TEXTURE_COORDINATE, &s->uvs);
  if (s->has_normals) split_by[count++] = s->normals.index;
  if (s->has_uvs) split_by[count++] = s->uvs.index;
  reeb_result result = reeb_make_render_mesh(s->decoder, s->frame, split_by, count, &s->mesh);
  s->info.struct_size = sizeof s->info;
  return result == REEB_OK ? reeb_get_render_info(s->mesh, &s->info) : result;
}

static void print_ranges(const scene* s) {
  for (size_t r = 0; r < s->info.range_count; ++r) {
    int64_t material = 0;
    size_t first = 0, count = 0;
    char name[64] = "";
    if (reeb_get_render_range(s->mesh, r, &material, &first, &count) != REEB_OK) continue;
    if (s->info.material_attribute >= 0 && material >= 0)
      (void)reeb_get_name(s->decoder, s->frame, (uint32_t)s->info.material_attribute,
                          (uint32_t)material, name, sizeof name, NULL);
    printf("  triangles %zu to %zu: material %lld \"%s\"\n", first, first + count - 1,
           (long long)material, name);
  }
}

static reeb_result upload_frame(const scene* s, uint32_t frame, const buffers* b) {
  reeb_target target = {.struct_size = sizeof target};
  target.positions = b->positions;
  target.normals = s->has_normals ? NULL : b->normals; /* smooth ones, where the file has none */
  target.vertex_capacity = s->info.vertex_count;
  reeb_result result = reeb_get_render_frame(s->decoder, frame, s->mesh, &target);
  if (result != REEB_OK || !s->has_normals) return result;
  const reeb_value_target normals = {sizeof normals, b->normals, 0, s->info.vertex_count};
  return reeb_get_render_values(s->decoder, frame, s->normals.index, s->mesh, &normals);
}

static reeb_result play_shot(const scene* s, uint32_t frame_count) {
  const size_t n = s->info.vertex_count;
  buffers b = {malloc(n * 3 * sizeof(float) + 1), malloc(n * 3 * sizeof(float) + 1), NULL};
  if (s->has_uvs) b.uvs = malloc(n * bytes_of(&s->uvs) + 1);
  reeb_result result = REEB_OK;
  if (!b.positions || !b.normals || (s->has_uvs && !b.uvs)) result = REEB_OUT_OF_MEMORY;
  const reeb_value_target uvs = {sizeof uvs, b.uvs, 0, n};
  if (result == REEB_OK && s->has_uvs)
    result = reeb_get_render_values(s->decoder, s->frame, s->uvs.index, s->mesh, &uvs);
  for (uint32_t t = 0; t < frame_count && result == REEB_OK; ++t)
    result = upload_frame(s, s->frame + t, &b); /* and here it is drawn */
  free(b.positions);
  free(b.normals);
  free(b.uvs);
  return result;
}

static reeb_result show_shot(reeb_decoder* decoder, uint32_t index) {
  scene s = {.decoder = decoder};
  reeb_shot shot = {.struct_size = sizeof shot};
  reeb_result result = reeb_get_shot(decoder, index, &shot);
  s.frame = shot.first_frame;
  if (result == REEB_OK) result = make_mesh(&s);
  if (result == REEB_OK) {
    printf("shot %u: %u vertices as %u, %zu triangles, %s normals, %s texture coordinates\n",
           index + 1, shot.vertex_count, s.info.vertex_count, s.info.triangle_count,
           s.has_normals ? "the file's" : "smooth", s.has_uvs ? "with" : "no");
    print_ranges(&s);
    result = play_shot(&s, shot.frame_count);
  }
  reeb_free_render_mesh(s.mesh);
  return result;
}

static reeb_result show(const void* bytes, size_t size) {
  reeb_decoder* decoder = NULL;
  reeb_result result = reeb_open_memory(bytes, size, NULL, &decoder);
  reeb_info info = {.struct_size = sizeof info};
  if (result == REEB_OK) result = reeb_get_info(decoder, &info);
  for (uint32_t shot = 0; shot < info.shot_count && result == REEB_OK; ++shot)
    result = show_shot(decoder, shot);
  reeb_close(decoder);
  return result;
}

int main(int argc, char** argv) {
  FILE* file = argc == 2 ? fopen(argv[1], "rb") : NULL;
  if (file == NULL || fseek(file, 0, SEEK_END) != 0) {
    fputs("usage: render_mesh FILE\n", stderr);
    return 2;
  }
  const long size = ftell(file);
  void* bytes = malloc((size_t)size + 1);
  rewind(file);
  const int read = bytes != NULL && fread(bytes, 1, (size_t)size, file) == (size_t)size;
  fclose(file);
  const reeb_result result = read ? show(bytes, (size_t)size) : REEB_IO;
  free(bytes);
  if (result != REEB_OK)
    fprintf(stderr, "render_mesh: %s: %s\n", argv[1], reeb_result_string(result));
  return result == REEB_OK ? 0 : 1;
}
