// Colours of other primaries than ours: sums, products and quotients alone, so that they are alike on every machine.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/readers/images/image_decoders.hpp"

namespace lightnet::decoders {
namespace {

using Triple = std::array<double, 3>;
using Rows = std::array<Triple, 3>;

Triple times(const Rows& m, const Triple& v) {
    Triple result{};
    for (std::size_t i = 0; i < 3; ++i) result[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    return result;
}

Rows times(const Rows& a, const Rows& b) {
    Rows result{};
    for (std::size_t j = 0; j < 3; ++j) {
        const Triple column = times(a, Triple{b[0][j], b[1][j], b[2][j]});
        for (std::size_t i = 0; i < 3; ++i) result[i][j] = column[i];
    }
    return result;
}

Rows scaled(const Rows& m, const Triple& columns) {
    Rows result = m;
    for (auto& row : result)
        for (std::size_t j = 0; j < 3; ++j) row[j] *= columns[j];
    return result;
}

// By cofactors. None: there is no inverse.
std::optional<Rows> inverse(const Rows& m) {
    Rows result{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            result[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
        }
    const double size = m[0][0] * result[0][0] + m[0][1] * result[1][0] + m[0][2] * result[2][0];
    if (!(std::fabs(size) > 1e-9) || !std::isfinite(size)) return std::nullopt;
    for (auto& row : result)
        for (double& value : row) value /= size;
    return result;
}

// Of brightness 1.
Triple xyz_of(const Primaries::Place& place) { return {place[0] / place[1], 1, (1 - place[0] - place[1]) / place[1]}; }

// What red, green and blue are in CIE XYZ, where as much of each is the white. None: they span no colours.
std::optional<Rows> to_xyz(const Primaries& from) {
    if (!(from.white[1] > 1e-6)) return std::nullopt;
    Rows primaries{};
    const std::array<const Primaries::Place*, 3> places{&from.red, &from.green, &from.blue};
    for (std::size_t j = 0; j < 3; ++j) {
        const auto [x, y] = *places[j];
        primaries[0][j] = x, primaries[1][j] = y, primaries[2][j] = 1 - x - y;
    }
    const auto back = inverse(primaries);
    return back ? std::optional(scaled(primaries, times(*back, xyz_of(from.white)))) : std::nullopt;
}

// Lam 1985, "Metamerism and Colour Constancy": how eyes used to one white see what is lit by another.
constexpr Rows bradford{{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};

std::optional<Rows> adapted(const Rows& xyz, const Primaries::Place& from, const Primaries::Place& to) {
    const auto back = inverse(bradford);
    const Triple old = times(bradford, xyz_of(from)), wanted = times(bradford, xyz_of(to));
    Triple change{};
    for (std::size_t i = 0; i < 3; ++i) change[i] = wanted[i] / old[i];
    return back ? std::optional(times(times(scaled(*back, change), bradford), xyz)) : std::nullopt;
}

bool near(const Primaries::Place& a, const Primaries::Place& b) {
    return std::fabs(a[0] - b[0]) < 2e-3 && std::fabs(a[1] - b[1]) < 2e-3;
}

bool near(const Primaries& a, const Primaries& b) {
    return near(a.red, b.red) && near(a.green, b.green) && near(a.blue, b.blue);
}

}  // namespace

// DECISIONS: white-stays-white
void turn_to_ours(const Primaries& from, std::vector<Rgb>& pixels) {
    if (near(from, rec709) && near(from.white, rec709.white)) return;
    const auto ours = to_xyz(rec709);
    auto theirs = to_xyz(from);
    // X, Y and Z say what light is there; of other primaries, equal parts say that it is white
    if (theirs && !near(from, cie_xyz)) theirs = adapted(*theirs, from.white, rec709.white);
    const auto back = ours ? inverse(*ours) : std::nullopt;
    if (!theirs || !back) return;
    const Rows turn = times(*back, *theirs);
    float m[3][3];
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) m[i][j] = static_cast<float>(turn[i][j]);
    const auto row = [&](int i, const Rgb& c) { return std::max(0.0f, m[i][0] * c.r + m[i][1] * c.g + m[i][2] * c.b); };
    for (Rgb& pixel : pixels) pixel = {row(0, pixel), row(1, pixel), row(2, pixel)};
}

}  // namespace lightnet::decoders
