// Material texts of OBJ files and the textures they name, as resources.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "codec/common/base/sequence.h"

namespace reeb::tools {

/// True of names of material texts and images in the folder of a mesh or below it: whatever a file
/// names, no other leaves the folder with a stream, or comes out of one.
bool may_lie_beside(const std::string& name);

/// Adds the files that `mtllib` names in the shot, and the images that those name, to `resources`,
/// each once. They are looked for in `folder`; `notes` tells what is not there or may not lie
/// there.
void add_material_files(const std::filesystem::path& folder, const Shot& shot,
                        std::vector<Resource>& resources, std::vector<std::string>& notes);

/// The file names in a material text, as they stand there.
std::vector<std::string> textures_of(std::string_view text);

}  // namespace reeb::tools
