#include "tools/output_file.hpp"

#include <unistd.h>

#include <filesystem>

#include "core/error.hpp"

namespace lightnet {

void check_output(const std::string& output) {
    const std::filesystem::path path(output);
    const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    if (path.extension() != ".exr")
        throw UserError({output, 0}, "pictures are written as .exr (with a .png beside it)");
    if (!std::filesystem::is_directory(folder)) throw UserError({output, 0}, "there is no folder " + folder.string());
    if (::access(folder.c_str(), W_OK) != 0) throw UserError({output, 0}, "the folder can't be written to");
}

}  // namespace lightnet
