#include "tests/support/measured_numbers.hpp"

#include <cmath>
#include <cstring>

#include "core/base/math/sampling.hpp"
#include "core/scene/bsdf/microfacets.hpp"

namespace lightnet::test {
namespace {

Vec3 direction(float angle, float turn) {
    return {std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle)};
}

/// The facet's normal at a node of the unit square.
struct Node {
    Vec2 place;
    Vec3 normal;
    float stretch = 0;  // solid angle per area of the square
};
Node node(Vec2 place, float turned) {
    const float angle = place.x * place.x * pi / 2;
    return {place, direction(angle, (2 * place.y - 1) * pi + turned), 2 * pi * pi * place.x * std::sin(angle)};
}

template <class Make>
void for_grid(GridSize size, const Make& make) {
    for (std::uint32_t y = 0; y < size.high; ++y)
        for (std::uint32_t x = 0; x < size.wide; ++x)
            make(Vec2{float(x) / float(size.wide - 1), float(y) / float(size.high - 1)});
}

std::string floats(const std::vector<float>& numbers) {
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float)};
}

template <class Number>
std::string bytes(Number number) {
    std::string text(sizeof number, '\0');
    std::memcpy(text.data(), &number, sizeof number);
    return text;
}

TensorField field(const std::string& name, std::vector<std::uint64_t> shape, const std::vector<float>& numbers) {
    return {name, 10, std::move(shape), floats(numbers)};
}

}  // namespace

Measurement::Numbers even_numbers(Rgb colour, float area) {
    Measurement::Numbers n;
    n.azimuths = {0}, n.angles = {0, pi / 2};
    n.facet_grid = n.area_grid = n.seen_grid = n.light_grid = {2, 2};
    n.facets.assign(4, 1), n.areas.assign(4, area);
    n.seen.assign(8, 1), n.light.assign(8, 1), n.colours.assign(8, colour);
    return n;
}

Measurement::Numbers ggx_numbers(float alpha_u, float alpha_v, Rgb colour, std::uint32_t nodes, std::uint32_t folds) {
    const Microfacets facets{alpha_u, alpha_v};
    const bool isotropic = alpha_u == alpha_v;
    Measurement::Numbers n;
    n.folds = folds;
    n.azimuths = {0};
    const std::uint32_t azimuths = 32 / folds + 1;
    if (!isotropic) {
        n.azimuths.clear();
        for (std::uint32_t i = 0; i < azimuths; ++i)
            n.azimuths.push_back(-pi + 2 * pi / float(folds) * float(i) / float(azimuths - 1));
    }
    for (int i = 0; i <= 24; ++i) n.angles.push_back(float(i) * 1.56f / 24);
    n.facet_grid = n.seen_grid = n.light_grid = {nodes, nodes};
    n.area_grid = {nodes, isotropic ? 2 : nodes};
    for_grid(n.facet_grid, [&](Vec2 place) { n.facets.push_back(facets.density(node(place, 0).normal)); });
    for_grid(n.area_grid, [&](Vec2 place) {
        const Vec3 seen = node(place, 0).normal;
        n.areas.push_back(std::max(1e-4f, seen.z) / facets.visible({seen.x, seen.y, std::max(1e-4f, seen.z)}));
    });
    for (const float azimuth : n.azimuths)
        for (const float angle : n.angles) {
            const Vec3 o = direction(angle, azimuth);
            const float turned = isotropic ? azimuth : 0;
            std::vector<float> seen;
            for_grid(n.seen_grid, [&](Vec2 place) {
                const auto [at, m, stretch] = node(place, turned);
                seen.push_back(std::max(0.0f, dot(o, m)) * facets.density(m) * stretch);
            });
            n.seen.insert(n.seen.end(), seen.begin(), seen.end());
            const SquareDensities densities(n.seen_grid, seen);
            TableBlend only;
            only.count = 1, only.share[0] = 1;
            for_grid(n.light_grid, [&](Vec2 u) {
                const Vec3 m = node(densities.sample(u, only).place, turned).normal;
                const Vec3 i = m * (2 * dot(o, m)) - o;
                // what hides the light from facets that are seen: Heitz 2014, eq. 99
                const float lit = i.z > 0 ? facets.visible(o, i) / facets.visible(o) : 0;
                n.light.push_back(lit);
                n.colours.push_back(colour * lit);
            });
        }
    return n;
}

std::vector<TensorField> tensor_fields_of(const Measurement::Numbers& n, const std::vector<float>& wavelengths) {
    const std::uint64_t azimuths = n.azimuths.size(), angles = n.angles.size();
    const auto grid = [](GridSize size, std::vector<std::uint64_t> before) {
        before.push_back(size.high), before.push_back(size.wide);
        return before;
    };
    const std::string about = "made by a test";
    std::vector<TensorField> fields{{"description", 1, {about.size()}, about},
                                    {"jacobian", 1, {1}, std::string(1, n.times_facets ? '\1' : '\0')},
                                    field("phi_i", {azimuths}, n.azimuths),
                                    field("theta_i", {angles}, n.angles),
                                    field("ndf", grid(n.facet_grid, {}), n.facets),
                                    field("sigma", grid(n.area_grid, {}), n.areas),
                                    field("vndf", grid(n.seen_grid, {azimuths, angles}), n.seen),
                                    field("luminance", grid(n.light_grid, {azimuths, angles}), n.light)};
    const std::size_t channels = wavelengths.empty() ? 3 : wavelengths.size(), nodes = n.light_grid.nodes();
    std::vector<float> colours;
    for (std::size_t table = 0; table < azimuths * angles; ++table)
        for (std::size_t c = 0; c < channels; ++c)
            for (std::size_t i = 0; i < nodes; ++i) {
                const Rgb& colour = n.colours[table * nodes + i];
                colours.push_back(!wavelengths.empty() || c == 0 ? colour.r : c == 1 ? colour.g : colour.b);
            }
    fields.push_back(
        field(wavelengths.empty() ? "rgb" : "spectra", grid(n.light_grid, {azimuths, angles, channels}), colours));
    if (!wavelengths.empty()) fields.push_back(field("wavelengths", {channels}, wavelengths));
    return fields;
}

std::string tensor_file(const std::vector<TensorField>& fields, std::size_t aligned) {
    std::string header = std::string("tensor_file\0\1\0", 14) + bytes(std::uint32_t(fields.size()));
    std::size_t size = header.size();
    for (const auto& f : fields) size += 2 + f.name.size() + 2 + 1 + 8 + 8 * f.shape.size();
    std::string body;
    for (const auto& f : fields) {
        while ((size + body.size()) % aligned) body += '\0';
        header += bytes(std::uint16_t(f.name.size())) + f.name + bytes(std::uint16_t(f.shape.size())) + bytes(f.type) +
                  bytes(std::uint64_t{size + body.size()});
        for (const auto length : f.shape) header += bytes(length);
        body += f.bytes;
    }
    return header + body;
}

std::string tensor_file_of(const Measurement::Numbers& numbers, const std::vector<float>& wavelengths) {
    return tensor_file(tensor_fields_of(numbers, wavelengths));
}

}  // namespace lightnet::test
