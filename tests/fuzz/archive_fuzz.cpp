// What archives of shapes and the metadata of streams hold: the first byte chooses the form, the
// rest is in it.
#include <cmath>
#include <string>

#include "tools/archive/shape_archive.h"

namespace {

using namespace reeb;
using namespace reeb::tools;

void require(bool good) {
  if (!good) __builtin_trap();
}

// It is as good as one that was computed: written and compared.
void check(const retrieval::Signature& signature) {
  retrieval::Signature back;
  require(retrieval::from_bytes(to_bytes(signature), back));
  require(to_bytes(back) == to_bytes(signature));
  if (signature.empty()) return;
  const retrieval::ShapeDistance d = shape_distance(signature, back);
  require(std::isfinite(d.total) && d.total >= 0);
}

void read_whole(std::string_view bytes, const char* name) {
  ShapeArchive archive;
  if (!parse_archive(bytes, name, archive).ok()) return;
  for (const ArchivedFile& file : archive.files) {
    for (const SignedFrame& shape : file.shapes) check(shape.signature);
  }
  ShapeArchive back;
  require(parse_archive(write_archive(archive, name), name, back).ok());
  require(back.files.size() == archive.files.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  retrieval::Signature signature;
  std::vector<SignedFrame> frames;
  switch (data[0] % 4) {
    case 0:
      if (retrieval::from_bytes({data + 1, size - 1}, signature)) check(signature);
      break;
    case 1:
      if (parse_stored(std::string(text), frames)) check(frames.front().signature);
      break;
    case 2:
      read_whole(text, "x.json");
      break;
    default:
      read_whole(text, "x.reebi");
  }
  return 0;
}
