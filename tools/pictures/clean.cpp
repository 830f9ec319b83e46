#include "tools/pictures/clean.hpp"

#include <filesystem>

namespace lightnet {

std::string clean_beside(const std::string& exr) {
    return std::filesystem::path(exr).replace_extension(".clean.exr").string();
}

}  // namespace lightnet
