// Signatures of many shapes in one file, for `reeb search`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bitstream/status.h"
#include "retrieval/shape_distance.h"
#include "tools/archive/stored_signature.h"

namespace reeb::tools {

struct ArchivedFile {
  std::string path;                 ///< absolute
  uint64_t size = 0;                ///< bytes of the file when it was signed, and
  int64_t modified = 0;             ///< its time of change: a file is signed anew where one differs
  std::vector<SignedFrame> shapes;  ///< none where nothing could be signed
};

struct ShapeArchive {
  std::vector<ArchivedFile> files;  ///< sorted by path
};

/// JSON, or the same as CBOR (RFC 8949) where the name ends in .reebi.
std::string write_archive(const ShapeArchive& archive, const std::filesystem::path& name);
Status read_archive(const std::filesystem::path& name, ShapeArchive& out);
/// The bytes of the file of that name.
Status parse_archive(std::string_view bytes, const std::filesystem::path& name, ShapeArchive& out);

struct SearchResult {
  size_t file = 0;
  uint32_t frame = 1;  ///< of the file's shapes, the one most like the query
  retrieval::ShapeDistance distance;
};

/// Which part of a distance ranks.
enum class RankBy { kAll, kCharts, kSpectrum, kBody };
double ranked_distance(const retrieval::ShapeDistance& distance, RankBy by);

/// Files from the most like to the least, at most `count`.
std::vector<SearchResult> search_archive(const ShapeArchive& archive,
                                         const retrieval::Signature& query, RankBy by,
                                         size_t count);

}  // namespace reeb::tools
