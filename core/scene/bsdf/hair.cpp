#include "core/scene/bsdf/hair.hpp"

#include "core/scene/bsdf/hair_ways.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/math/exponential.hpp"
#include "core/base/math/turns.hpp"
#include "core/scene/bsdf/fresnel.hpp"

namespace lightnet {
namespace {

/// A direction's angle to the plane across the fibre.
using Tilt = SineCosine;

float cosine_beside(float sine) { return std::sqrt(std::max(0.0f, 1 - sine * sine)); }

Rgb hair_exponential(Rgb x) { return {exponential(x.r), exponential(x.g), exponential(x.b)}; }

float to_the(int power, float x) {
    float product = 1;
    for (int i = 0; i < power; ++i) product *= x;
    return product;
}

/// e^-x times the modified Bessel function of order 0, x ≥ 0. Abramowitz and Stegun 1964, 9.8.1 and 9.8.2.
float scaled_bessel(float x) {
    if (x < 3.75f) {
        const float t = x / 3.75f, q = t * t;
        float sum = 0.0045813f;
        for (const float c : {0.0360768f, 0.2659732f, 1.2067492f, 3.0899424f, 3.5156229f, 1.0f}) sum = sum * q + c;
        return sum * exponential(-x);
    }
    const float t = 3.75f / x;
    float sum = 0.00392377f;
    for (const float c :
         {-0.01647633f, 0.02635537f, -0.02057706f, 0.00916281f, -0.00157565f, 0.00225319f, 0.01328592f, 0.39894228f})
        sum = sum * t + c;
    return sum / std::sqrt(x);
}

/// Per steradian, as if it were all alike around the fibre, times 2π. The longitudinal function of d'Eon et al. with
/// its exponents put together: narrow ones lose no digits.
float density_along(Tilt o, Tilt i, const HairBsdf::Along& by) {
    const float c = i.cosine - o.cosine, s = i.sine + o.sine;
    return scaled_bessel(i.cosine * o.cosine / by.variance) * exponential(-(c * c + s * s) / (2 * by.variance)) /
           by.whole;
}

/// Of a logistic distribution that is cut off at half a turn to both sides, per turn.
float density_around(float turned, const HairBsdf& hair) {
    const float off = std::fabs(turned - std::floor(turned + 0.5f));
    const float e = exponential(-off / hair.spread);
    return e / (hair.spread * (1 + e) * (1 + e) * hair.within);
}
/// A turn by it.
float sample_around(float u, const HairBsdf& hair) {
    const float part = std::clamp(0.5f + (u - 0.5f) * hair.within, 1e-7f, 1 - 1e-7f);
    return std::clamp(hair.spread * (logarithm(part) - logarithm(1 - part)), -0.5f, 0.5f);
}

/// How a fibre is seen, and which part of its light comes by each way.
struct Seen {
    Tilt tilt;
    float turn = 0;  // of the viewer around the fibre
    std::array<float, HairBsdf::ways> turned{};
    std::array<Rgb, HairBsdf::ways> share{};
    std::array<float, HairBsdf::ways> chance{};  // their sum is 1; or they are 0

