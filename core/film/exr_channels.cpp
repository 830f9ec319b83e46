#include "core/film/exr_channels.hpp"

#include <fmt/format.h>

#include "core/base/name_id.hpp"

namespace lightnet::exr {

std::vector<std::string> channels_of(const std::string& layer, const std::string& letters) {
    if (layer == letters) return {layer};
    std::vector<std::string> channels;
    for (const char letter : letters) channels.push_back((layer.empty() ? "" : layer + ".") + letter);
    return channels;
}

std::string matte_key(const std::string& matte) {
    return std::string(of_mattes) + fmt::format("{:08x}", murmur3(matte)).substr(0, 7);
}

std::array<std::string, 4> matte_channels(const std::string& matte, std::uint32_t level) {
    const auto channel = [&](char letter) { return fmt::format("{}{:02}.{}", matte, level, letter); };
    return {channel('R'), channel('G'), channel('B'), channel('A')};
}

}  // namespace lightnet::exr
