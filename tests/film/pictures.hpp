// Small pictures and folders to test with.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "core/film/picture.hpp"
#include "tests/support/folder.hpp"

namespace lightnet {

using test::Folder;

inline std::string content_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Noise of any brightness between 1e-3 and 1e3, always the same.
inline std::vector<Rgb> noise(std::size_t pixels, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto value = [&] {
        const float bits = static_cast<float>(random() >> 8) * 0x1p-24f;
        return (bits + 0.001f) * static_cast<float>(1u << (random() % 10));
    };
    std::vector<Rgb> result(pixels);
    for (Rgb& pixel : result) pixel = {value(), value(), value()};
    return result;
}

/// A picture of noise in three layers, one of them with a long name.
inline Picture noisy_picture(std::uint32_t width, std::uint32_t height) {
    const std::size_t pixels = std::size_t{width} * height;
    Picture picture{width, height, {}, {}};
    picture.layers = {{"emission", noise(pixels, 1)},
                      {"Zenith", noise(pixels, 2)},
                      {"a_node_whose_name_is_longer_than_31_letters", noise(pixels, 3)}};
    picture.beauty = sum_of(picture.layers);
    return picture;
}

/// With all that goes into files.
inline Picture for_compositing() {
    Picture picture = noisy_picture(5, 3);
    picture.alpha = std::vector<float>(15, 0.25f);
    picture.shown = {{"depth", noise(15, 4)}};
    picture.mattes = {{"CryptoObject", 4, {}, R"({"ball":"deadbeef"})"}};
    for (std::size_t i = 0; i < 15 * 4; ++i) picture.mattes[0].pixels.push_back({float(i) + 1, 1 / float(i + 2)});
    picture.notes.texts = {{"software", "lightnet"}, {"seed", "7"}};
    for (std::size_t i = 0; i < 16; ++i) picture.notes.matrices["worldToCamera"][i] = float(i);
    return picture;
}

}  // namespace lightnet
