// lightnet-contact-sheet SHEET.png [--pairs N] PICTURE PICTURE...: pairs of pictures beside one another, one pair below
// the other.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "core/base/words_of.hpp"
#include "core/film/png.hpp"
#include "core/readers/files/files.hpp"
#include "core/readers/images/image_file.hpp"

namespace lightnet {
namespace {

constexpr std::uint32_t cell_width = 240, cell_height = 180, margin = 4;
constexpr std::size_t usual_pairs_in_a_row = 3;
constexpr const char* usage =
    "usage: lightnet-contact-sheet SHEET.png [--pairs N] PICTURE PICTURE...\n"
    "Lays pairs of pictures (EXR, HDR, PNG, JPEG) beside one another, N in a row (3), each made as small as its cell. "
    "'-' "
    "is no picture.\n";

/// Where a picture lies in its cell, and how many of its pixels go into one of the sheet's.
struct Fit {
    std::uint32_t width, height;
    double scale;
};

Fit fit(const Image& image) {
    const double scale = std::max(double(image.width) / cell_width, double(image.height) / cell_height);
    return {std::clamp(std::uint32_t(image.width / scale), 1u, cell_width),
            std::clamp(std::uint32_t(image.height / scale), 1u, cell_height), scale};
}

/// The mean of what a pixel of the sheet covers, clipped as it is shown, so that one bright pixel doesn't hide others.
Rgb mean(const Image& image, const Fit& fit, std::uint32_t x, std::uint32_t y) {
    const auto range = [&](std::uint32_t at, std::uint32_t size) {
        const auto first = std::min(std::uint32_t(at * fit.scale), size - 1);
        return std::pair(first, std::clamp(std::uint32_t((at + 1) * fit.scale), first + 1, size));
    };
    const auto [left, right] = range(x, image.width);
    const auto [top, bottom] = range(y, image.height);
    Rgb sum;
    for (std::uint32_t j = top; j < bottom; ++j)
        for (std::uint32_t i = left; i < right; ++i) {
            const Rgb c = image.colour(i, j);
            sum += Rgb{std::min(c.r, 1.0f), std::min(c.g, 1.0f), std::min(c.b, 1.0f)};
        }
    return sum / float((right - left) * (bottom - top));
}

void lay(Picture& sheet, std::uint32_t left, std::uint32_t top, const Image& image) {
    const Fit place = fit(image);
    for (std::uint32_t y = 0; y < place.height; ++y)
        for (std::uint32_t x = 0; x < place.width; ++x)
            sheet.beauty[std::size_t{top + y} * sheet.width + left + x] = mean(image, place, x, y);
}

Picture sheet_of(const std::vector<std::string>& names, std::uint32_t pairs_in_a_row) {
    const auto pairs = std::uint32_t((names.size() + 1) / 2), columns = std::min(pairs, pairs_in_a_row);
    const std::uint32_t rows = (pairs + columns - 1) / columns, pair_width = 2 * cell_width + 3 * margin;
    Picture sheet{columns * pair_width + margin, rows * (cell_height + margin) + margin, {}, {}};
    sheet.beauty.assign(std::size_t{sheet.width} * sheet.height, {0.2f, 0.2f, 0.2f});
    DiskFiles files;
    for (std::uint32_t i = 0; i < names.size(); ++i) {
        if (names[i] == "-") continue;
        const std::uint32_t pair = i / 2;
        const std::uint32_t left = margin + pair % columns * pair_width + i % 2 * (cell_width + margin);
        lay(sheet, left, margin + pair / columns * (cell_height + margin), read_image(*files.read(names[i])));
    }
    return sheet;
}

}  // namespace
}  // namespace lightnet

int main(int argc, char** argv) try {
    std::vector<std::string> words(argv + 1, argv + argc);
    std::size_t pairs = lightnet::usual_pairs_in_a_row;
    if (words.size() > 2 && words[1] == "--pairs") {
        pairs = std::strtoul(words[2].c_str(), nullptr, 10);
        words.erase(words.begin() + 1, words.begin() + 3);
    }
    if (words.size() < 2 || pairs < 1 || pairs > 100) {
        std::fputs(lightnet::usage, stderr);
        return 2;
    }
    lightnet::write_png(words[0], lightnet::sheet_of({words.begin() + 1, words.end()}, std::uint32_t(pairs)));
    return 0;
} catch (const std::exception& error) {
    fmt::print(stderr, "lightnet-contact-sheet: {}\n", lightnet::words_of(error));
    return 1;
}
