// Files that runs write, and files of others in their places.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace lightnet {

/// How all files of a kind begin.
inline constexpr std::string_view exr_beginning{"\x76\x2f\x31\x01", 4};
inline constexpr std::string_view png_beginning{"\x89PNG\r\n\x1a\n", 8};

/// Whether a file is named like one of a kind: "x.EXR" has the ending ".exr".
bool has_ending(const std::filesystem::path& path, std::string_view ending);

/// x.exr → x.png
std::filesystem::path png_beside(const std::filesystem::path& picture);

/// Why nothing may be written at `path`: what is there is not of the kind that begins so, and not empty. "": it may.
/// Some kinds have their mark behind `before` other bytes.
std::string why_not_replaced(const std::filesystem::path& path, std::string_view beginning, std::size_t before = 0);
/// Throws Error when nothing may be.
void expect_ours(const std::filesystem::path& path, std::string_view beginning, std::size_t before = 0);

}  // namespace lightnet
