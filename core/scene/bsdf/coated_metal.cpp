#include "core/scene/bsdf/coated_metal.hpp"

#include <algorithm>
#include <cmath>

#include "core/scene/bsdf/coat_walk.hpp"

namespace lightnet {
namespace {

constexpr std::size_t metal_roughnesses = 6;

bool smooth(const Microfacets& facets) { return is_specular(facets.alpha_u, facets.alpha_v); }

Microfacets at_least_rough(const Microfacets& facets) {
    return {std::max(facets.alpha_u, specular_alpha), std::max(facets.alpha_v, specular_alpha), facets.law};
}

Vec3 from_above(float cosine) { return {std::sqrt(std::max(0.0f, 1 - cosine * cosine)), 0, cosine}; }

/// By the square root of α, where there is more than one.
Microfacets roughness(std::size_t index, const FacetRange& range) {
    if (!range.varies) return range.facets;
    const float root = float(index) / (metal_roughnesses - 1), alpha = root * root;
    return {alpha, alpha, range.facets.law};
}

/// Where among `count` roughnesses one lies.
struct TablePosition {
    std::size_t low = 0;
    float share = 0;
};
TablePosition place(const Microfacets& facets, std::size_t count) {
    if (count == 1) return {};
    const float root = std::sqrt(std::sqrt(facets.alpha_u * facets.alpha_v));
    const float at = std::min(root, 1.0f) * float(count - 1);
    const auto low = std::min(static_cast<std::size_t>(at), count - 2);
    return {low, at - float(low)};
}

void add(CoatedMetal::Returned& sum, const CoatedMetal::Returned& part, float share) {
    for (std::size_t n = 0; n < CoatedMetal::orders; ++n) {
        sum.energy[n] += part.energy[n] * share;
        sum.factor[n] += part.factor[n] * share;
    }
    sum.again += part.again * share;
}

/// F e0 + F² e1 + F³ e2 + F⁴ e3 (1 + F again + F² again² …)
float series(const std::array<float, CoatedMetal::orders>& e, float again, float reflectance) {
    float sum = e.back() / (1 - reflectance * again);
    for (std::size_t n = e.size() - 1; n-- > 0;) sum = e[n] + reflectance * sum;
    return reflectance * sum;
}

}  // namespace

float CoatedMetal::Returned::factor_with(const Returned& other, float reflectance) const {
    std::array<float, orders> both{};
    for (std::size_t n = 0; n < orders; ++n) both[n] = factor[n] * other.factor[n];
    return series(both, again, reflectance);
}

float CoatedMetal::Returned::albedo(float reflectance) const { return series(energy, again, reflectance); }

CoatedMetal::CoatedMetal(const Coat& coat, const FacetRange& above, const FacetRange& below)
    : coat_(coat), rows_(above.varies ? metal_roughnesses : 1), columns_(below.varies ? metal_roughnesses : 1) {
    const std::uint32_t walks = rows_ * columns_ == 1 ? 1 << 11 : 1 << 9;
    for (std::size_t i = 0; i < rows_; ++i)
        for (std::size_t j = 0; j < columns_; ++j)
            tables_.push_back(made(roughness(i, above), roughness(j, below), walks));
}

float CoatedMetal::node(std::size_t step) { return std::max(5e-3f, float(step) / steps); }

CoatedMetal::Between CoatedMetal::between(float cosine) {
    const float at = std::clamp(cosine, 0.0f, 1.0f) * steps;
    const auto low = std::min(static_cast<std::size_t>(at), steps - 1);
    return {low, at - float(low)};
}

// A factor per direction and order such that the lobe, times those of both its directions, gives each direction the
// energy that its walks have: Sinkhorn's way of scaling a symmetric kernel to given sums.
// DECISIONS: coats-from-tables
CoatedMetal::ByCosine CoatedMetal::made(const Microfacets& above, const Microfacets& below, std::uint32_t walks) const {
    ByCosine result;
    walk(above, below, walks, result);
    const Kernel kernel = lobe(above, below, walks);
    for (std::size_t n = 0; n < orders; ++n) {
        for (Returned& r : result) r.factor[n] = 1;
        for (int round = 0; round < 40; ++round) {
            std::array<float, steps + 1> sums{};
            for (std::size_t o = 0; o <= steps; ++o)
                for (std::size_t i = 0; i <= steps; ++i) sums[o] += kernel[o][i] * result[i].factor[n];
            for (std::size_t o = 0; o <= steps; ++o) {
                float& factor = result[o].factor[n];
                factor = sums[o] > 0 ? std::sqrt(factor * result[o].energy[n] / sums[o]) : 0;
            }
        }
    }
    return result;
}

void CoatedMetal::walk(const Microfacets& above, const Microfacets& below, std::uint32_t walks,
                       ByCosine& result) const {
    std::array<float, steps + 1> more{};
    float last = 0, all = 0;  // of the last order
    for (std::size_t step = 0; step <= steps; ++step) {
        auto& energy = result[step].energy;
        for (std::uint32_t i = 0; i < walks; ++i)
            CoatWalk(coat_, above, below, Samples(1, i)).go(from_above(node(step)), [&](std::uint32_t n, float share) {
                (n < orders ? energy[n] : more[step]) += share / float(walks);
            });
        last += node(step) * energy[orders - 1];
        all += node(step) * (energy[orders - 1] + more[step]);
    }
    const float again = all > 0 ? 1 - last / all : 0;
    for (std::size_t step = 0; step <= steps; ++step) {
        float& energy = result[step].energy[orders - 1];
        energy = (energy + more[step]) * (1 - again);
        result[step].again = again;
    }
}

/// How much of one direction's light the metal's lobe through the coat gives to the others.
CoatedMetal::Kernel CoatedMetal::lobe(const Microfacets& above, const Microfacets& below, std::uint32_t samples) const {
    Kernel kernel{};
    const Microfacets facets = at_least_rough(seen_through(below, above, coat_.eta()));
    for (std::size_t step = 0; step <= steps; ++step) {
        const Vec3 o = into_coat(from_above(node(step)), coat_.eta());
        const float enters = coat_.transmittance(above, node(step));
        for (std::uint32_t k = 0; k < samples; ++k) {
            const Vec3 i = normalize(reflect(o, facets.sample_visible(o, Samples(2, k).next_2d())));
            const auto incoming = i.z > 0 ? out_of_coat(i, coat_.eta()) : std::nullopt;
            if (!incoming) continue;
            const float share = enters * coat_.transmittance(above, incoming->z) * facets.visible(o, i) /
                                (facets.visible(o) * float(samples));
            const auto [low, next] = between(incoming->z);
            kernel[step][low] += share * (1 - next);
            kernel[step][low + 1] += share * next;
        }
    }
    return kernel;
}

CoatedMetal::Returned CoatedMetal::returned(const Microfacets& above, const Microfacets& below, float cosine) const {
    const Between angle = between(cosine);
    const TablePosition row = place(above, rows_), column = place(below, columns_);
    Returned sum;
    const auto add_table = [&](std::size_t r, std::size_t c, float share) {
        if (share == 0) return;
        const ByCosine& table = tables_[r * columns_ + c];
        add(sum, table[angle.low], share * (1 - angle.share));
        add(sum, table[angle.low + 1], share * angle.share);
    };
    add_table(row.low, column.low, (1 - row.share) * (1 - column.share));
    add_table(row.low, column.low + 1, (1 - row.share) * column.share);
    add_table(row.low + 1, column.low, row.share * (1 - column.share));
    add_table(row.low + 1, column.low + 1, row.share * column.share);
    return sum;
}

// A facet's slope s turns what it reflects by 2 s, and what it refracts by (1 - 1/η) s; light passes the coat twice.
Microfacets seen_through(const Microfacets& metal, const Microfacets& coat, float eta) {
    const float turn = (1 - 1 / eta) / 2;
    const auto blurred = [&](float below, float above) {
        return std::sqrt(below * below + 2 * turn * turn * above * above);
    };
    const Microfacets both{blurred(metal.alpha_u, coat.alpha_u), blurred(metal.alpha_v, coat.alpha_v), metal.law};
    return smooth(both) ? Microfacets{} : at_least_rough(both);
}

Vec3 into_coat(Vec3 w, float eta) {
    const float scale = 1 / eta;
    return {w.x * scale, w.y * scale, std::sqrt(std::max(1e-8f, 1 - (w.x * w.x + w.y * w.y) * scale * scale))};
}

std::optional<Vec3> out_of_coat(Vec3 w, float eta) {
    const float x = w.x * eta, y = w.y * eta, z2 = 1 - x * x - y * y;
    if (!(z2 > 0)) return {};
    return Vec3{x, y, std::sqrt(z2)};
}

}  // namespace lightnet
