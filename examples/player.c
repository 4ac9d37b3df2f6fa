/* player FILE [LOOPS [MIB]]: the loop of a player, without its window. Opens a .reeb file so that
 * only the groups at hand are in memory, plays it forwards, then once backwards, and tells how it
 * went. MIB: what the decoder may take. */
#include <reeb.h>
#include <stdio.h>
#include <stdlib.h>

static int read_at(void* user, uint64_t offset, void* buffer, size_t size) {
  FILE* file = user;
  if (fseek(file, (long)offset, SEEK_SET) != 0) return 1;
  return fread(buffer, 1, size, file) == size ? 0 : 1;
}

static void print_log(void* user, reeb_log_level level, const char* message) {
  (void)user;
  fprintf(stderr, "player: %s: %s\n", level == REEB_LOG_ERROR ? "error" : "warning", message);
}

/* What a player would hand to the graphics card. */
static void draw(const reeb_target* target, const uint32_t* indices, size_t triangle_count) {
  (void)target;
  (void)indices;
  (void)triangle_count;
}

static reeb_result show(reeb_decoder* decoder, uint32_t frame, const reeb_target* target) {
  const uint32_t* indices = NULL;
  size_t triangle_count = 0;
  reeb_result result = reeb_get_triangles(decoder, frame, &indices, &triangle_count);
  if (result == REEB_OK) result = reeb_get_frame(decoder, frame, target);
  if (result == REEB_OK) draw(target, indices, triangle_count);
  return result == REEB_CORRUPT ? REEB_OK : result; /* a damaged group: the pose before stays */
}

static reeb_result play(reeb_decoder* decoder, long loops, const reeb_target* target) {
  reeb_info info = {.struct_size = sizeof info};
  reeb_result result = reeb_get_info(decoder, &info);
  reeb_set_loop(decoder, loops > 1);
  for (long loop = 0; loop < loops; ++loop)
    for (uint32_t frame = 0; result == REEB_OK && frame < info.frame_count; ++frame)
      result = show(decoder, frame, target);
  for (uint32_t frame = info.frame_count; result == REEB_OK && frame-- > 0;)
    result = show(decoder, frame, target);
  return result;
}

static void report(reeb_decoder* decoder) {
  reeb_stats stats = {.struct_size = sizeof stats};
  if (reeb_get_stats(decoder, &stats) != REEB_OK) return;
  printf(
      "%llu frames, %llu groups decoded, %llu of them ahead; longest stall %.1f ms at frame %u; "
      "%.1f MB at most\n",
      (unsigned long long)stats.frames, (unsigned long long)stats.groups_decoded,
      (unsigned long long)stats.groups_ahead, 1000 * stats.longest_stall,
      stats.longest_stall_frame + 1, (double)stats.peak_memory / 1e6);
}

static reeb_result run(FILE* file, uint64_t size, long loops, uint64_t max_memory) {
  const reeb_reader reader = {size, read_at, file};
  reeb_options options = {.struct_size = sizeof options};
  options.prefetch = 1;
  options.limits.max_memory = max_memory;
  options.log = print_log;
  reeb_decoder* decoder = NULL;
  reeb_result result = reeb_open_reader(&reader, &options, &decoder);
  if (result != REEB_OK) return result;
  reeb_info info = {.struct_size = sizeof info};
  result = reeb_get_info(decoder, &info);
  reeb_target target = {.struct_size = sizeof target};
  target.vertex_capacity = info.max_vertices;
  target.positions = malloc((size_t)info.max_vertices * 3 * sizeof(float));
  if (target.positions == NULL) result = REEB_OUT_OF_MEMORY;
  if (result == REEB_OK) result = play(decoder, loops, &target);
  if (result == REEB_OK) report(decoder);
  free(target.positions);
  reeb_close(decoder);
  return result;
}

int main(int argc, char** argv) {
  if (argc < 2) {
    fputs("usage: player FILE [LOOPS [MIB]]\n", stderr);
    return 2;
  }
  FILE* file = fopen(argv[1], "rb");
  if (file == NULL || fseek(file, 0, SEEK_END) != 0) {
    perror(argv[1]);
    return 1;
  }
  const long loops = argc > 2 ? atol(argv[2]) : 1;
  const uint64_t mebibytes = argc > 3 ? (uint64_t)atol(argv[3]) : 256;
  const reeb_result result = run(file, (uint64_t)ftell(file), loops, mebibytes << 20);
  fclose(file);
  if (result != REEB_OK) fprintf(stderr, "player: %s: %s\n", argv[1], reeb_result_string(result));
  return result == REEB_OK ? 0 : 1;
}
