// Names of channels and attributes of our EXR files, for those who write and read them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/film/picture.hpp"

namespace lightnet::exr {

inline constexpr const char* layers_attribute = "layers";
inline constexpr const char* shown_attribute = "shown";
inline constexpr const char* gains_attribute = "gains";
inline constexpr const char* done_attribute = "done";
inline constexpr const char* samples_channel = "samples";
inline constexpr const char* alpha_channel = "A";
inline constexpr const char* colours_attribute = "colorInteropID";
inline constexpr std::string_view of_mattes = "cryptomatte/";

/// What the attributes of a matte begin with: seven digits of the hash of its name keep those of several apart.
std::string matte_key(const std::string& matte);
/// The channels of two ranks of a matte: "objects00.R" …, for the ids and the parts of both.
std::array<std::string, 4> matte_channels(const std::string& matte, std::uint32_t level);

/// The channels of a layer: "direct.R", "direct.G", "direct.B"; "N.X" …; "R" … of the beauty, which has no name; and
/// "Z" alone of one that is called by its only letter.
std::vector<std::string> channels_of(const std::string& layer, const std::string& letters = usual_letters);

/// Calls visit(channel name, pointer to its value in the first pixel) for each channel of a plane of pixels.
template <class Plane, class Visit>
void for_channels(const std::vector<std::string>& channels, Plane& pixels, const Visit& visit) {
    auto* first = pixels.data();
    const std::array numbers{&first->r, &first->g, &first->b};
    for (std::size_t i = 0; i < channels.size(); ++i) visit(channels[i], numbers[i]);
}

/// Calls visit(channel name, pointer to its value in the first pixel, bytes from pixel to pixel) for all of a matte.
template <class Visit>
void for_matte_channels(const PictureMatte& matte, const Visit& visit) {
    for (std::uint32_t level = 0; level < matte.ranks / 2; ++level) {
        const auto names = matte_channels(matte.name, level);
        for (std::size_t i = 0; i < names.size(); ++i) {
            const Covered& covered = matte.pixels[2 * level + i / 2];
            visit(names[i], i % 2 ? &covered.part : &covered.id, matte.ranks * sizeof(Covered));
        }
    }
}

}  // namespace lightnet::exr
