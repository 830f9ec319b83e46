// Packets of the picture viewer tev.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/film/window.hpp"

namespace lightnet {

/// tev's own protocol (https://github.com/Tom94/tev, "Over a network"): its size in bytes with these four, its kind,
/// and its members. Numbers are little-endian, texts end in a zero.
inline constexpr std::uint16_t usual_tev_port = 14158;

/// Makes a picture, or makes it anew. Channels of one layer begin with its name and a dot.
std::string tev_create_image(const std::string& name, const Window& size, const std::vector<std::string>& channels);
/// Pixels of a rectangle of it: row by row, all channels of a pixel side by side (UpdateImage, version 3).
std::string tev_update_image(const std::string& name, const std::vector<std::string>& channels, const Window& where,
                             std::span<const float> values);
std::string tev_close_image(const std::string& name);
/// Has it read a file of its own machine.
std::string tev_open_image(const std::string& file);

}  // namespace lightnet
