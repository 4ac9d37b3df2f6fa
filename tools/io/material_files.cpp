#include "tools/io/material_files.h"

#include <algorithm>
#include <array>
#include <utility>

#include "bitstream/utf8.h"
#include "tools/io/attribute_values.h"
#include "tools/io/file_bytes.h"
#include "tools/io/mesh_file.h"
#include "tools/io/text_cursor.h"
#include "tools/text.h"

namespace reeb::tools {
namespace {

namespace fs = std::filesystem;

/// So many bytes of a file are taken along.
constexpr size_t kMaxBytes = size_t{1} << 30;

constexpr std::array kMediaTypes{
    std::pair{".mtl", "model/mtl"},   std::pair{".png", "image/png"},
    std::pair{".jpg", "image/jpeg"},  std::pair{".jpeg", "image/jpeg"},
    std::pair{".gif", "image/gif"},   std::pair{".bmp", "image/bmp"},
    std::pair{".tif", "image/tiff"},  std::pair{".tiff", "image/tiff"},
    std::pair{".tga", "image/x-tga"}, std::pair{".dds", "image/vnd-ms.dds"},
    std::pair{".webp", "image/webp"}, std::pair{".ktx2", "image/ktx2"}};

std::string media_type(const fs::path& name) {
  const std::string extension = lower_extension(name);
  for (const auto& [ending, type] : kMediaTypes) {
    if (extension == ending) return type;
  }
  return "application/octet-stream";
}

constexpr std::array kImages{".png", ".jpg", ".jpeg", ".tga", ".bmp",  ".tif", ".tiff",
                             ".gif", ".dds", ".hdr",  ".exr", ".webp", ".ktx2"};

/// False where a link leads out of the folder.
bool is_within(const fs::path& folder, const fs::path& path) {
  std::error_code failed;
  const fs::path root = fs::canonical(folder, failed);
  if (failed) return false;
  const fs::path real = fs::canonical(path, failed);
  return !failed &&
         std::mismatch(root.begin(), root.end(), real.begin(), real.end()).first == root.end();
}

/// Options of a texture statement, and how many words follow each at most.
constexpr std::array kTextureOptions{
    std::pair{"-blendu", 1}, std::pair{"-blendv", 1}, std::pair{"-cc", 1},
    std::pair{"-clamp", 1},  std::pair{"-bm", 1},     std::pair{"-boost", 1},
    std::pair{"-mm", 2},     std::pair{"-o", 3},      std::pair{"-s", 3},
    std::pair{"-t", 3},      std::pair{"-texres", 1}, std::pair{"-imfchan", 1},
    std::pair{"-type", 1}};

// Behind the options of a texture statement.
std::string file_name(TextCursor& in) {
  in.skip_blanks();
  while (in.peek() == '-') {
    const std::string_view option = in.word();
    int most = 0;
    for (const auto& [name, words] : kTextureOptions) {
      if (option == name) most = words;
    }
    for (int i = 0; i < most; ++i) {
      in.skip_blanks();
      TextCursor ahead = in;
      Real number;
      if (i > 0 && !ahead.read(number)) break;
      in.word();
    }
    in.skip_blanks();
  }
  TextCursor end = in;
  end.skip_to_line_end();
  std::string_view name = in.rest().substr(0, end.offset() - in.offset());
  while (!name.empty() && is_blank(name.back())) name.remove_suffix(1);
  return std::string(name);
}

class MaterialFiles {
 public:
  MaterialFiles(const fs::path& folder, std::vector<Resource>& resources,
                std::vector<std::string>& notes)
      : folder_(folder.empty() ? "." : folder), resources_(resources), notes_(notes) {}

  /// Where the name begins, the text is read; gives its bytes, or nothing.
  std::string_view add(const std::string& name) {
    const auto there = [&](const Resource& r) { return r.name == name; };
    if (std::any_of(resources_.begin(), resources_.end(), there)) return {};
    FileBytes file;
    const fs::path path = folder_ / name;
    std::error_code ignored;
    if (fs::exists(path, ignored) && !(may_lie_beside(name) && is_within(folder_, path))) {
      notes_.push_back(name +
                       ": not embedded, for only material files and images in the folder of the "
                       "mesh or below it are; copy it there");
      return {};
    }
    const Status status = FileBytes::read(path, file);
    if (!status.ok()) {
      notes_.push_back(status.message() + "; it is not embedded");
      return {};
    }
    const std::string_view bytes = file.view();
    if (bytes.size() > kMaxBytes || name.size() > kMaxAttributeName || !is_utf8(name)) {
      notes_.push_back(path.string() +
                       ": not embedded, for it is over 1 GiB, or its name is longer than 256 "
                       "bytes or not in UTF-8");
      return {};
    }
    Resource& r = resources_.emplace_back(Resource{name, media_type(name), {}});
    r.bytes.assign(bytes.begin(), bytes.end());
    return {reinterpret_cast<const char*>(r.bytes.data()), r.bytes.size()};
  }

 private:
  const fs::path folder_;
  std::vector<Resource>& resources_;
  std::vector<std::string>& notes_;
};

// A name may have blanks in it, and a statement may have several names.
std::vector<std::string> names_in(const fs::path& folder, const std::string& line) {
  std::error_code ignored;
  if (fs::exists(folder / line, ignored) || line.find(' ') == line.npos) return {line};
  std::vector<std::string> out;
  TextCursor in(line);
  for (in.skip_blanks(); !in.done(); in.skip_blanks()) out.emplace_back(in.word());
  return out;
}

}  // namespace

bool may_lie_beside(const std::string& text) {
  const fs::path name(text);
  const std::string extension = lower_extension(name);
  if (extension != ".mtl" && std::find(kImages.begin(), kImages.end(), extension) == kImages.end())
    return false;
  if (name.is_absolute() || text.find_first_of("\\:") != std::string::npos) return false;
  return std::none_of(name.begin(), name.end(), [](const fs::path& part) {
    return part.empty() || (part != "." && part.string().starts_with('.'));
  });
}

std::vector<std::string> textures_of(std::string_view text) {
  std::vector<std::string> out;
  for (TextCursor in(text); !in.done(); in.next_line()) {
    in.skip_blanks();
    const std::string_view keyword = in.word();
    const bool texture = keyword.starts_with("map_") || keyword == "bump" || keyword == "disp" ||
                         keyword == "decal" || keyword == "refl" || keyword == "norm";
    if (!texture || keyword == "map_aat") continue;
    std::string name = file_name(in);
    if (!name.empty()) out.push_back(std::move(name));
  }
  return out;
}

void add_material_files(const std::filesystem::path& folder, const Shot& shot,
                        std::vector<Resource>& resources, std::vector<std::string>& notes) {
  const Attribute* libraries = attribute_named(shot.attributes, "mtllib");
  if (libraries == nullptr) return;
  MaterialFiles files(folder, resources, notes);
  for (const std::string& all : libraries->names) {
    for (size_t first = 0; first < all.size();) {
      const size_t end = std::min(all.find('\n', first), all.size());
      for (const std::string& name : names_in(folder, all.substr(first, end - first))) {
        for (const std::string& texture : textures_of(files.add(name))) files.add(texture);
      }
      first = end + 1;
    }
  }
}

}  // namespace reeb::tools
