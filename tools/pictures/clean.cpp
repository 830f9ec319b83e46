#include "tools/pictures/clean.hpp"

#include <filesystem>

namespace lightnet {

std::string clean_beside(const std::string& file) {
    std::filesystem::path path(file);
    const auto ending = path.extension().string();
    return path.replace_extension(".clean" + ending).string();
}

}  // namespace lightnet
