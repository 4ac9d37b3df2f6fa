// Shapes side by side, each as large as its tile.
#pragma once

#include <string>

#include "codec/common/base/sequence.h"
#include "tools/picture/image.h"
#include "tools/picture/render.h"

namespace reeb::tools {

struct ResultSheetOptions {
  int tile = 200;  ///< pixels, both ways
  int columns = 6;
  Camera camera = Camera::orbit(35, 12, false);
};

class ResultSheet {
 public:
  explicit ResultSheet(const ResultSheetOptions& options) : options_(options) {}

  /// Draws frame `frame` (from 0) with a caption under it.
  void add(const std::string& caption, const Sequence& sequence, uint32_t frame);

  /// All that was added, in rows.
  Image image() const;

 private:
  ResultSheetOptions options_;
  std::vector<Image> tiles_;
};

}  // namespace reeb::tools
