#include "core/scene/bsdf/albedos.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/scene/bsdf/fresnel.hpp"
#include "core/scene/bsdf/microfacets.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {
namespace {

constexpr std::size_t table_size = 32;

/// Values by roughness and angle, both with more nodes where they change fast: at √α and √cos.
template <class Value>
using Table = std::array<std::array<Value, table_size>, table_size>;

float node(std::size_t i) { return float(i) / (table_size - 1); }

struct Between {
    std::size_t low;
    float share;
};
Between between(float root) {
    const float at = std::clamp(root, 0.0f, 1.0f) * (table_size - 1);
    const auto low = std::min(static_cast<std::size_t>(at), table_size - 2);
    return {low, at - float(low)};
}

template <class Value, class Mix>
auto interpolated(const Table<Value>& table, float alpha, float cosine, Mix mix) {
    const auto [a, by_a] = between(std::sqrt(alpha));
    const auto [c, by_c] = between(std::sqrt(std::max(0.0f, cosine)));
    return mix(mix(table[a][c], table[a][c + 1], by_c), mix(table[a + 1][c], table[a + 1][c + 1], by_c), by_a);
}

GgxAlbedo mixed(GgxAlbedo a, GgxAlbedo b, float share) {
    return {a.low * (1 - share) + b.low * share, a.high * (1 - share) + b.high * share};
}

GgxAlbedo of_mirror(float cosine) {
    const float high = std::pow(1 - std::clamp(cosine, 0.0f, 1.0f), 5.0f);
    return {1 - high, high};
}

GgxAlbedo integrated(float alpha, float cosine) {
    if (is_specular(alpha, alpha)) return of_mirror(cosine);
    constexpr int grid = 24;
    const Microfacets facets{alpha, alpha};
    const Vec3 w{std::sqrt(std::max(0.0f, 1 - cosine * cosine)), 0, cosine};
    double low = 0, high = 0;
    for (int i = 0; i < grid; ++i)
        for (int j = 0; j < grid; ++j) {
            const Vec3 m = facets.sample_visible(w, {(float(i) + 0.5f) / grid, (float(j) + 0.5f) / grid});
            const Vec3 out = reflect(w, m);
            if (out.z <= 0) continue;
            const float seen = facets.visible(w, out) / facets.visible(w);
            const GgxAlbedo fresnel = of_mirror(dot(w, m));
            low += fresnel.low * seen;
            high += fresnel.high * seen;
        }
    return {float(low / (grid * grid)), float(high / (grid * grid))};
}

struct GgxTables {
    Table<GgxAlbedo> by_angle;
    std::array<GgxAlbedo, table_size> mean;

    GgxTables() {
        for (std::size_t a = 0; a < table_size; ++a) {
            const float alpha = node(a) * node(a);
            for (std::size_t c = 0; c < table_size; ++c)
                by_angle[a][c] = integrated(alpha, std::max(1e-3f, node(c) * node(c)));
            constexpr int strips = 256;
            double low = 0, high = 0;
            for (int i = 0; i < strips; ++i) {
                const float cosine = (float(i) + 0.5f) / strips;
                const GgxAlbedo here = interpolated(by_angle, alpha, cosine, mixed);
                low += 2 * cosine * here.low / strips;
                high += 2 * cosine * here.high / strips;
            }
            mean[a] = {float(low), float(high)};
        }
    }
};

const GgxTables& ggx_tables() {
    static const GgxTables tables;
    return tables;
}

/// Sheen over the whole hemisphere, by a grid of equal solid angles that is finer near the horizon.
float sheen_integrated(float alpha, float cosine) {
    constexpr int rows = 48, columns = 32;
    const Vec3 o{std::sqrt(std::max(0.0f, 1 - cosine * cosine)), 0, cosine};
    double sum = 0;
    for (int i = 0; i < rows; ++i) {
        const float at = (float(i) + 0.5f) / rows, z = at * at, sine = std::sqrt(1 - z * z);
        for (int j = 0; j < columns; ++j) {
            const float turn = pi * (float(j) + 0.5f) / columns;
            sum += sheen_value(alpha, o, {sine * std::cos(turn), sine * std::sin(turn), z}) * 2 * at;
        }
    }
    return float(sum * 2 * pi / (rows * columns));
}

const Table<float>& sheen_table() {
    static const Table<float> table = [] {
        Table<float> made;
        for (std::size_t a = 0; a < table_size; ++a)
            for (std::size_t c = 0; c < table_size; ++c)
                made[a][c] = sheen_integrated(std::max(least_sheen_alpha, node(a) * node(a)),
                                              std::max(1e-3f, node(c) * node(c)));
        return made;
    }();
    return table;
}

}  // namespace

GgxAlbedo ggx_albedo(float alpha, float cosine) {
    if (is_specular(alpha, alpha)) return of_mirror(cosine);
    return interpolated(ggx_tables().by_angle, alpha, cosine, mixed);
}

GgxAlbedo ggx_mean_albedo(float alpha) {
    const auto [a, share] = between(std::sqrt(alpha));
    const auto& mean = ggx_tables().mean;
    return mixed(mean[a], mean[a + 1], share);
}

float sheen_value(float alpha, Vec3 outgoing, Vec3 incoming) {
    const Vec3 m = normalize(outgoing + incoming);
    const float sine2 = std::max(0.0f, 1 - m.z * m.z), inverse = 1 / alpha;
    const float density = (2 + inverse) * std::pow(sine2, inverse / 2) * inverse_pi / 2;
    return density * incoming.z / (4 * (outgoing.z + incoming.z - outgoing.z * incoming.z));
}

float sheen_albedo(float alpha, float cosine) {
    return interpolated(sheen_table(), alpha, cosine,
                        [](float a, float b, float share) { return a * (1 - share) + b * share; });
}

}  // namespace lightnet
