#include "core/scene/bsdf/phase.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/math/frame.hpp"
#include "core/base/math/sampling.hpp"

namespace lightnet {
namespace {

constexpr float least_g = 1e-3f;  // below it, as good as isotropic

// Henyey & Greenstein 1941, "Diffuse radiation in the galaxy".
float henyey_greenstein(float g, float cosine) {
    const float square = std::max(1e-12f, 1 + g * g - 2 * g * cosine);
    return (1 - g * g) / (4 * pi * square * std::sqrt(square));
}
float henyey_greenstein_cosine(float g, float u) {
    if (std::fabs(g) < least_g) return 2 * u - 1;
    const float root = (1 - g * g) / (1 - g + 2 * g * u);
    return (1 + g * g - root * root) / (2 * g);
}

// Frisvad 2011, "Importance sampling the Rayleigh phase function".
float rayleigh_cosine(float u) {
    const float a = 2 - 4 * u;
    const float b = std::cbrt(std::sqrt(1 + a * a) - a);
    return b - 1 / b;
}

float width_of(const std::vector<float>& table) { return 2.0f / float(table.size() - 1); }

float tabulated(const std::vector<float>& table, float cosine) {
    const float at = std::clamp((cosine + 1) / width_of(table), 0.0f, float(table.size() - 1));
    const auto left = std::min(static_cast<std::size_t>(at), table.size() - 2);
    const float part = at - float(left);
    return table[left] * (1 - part) + table[left + 1] * part;
}

// The cosine below which a share `u` of the light goes, of a table whose densities' integral is 1.
float tabulated_cosine(const std::vector<float>& table, float u) {
    const float width = width_of(table);
    float left_over = u / (2 * pi);
    std::size_t i = 0;
    for (; i + 2 < table.size(); ++i) {
        const float here = (table[i] + table[i + 1]) / 2 * width;
        if (left_over < here) break;
        left_over -= here;
    }
    // within it: a + b t is the density, t in 0 … 1
    const float a = table[i], b = table[i + 1] - a, wanted = left_over / width;
    const float root = std::sqrt(std::max(0.0f, a * a + 2 * b * wanted));
    const float t = a + root > 0 ? 2 * wanted / (a + root) : 0.5f;
    return std::min(-1 + (float(i) + std::clamp(t, 0.0f, 1.0f)) * width, 1.0f);
}

}  // namespace

std::string PhaseFunction::fault() const {
    if (!(std::fabs(g) < 1)) return "the mean cosine 'g' of a phase function must be between -1 and 1";
    const auto sound = [](float density) { return std::isfinite(density) && density >= 0; };
    if (!std::all_of(table.begin(), table.end(), sound)) return "the values of a phase function can't be negative";
    const bool dark = std::all_of(table.begin(), table.end(), [](float density) { return density == 0; });
    if (law == Law::tabulated && (table.size() < 2 || dark))
        return "a phase function's table needs two values at least, and not only zeros";
    if (law != Law::blend) return {};
    if (parts.empty() || parts.size() != table.size() || dark) return "a blend of phase functions needs shares";
    for (const PhaseFunction& part : parts)
        if (auto why = part.fault(); !why.empty()) return why;
    return {};
}

void PhaseFunction::normalise() {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < table.size() && law == Law::tabulated; ++i)
        sum += 2.0 * pi * (double(table[i]) + table[i + 1]) / 2 * width_of(table);
    if (law == Law::blend)
        for (const float share : table) sum += share;
    if (sum > 0)
        for (float& value : table) value = float(value / sum);
    for (PhaseFunction& part : parts) part.normalise();
}

float PhaseFunction::density(float cosine) const {
    switch (law) {
        case Law::isotropic:
            return 1 / (4 * pi);
        case Law::henyey_greenstein:
            return henyey_greenstein(g, cosine);
        case Law::rayleigh:
            return 3 / (16 * pi) * (1 + cosine * cosine);
        case Law::tabulated:
            return tabulated(table, cosine);
        case Law::blend:
            break;
    }
    float sum = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) sum += table[i] * parts[i].density(cosine);
    return sum;
}

float PhaseFunction::cosine(float choice, float u) const {
    switch (law) {
        case Law::isotropic:
            return 2 * u - 1;
        case Law::henyey_greenstein:
            return henyey_greenstein_cosine(g, u);
        case Law::rayleigh:
            return rayleigh_cosine(u);
        case Law::tabulated:
            return tabulated_cosine(table, u);
        case Law::blend:
            break;
    }
    std::size_t i = 0;
    for (; i + 1 < parts.size() && choice >= table[i]; ++i) choice -= table[i];
    return parts[i].cosine(std::clamp(choice / std::max(table[i], 1e-12f), 0.0f, 0x1.fffffep-1f), u);
}

BsdfValue PhaseBsdf::evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    if (!(lobes & lobe::diffuse)) return {};
    const float density = phase->density(-dot(outgoing, incoming));
    return {albedo * density, density};
}

// Around the direction from which the viewer looks: light that goes straight on comes from there.
std::optional<BsdfSample> PhaseBsdf::sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const {
    if (!(lobes & lobe::diffuse)) return {};
    const float cosine = std::clamp(phase->cosine(choice, u.x), -1.0f, 1.0f);
    const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine)), turn = 2 * pi * u.y;
    const Vec3 local{sine * std::cos(turn), sine * std::sin(turn), cosine};
    const Vec3 incoming = normalize(Frame::around(-outgoing).to_world(local));
    const float density = phase->density(-dot(outgoing, incoming));
    if (!(density > 0)) return {};
    return BsdfSample{incoming, albedo, density, lobe::diffuse, true};
}

}  // namespace lightnet
