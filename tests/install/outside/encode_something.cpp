// Encodes three frames of a tetrahedron with the installed encoder.
#include <cstdio>

#include "codec/enc/encoder.h"

int main() {
  reeb::Shot shot;
  shot.connectivity = {4, {3, 3, 3, 3}, {0, 1, 2, 0, 3, 1, 1, 3, 2, 0, 2, 3}};
  shot.frame_count = 3;
  for (int t = 0; t < 3; ++t) {
    const float s = 1.0f + 0.1f * static_cast<float>(t);
    shot.positions.insert(shot.positions.end(), {0, 0, 0, s, 0, 0, 0, s, 0, 0, 0, s});
  }
  reeb::Sequence sequence;
  sequence.shots.push_back(shot);
  std::vector<uint8_t> bytes;
  reeb::EncodeStats stats;
  const reeb::Status status = reeb::encode(sequence, {}, bytes, stats);
  if (!status.ok()) {
    std::puts(status.message().c_str());
    return 1;
  }
  std::printf("encoded 3 frames, %zu bytes\n", bytes.size());
  return 0;
}