    Seen(const HairBsdf& hair, Vec3 outgoing, std::uint8_t lobes);
    void share_out(float reflected, Rgb left, std::uint8_t lobes);
    Tilt tilted(const HairBsdf& hair, std::size_t way) const;
    BsdfValue from(const HairBsdf& hair, Vec3 incoming) const;
};

Seen::Seen(const HairBsdf& hair, Vec3 o, std::uint8_t lobes)
    : tilt{o.x, std::sqrt(o.y * o.y + o.z * o.z)}, turn(turns(o.z, o.y)) {
    const float straight = std::max(tilt.cosine, 1e-4f);
    const float across = std::clamp(hair.across ? *hair.across : -o.y / straight, -1.0f, 1.0f);
    const float height = cosine_beside(across);
    // Bravais: across the fibre light is bent as by another index
    const float bent = std::min(1.0f, tilt.cosine / std::sqrt(std::max(hair.eta * hair.eta - o.x * o.x, 1e-8f)));
    const float inside = across * bent, depth = cosine_beside(inside);
    const float in = turns(across, height), through = turns(inside, depth);
    for (std::size_t way = 0; way < HairBsdf::ways; ++way)
        turned[way] = 2 * float(way) * through - 2 * in + 0.5f * float(way);
    const float steep = std::max(cosine_beside(o.x / hair.eta), 1e-4f);
    share_out(fresnel_dielectric(std::max(straight * height, 1e-4f), hair.eta),
              hair_exponential(hair.absorption * (-2 * depth / steep)), lobes);
}

// All that goes on inside after TRT is the last one's: a geometric series.
void Seen::share_out(float reflected, Rgb left, std::uint8_t lobes) {
    const auto all_further = [&](float left_of_one) {
        const float again = left_of_one * reflected;
        return again < 1 ? again / (1 - again) : 0;
    };
    share[0] = {reflected, reflected, reflected};
    share[1] = left * ((1 - reflected) * (1 - reflected));
    share[2] = share[1] * left * reflected;
    share[3] = share[2] * Rgb{all_further(left.r), all_further(left.g), all_further(left.b)};
    if (lobes & without_way::r) share[0] = {};
    if (lobes & without_way::tt) share[1] = {};
    if (lobes & without_way::trt) share[2] = share[3] = {};
    float sum = 0;
    for (std::size_t way = 0; way < HairBsdf::ways; ++way) sum += chance[way] = luminance(share[way]);
    for (float& each : chance) each = sum > 0 ? each / sum : 0;
}

Tilt Seen::tilted(const HairBsdf& hair, std::size_t way) const {
    if (way >= hair.along.size()) return tilt;
    const auto [sine, cosine] = hair.along[way].scales;
    return {tilt.sine * cosine + tilt.cosine * sine, std::fabs(tilt.cosine * cosine - tilt.sine * sine)};
}

const HairBsdf::Along& along_of(const HairBsdf& hair, std::size_t way) {
    return hair.along[std::min(way, hair.along.size() - 1)];
}

BsdfValue Seen::from(const HairBsdf& hair, Vec3 i) const {
    const Tilt light{i.x, std::sqrt(i.y * i.y + i.z * i.z)};
    const float between = turns(i.z, i.y) - turn;
    BsdfValue sum;
    for (std::size_t way = 0; way < HairBsdf::ways; ++way) {
        float density = density_along(tilted(hair, way), light, along_of(hair, way)) * (0.5f * inverse_pi);
        if (way < hair.along.size()) density *= density_around(between - turned[way], hair);
        sum.value += share[way] * density;
        sum.pdf += chance[way] * density;
    }
    return sum;
}

/// One of the ways, and what is left of the number that chose it, 0 … 1.
struct ChosenWay {
    std::size_t way = 0;
    float rest = 0;
};
ChosenWay choose(const std::array<float, HairBsdf::ways>& chance, float choice) {
    ChosenWay chosen;
    for (std::size_t way = 0; way < HairBsdf::ways; ++way) {
        if (!(chance[way] > 0)) continue;
        chosen = {way, std::clamp(choice / chance[way], 0.0f, 1.0f)};
        if (choice < chance[way]) break;
        choice -= chance[way];
    }
    return chosen;
}

/// A tilt by density_along(). d'Eon 2013, "Importance Sampling for Physically-Based Hair Fiber Models".
Tilt sample_along(Tilt o, float variance, float u, float turn) {
    const float least = exponential(-2 / variance);
    const float off = std::clamp(-variance * logarithm(std::max(u + (1 - u) * least, 1e-37f)), 0.0f, 2.0f);
    const float aside = std::sqrt(off * (2 - off)) * sine_cosine_of_turns(turn).cosine;
    const float sine = std::clamp(aside * o.cosine - (1 - off) * o.sine, -1.0f, 1.0f);
    return {sine, cosine_beside(sine)};
}

}  // namespace

BsdfValue HairBsdf::evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    if (!(lobes & lobe::glossy)) return {};
    return Seen(*this, outgoing, lobes).from(*this, incoming);
}

