// lightnet-compare REFERENCE IMAGE...: how far each picture is from the reference, one line each.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string_view>

#include "core/film/compare.hpp"
#include "core/film/exr.hpp"

namespace {

constexpr const char* usage =
    "usage: lightnet-compare REFERENCE.exr IMAGE.exr...\n"
    "Prints for each image: ratio of the means (R G B), relMSE = mean of d²/(reference² + 0.01), the same without the\n"
    "worst 0.1 % of the pixels, the mean relative difference of 16x16 pixel blocks, and whether all bits are equal.\n";

void print(std::string_view name, const lightnet::Difference& found) {
    fmt::print("{}: mean ratio {:.4f} {:.4f} {:.4f}  relMSE {:.4g}  trimmed {:.4g}  blocks {:.4f}  bits {}\n", name,
               found.mean_ratio.r, found.mean_ratio.g, found.mean_ratio.b, found.relative_square,
               found.relative_square_trimmed, found.block_difference, found.identical ? "equal" : "differ");
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc == 2 && (argv[1] == std::string_view("--help") || argv[1] == std::string_view("-h"))) {
        std::fputs(usage, stdout);
        return 0;
    }
    if (argc < 3) {
        std::fputs(usage, stderr);
        return 2;
    }
    const auto reference = lightnet::read_exr(argv[1]);
    for (int i = 2; i < argc; ++i) print(argv[i], lightnet::compare(reference, lightnet::read_exr(argv[i])));
    return 0;
} catch (const std::exception& error) {
    fmt::print(stderr, "lightnet-compare: {}\n", error.what());
    return 1;
}
