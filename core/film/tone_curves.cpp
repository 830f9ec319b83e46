#include "core/film/tone_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lightnet {
namespace {

constexpr float far_beyond = 1e4f;  // long before squares overflow

using Rows = std::array<float, 9>;

Rgb times(const Rows& m, Rgb c) {
    return {m[0] * c.r + m[1] * c.g + m[2] * c.b, m[3] * c.r + m[4] * c.g + m[5] * c.b,
            m[6] * c.r + m[7] * c.g + m[8] * c.b};
}

template <class Curve>
Rgb each(Rgb c, const Curve& curve) {
    return {curve(c.r), curve(c.g), curve(c.b)};
}

float within(float value) { return value > 0 ? std::min(value, far_beyond) : 0; }

float narkowicz(float x) { return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f); }

Rgb aces(Rgb linear) {
    constexpr Rows in{0.59719f, 0.35458f, 0.04823f, 0.07600f, 0.90834f, 0.01566f, 0.02840f, 0.13383f, 0.83777f};
    constexpr Rows out{1.60475f, -0.53108f, -0.07367f, -0.10208f, 1.10813f, -0.00605f, -0.00327f, -0.07276f, 1.07602f};
    const auto fit = [](float v) {
        return (v * (v + 0.0245786f) - 0.000090537f) / (v * (0.983729f * v + 0.4329510f) + 0.238081f);
    };
    return times(out, each(times(in, linear), fit));
}

Rgb agx(Rgb linear) {
    constexpr Rows in{0.842479062253094f,  0.0784335999999992f, 0.0792237451477643f,
                      0.0423282422610123f, 0.878468636469772f,  0.0791661274605434f,
                      0.0423756549057051f, 0.0784336f,          0.879142973793104f};
    constexpr Rows out{1.19687900512017f,    -0.0980208811401368f, -0.0990297440797205f,
                       -0.0528968517574562f, 1.15190312990417f,    -0.0989611768448433f,
                       -0.0529716355144438f, -0.0980434501171241f, 1.15107367264116f};
    constexpr float least_stops = -12.47393f, most_stops = 4.026069f;  // stops
    const auto contrast = [](float v) {
        const float x = std::clamp((std::log2(std::max(v, 1e-10f)) - least_stops) / (most_stops - least_stops), 0.0f,
                                   1.0f),
                    x2 = x * x, x4 = x2 * x2;
        return 15.5f * x4 * x2 - 40.14f * x4 * x + 31.96f * x4 - 6.868f * x2 * x + 0.4298f * x2 + 0.1191f * x -
               0.00232f;
    };
    const auto linear_again = [](float v) { return v > 0 ? std::pow(v, 2.2f) : 0; };
    return each(times(out, each(times(in, linear), contrast)), linear_again);
}

}  // namespace

Rgb toned(Rgb linear, Tone tone) {
    if (tone == Tone::clipped) return linear;
    const Rgb sound = each(linear, within);
    if (tone == Tone::filmic)
        return {sound.r == far_beyond ? 1 : narkowicz(sound.r), sound.g == far_beyond ? 1 : narkowicz(sound.g),
                sound.b == far_beyond ? 1 : narkowicz(sound.b)};
    return tone == Tone::aces ? aces(sound) : agx(sound);
}

}  // namespace lightnet