std::optional<BsdfSample> HairBsdf::sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const {
    if (!(lobes & lobe::glossy)) return {};
    const Seen seen(*this, outgoing, lobes);
    const auto [way, rest] = choose(seen.chance, choice);
    const Tilt tilt = sample_along(seen.tilted(*this, way), along_of(*this, way).variance, u.y, rest);
    const float turned = way < along.size() ? seen.turned[way] + sample_around(u.x, *this) : u.x;
    const auto [sine, cosine] = sine_cosine_of_turns(seen.turn + turned);
    BsdfSample found;
    found.incoming = {tilt.sine, tilt.cosine * cosine, tilt.cosine * sine};
    found.lobe = lobe::glossy;
    found.transmitted = found.incoming.z < 0;
    return weighed(found, seen.from(*this, found.incoming));
}

// Variance and scale are the fits of Chiang et al., section 4.1; how much narrower TT is, how much wider TRT, and how
// scales turn each, are those of Marschner et al. 2003, "Light Scattering from Human Hair Fibers".
HairBsdf hair_fibre(Rgb absorption, float eta, const HairSurface& surface) {
    HairBsdf made;
    made.absorption = {std::clamp(absorption.r, 0.0f, 1e6f), std::clamp(absorption.g, 0.0f, 1e6f),
                       std::clamp(absorption.b, 0.0f, 1e6f)};
    made.eta = std::max(eta, 1.0f);
    const float m = std::clamp(surface.along, HairSurface::smoothest, 1.0f);
    const float n = std::clamp(surface.around, HairSurface::smoothest, 1.0f);
    const float deviation = 0.726f * m + 0.812f * m * m + 3.7f * to_the(20, m), variance = deviation * deviation;
    const float root_of_pi_over_8 = 0.626657069f;
    const float radians = root_of_pi_over_8 * (0.265f * n + 1.194f * n * n + 5.372f * to_the(22, n));
    made.spread = radians * (0.5f * inverse_pi);
    const float outside = exponential(-0.5f / made.spread);
    made.within = (1 - outside) / (1 + outside);
    const auto spread_by = [](float v, float turns) {
        return HairBsdf::Along{v, v * (1 - exponential(-2 / v)), sine_cosine_of_turns(turns)};
    };
    const float tilt = surface.tilt / 360;
    made.along = {spread_by(variance, -2 * tilt), spread_by(variance / 4, tilt), spread_by(variance * 4, 4 * tilt)};
    return made;
}

Rgb hair_absorption(Rgb colour, float around) {
    const float n = std::clamp(around, HairSurface::smoothest, 1.0f);
    const float scale = 5.969f + n * (-0.215f + n * (2.532f + n * (-10.73f + n * (5.574f + n * 0.245f))));
    const auto of = [&](float c) {
        const float root = logarithm(std::clamp(c, 1e-6f, 1.0f)) / scale;
        return root * root;
    };
    return {of(colour.r), of(colour.g), of(colour.b)};
}

Rgb melanin_absorption(float eumelanin, float pheomelanin) {
    return Rgb{0.419f, 0.697f, 1.37f} * std::max(eumelanin, 0.0f) +
           Rgb{0.187f, 0.4f, 1.05f} * std::max(pheomelanin, 0.0f);
}

HairBsdf HairMaterial::at(const MaterialInputs& inputs) const {
    const auto number = [&](TextureId texture) { return inputs.colour(texture).r; };
    const HairSurface surface{number(along), number(around), number(tilt)};
    Rgb absorption = inputs.colour(colour);
    if (means == Colour::reflectance) absorption = hair_absorption(absorption, surface.around);
    if (means == Colour::melanin) absorption = melanin_absorption(absorption.r, number(pheomelanin));
    return hair_fibre(absorption, number(eta), surface);
}

}  // namespace lightnet
