// Skies on the six faces of a cube, laid out anew by latitude and longitude.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/readers/images/image_decoders.hpp"

namespace lightnet::decoders {
namespace {

constexpr int samples = 2;  // across and down, of each pixel that is made

/// A pixel of the column of faces, between its neighbours in its face: pixels at the rim lie on the cube's edges.
struct Spot {
    std::size_t at, right, below;  // the pixel above and left of it, and the steps to the others
    float x, y;                    // how far it is to them

    template <class Value>
    Value of(const std::vector<Value>& values) const {
        const Value above = values[at] * (1 - x) + values[at + right] * x;
        const Value under = values[at + below] * (1 - x) + values[at + below + right] * x;
        return above * (1 - y) + under * y;
    }
};

struct Face {
    int index;
    double right, down;  // ±1, from its middle
};

/// OpenEXR's ImfEnvmap.h: +X, -X, +Y, -Y, +Z, -Z below each other, each as it draws them.
Face face_towards(double x, double y, double z) {
    const double ax = std::fabs(x), ay = std::fabs(y), az = std::fabs(z);
    if (ax >= ay && ax >= az) return x > 0 ? Face{0, z / ax, -y / ax} : Face{1, -z / ax, -y / ax};
    if (ay >= az) return y > 0 ? Face{2, x / ay, -z / ay} : Face{3, x / ay, z / ay};
    return z > 0 ? Face{4, -x / az, -y / az} : Face{5, x / az, -y / az};
}

Spot spot_on(const Face& face, std::size_t size) {
    const auto place = [&](double side) { return (std::clamp(side, -1.0, 1.0) + 1) / 2 * double(size - 1); };
    const double x = place(face.right), y = place(face.down);
    const auto column = std::min(static_cast<std::size_t>(x), size - std::min<std::size_t>(size, 2));
    const auto row = std::min(static_cast<std::size_t>(y), size - std::min<std::size_t>(size, 2));
    const std::size_t step = size > 1 ? 1 : 0;
    return {(static_cast<std::size_t>(face.index) * size + row) * size + column, step, step * size,
            float(x - double(column)), float(y - double(row))};
}

struct Angle {
    double sine, cosine;
};

/// Of the samples' middles, from `first` over `range`.
std::vector<Angle> angles(std::size_t count, double first, double range) {
    std::vector<Angle> all;
    for (std::size_t i = 0; i < count; ++i) {
        const double angle = first + range * (double(i) + 0.5) / double(count);
        all.push_back({std::sin(angle), std::cos(angle)});
    }
    return all;
}

}  // namespace

Image from_cube(std::size_t size, const std::vector<Rgb>& pixels, const std::vector<float>& alpha) {
    constexpr double pi = std::numbers::pi;
    constexpr std::size_t most_columns = 11584;  // 2²⁶ pixels
    const std::size_t columns = std::min(4 * size, most_columns), rows = columns / 2;
    const auto across = angles(columns * samples, pi, -2 * pi);  // longitude: 0 is +Z, a right angle +X
    const auto down = angles(rows * samples, pi / 2, -pi);
    std::vector<Rgb> made(columns * rows);
    std::vector<float> made_alpha(alpha.empty() ? 0 : made.size());
    constexpr float part = 1.0f / (samples * samples);
    for (std::size_t row = 0; row < rows * samples; ++row)
        for (std::size_t column = 0; column < columns * samples; ++column) {
            const auto &turn = across[column], &lift = down[row];
            const Spot spot =
                spot_on(face_towards(turn.sine * lift.cosine, lift.sine, turn.cosine * lift.cosine), size);
            const std::size_t pixel = row / samples * columns + column / samples;
            made[pixel] += spot.of(pixels) * part;
            if (!alpha.empty()) made_alpha[pixel] += spot.of(alpha) * part;
        }
    return {static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rows), made, made_alpha};
}

}  // namespace lightnet::decoders
