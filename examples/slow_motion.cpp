// slow_motion FILE [SPEED]: plays a .reeb file at a quarter of its speed (or another), on a screen
// of 60 frames a second that is not there: poses between the frames, with normals, around once.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <reeb.hpp>
#include <vector>

namespace {

/// Pushes the file in pieces, as a network would.
reeb_result receive(reeb::Stream& stream, const std::vector<char>& bytes) {
  constexpr size_t kPiece = 1400;
  reeb_result result = REEB_OK;
  for (size_t at = 0; at < bytes.size() && result == REEB_OK; at += kPiece)
    result = stream.push(bytes.data() + at, std::min(kPiece, bytes.size() - at));
  return result == REEB_OK ? stream.push_end() : result;
}

reeb_result play(reeb::Stream& stream, double speed, unsigned& shown) {
  const reeb_info info = stream.info();
  const double rate = info.frame_rate > 0 ? info.frame_rate : 25;
  std::vector<float> positions, normals;
  for (double position = 0; position <= info.frame_count - 1; position += rate * speed / 60) {
    const reeb_result result = stream.between(position, positions, &normals);
    if (result != REEB_OK) return result;
    ++shown;  // here a player draws
  }
  return REEB_OK;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: slow_motion FILE [SPEED]\n", stderr);
    return 2;
  }
  const double speed = argc > 2 ? std::atof(argv[2]) : 0.25;
  if (!(speed > 0)) return 2;
  std::ifstream file(argv[1], std::ios::binary);
  const std::vector<char> bytes(std::istreambuf_iterator<char>(file), {});
  reeb_options options = reeb::Stream::defaults();
  options.prefetch = 1;
  reeb::Stream stream;
  unsigned shown = 0;
  reeb_result result = stream.open_push(options);
  if (result == REEB_OK) result = receive(stream, bytes);
  if (result == REEB_OK) result = play(stream, speed, shown);
  if (result != REEB_OK) {
    std::fprintf(stderr, "slow_motion: %s: %s: %s\n", argv[1], reeb_result_string(result),
                 stream.message().c_str());
    return 1;
  }
  const reeb_stats stats = stream.stats();
  std::printf("%u poses; longest stall %.1f ms\n", shown, 1000 * stats.longest_stall);
  return 0;
}
