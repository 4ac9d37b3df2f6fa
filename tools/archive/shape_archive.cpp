#include "tools/archive/shape_archive.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/io/file_bytes.h"

namespace reeb::tools {
namespace {

using nlohmann::json;

constexpr const char* kFormat = "reeb shape archive";
constexpr int kVersion = 1;

bool is_binary(const std::filesystem::path& name) { return name.extension() == ".reebi"; }

json to_json(const ArchivedFile& file, bool binary) {
  json shapes = json::array();
  for (const SignedFrame& shape : file.shapes) {
    json signature =
        binary ? json::binary(to_bytes(shape.signature)) : json(signature_text(shape.signature));
    shapes.push_back({{"frame", shape.frame}, {"signature", std::move(signature)}});
  }
  return {
      {"path", file.path}, {"size", file.size}, {"modified", file.modified}, {"shapes", shapes}};
}

// Throws what the library throws where a value is missing or of another type.
bool from_json(const json& value, ArchivedFile& file) {
  value.at("path").get_to(file.path);
  value.at("size").get_to(file.size);
  value.at("modified").get_to(file.modified);
  for (const json& item : value.at("shapes")) {
    SignedFrame& shape = file.shapes.emplace_back();
    item.at("frame").get_to(shape.frame);
    const json& signature = item.at("signature");
    const bool good = signature.is_binary()
                          ? retrieval::from_bytes(signature.get_binary(), shape.signature) &&
                                !shape.signature.empty()
                          : parse_signature(signature.get<std::string>(), shape.signature);
    if (!good) return false;
  }
  return true;
}

// Refuses values that nest deeper than any of an archive: those of CBOR are read by recursion.
class ShallowParser : public nlohmann::detail::json_sax_dom_parser<json> {
 public:
  using Base = nlohmann::detail::json_sax_dom_parser<json>;
  explicit ShallowParser(json& out) : Base(out, true) {}

  bool start_object(std::size_t size) { return enter() && Base::start_object(size); }
  bool start_array(std::size_t size) { return enter() && Base::start_array(size); }
  bool end_object() {
    --depth_;
    return Base::end_object();
  }
  bool end_array() {
    --depth_;
    return Base::end_array();
  }

 private:
  bool enter() { return ++depth_ <= kMaxDepth; }

  static constexpr int kMaxDepth = 8;
  int depth_ = 0;
};

// False, or throws, where the bytes are none of the format.
bool parse(std::string_view bytes, bool binary, json& root) {
  ShallowParser parser(root);
  return json::sax_parse(bytes, &parser,
                         binary ? json::input_format_t::cbor : json::input_format_t::json);
}

Status not_an_archive(const std::filesystem::path& name) {
  return Status::corrupt(name.string() + ": not an archive of shapes; make one with reeb index");
}

}  // namespace

std::string write_archive(const ShapeArchive& archive, const std::filesystem::path& name) {
  json files = json::array();
  for (const ArchivedFile& file : archive.files) files.push_back(to_json(file, is_binary(name)));
  const json root{{"format", kFormat}, {"version", kVersion}, {"files", std::move(files)}};
  if (!is_binary(name)) return root.dump(1) + "\n";
  const std::vector<uint8_t> bytes = json::to_cbor(root);
  return {bytes.begin(), bytes.end()};
}

Status read_archive(const std::filesystem::path& name, ShapeArchive& out) {
  FileBytes file;
  if (Status status = FileBytes::read(name, file); !status.ok()) return status;
  return parse_archive(file.view(), name, out);
}

Status parse_archive(std::string_view bytes, const std::filesystem::path& name, ShapeArchive& out) {
  out = {};
  try {
    json root;
    if (!parse(bytes, is_binary(name), root)) return not_an_archive(name);
    if (root.at("format") != kFormat) return not_an_archive(name);
    if (root.at("version") != kVersion) {
      return {StatusCode::kUnsupported,
              name.string() + ": an archive of a newer version; update reeb, or index anew"};
    }
    for (const json& value : root.at("files")) {
      if (!from_json(value, out.files.emplace_back())) return not_an_archive(name);
    }
  } catch (const json::exception&) {
    return not_an_archive(name);
  }
  return {};
}

double ranked_distance(const retrieval::ShapeDistance& distance, RankBy by) {
  switch (by) {
    case RankBy::kCharts:
      return distance.charts;
    case RankBy::kSpectrum:
      return distance.spectrum;
    case RankBy::kBody:
      return distance.body;
    case RankBy::kAll:
      break;
  }
  return distance.total;
}

std::vector<SearchResult> search_archive(const ShapeArchive& archive,
                                         const retrieval::Signature& query, RankBy by,
                                         size_t count) {
  const auto less = [by](const SearchResult& a, const SearchResult& b) {
    return ranked_distance(a.distance, by) < ranked_distance(b.distance, by);
  };
  std::vector<SearchResult> results;
  for (size_t f = 0; f < archive.files.size(); ++f) {
    std::vector<SearchResult> frames;
    for (const SignedFrame& shape : archive.files[f].shapes)
      frames.push_back({f, shape.frame, shape_distance(query, shape.signature)});
    const auto best = std::min_element(frames.begin(), frames.end(), less);
    if (best != frames.end()) results.push_back(*best);
  }
  std::stable_sort(results.begin(), results.end(), less);
  results.resize(std::min(results.size(), count));
  return results;
}

}  // namespace reeb::tools
