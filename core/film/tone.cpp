#include "core/film/tone.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lightnet {
namespace {

constexpr double most = 0.5;                      // of the pixels
constexpr double hardly_any = 0.05;               // of the pixels
constexpr float darkest = 0.5f / (255 * 12.92f);  // the least that is not black in 8 bits of sRGB
// DECISIONS: hint-at-an-exposure
constexpr float bright = 0.9f, middle = 0.5f;  // what pixels should become

// Sorts some of it.
float quantile(std::vector<float>& values, double share) {
    if (values.empty()) return 0;
    const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

double rounded_down(double stops) { return std::floor(stops * 10) / 10; }

}  // namespace

Brightness brightness_of(const Picture& picture, double stops) {
    Brightness found;
    const auto exposure = static_cast<float>(std::exp2(stops));
    std::vector<float> values, lit;
    for (const Rgb& pixel : picture.beauty) {
        float value = 0;  // what is no number is black
        for (const float channel : {pixel.r, pixel.g, pixel.b})
            if (channel * exposure > value) value = channel * exposure;
        values.push_back(value);
        if (value > 0) lit.push_back(value);
        found.clipped += value > 1;
        found.black += value < darkest;
    }
    const auto pixels = static_cast<double>(std::max<std::size_t>(1, values.size()));
    found.clipped /= pixels, found.black /= pixels;
    found.lit = static_cast<double>(lit.size()) / pixels;
    found.high = quantile(values, 0.95);
    found.lit_high = quantile(lit, 0.9);
    return found;
}

std::optional<double> helpful_stops(const Brightness& brightness) {
    if (brightness.clipped > most) {
        if (!std::isfinite(brightness.high)) return std::nullopt;
        return rounded_down(std::log2(bright / brightness.high));
    }
    if (brightness.black <= most || brightness.lit < hardly_any) return std::nullopt;
    const double stops = rounded_down(std::log2(middle / brightness.lit_high));
    return stops >= 1 ? std::optional(stops) : std::nullopt;  // else things stand on a black ground
}

std::optional<PictureView> picture_view(std::string_view text) {
    if (text == "auto") return PictureView::automatic;
    if (text == "plain") return PictureView::plain;
    if (text == "filmic") return PictureView::filmic;
    if (text == "aces") return PictureView::aces;
    if (text == "agx") return PictureView::agx;
    return std::nullopt;
}

namespace {

Tone tone_by(PictureView view) {
    switch (view) {
        case PictureView::filmic:
            return Tone::filmic;
        case PictureView::aces:
            return Tone::aces;
        case PictureView::agx:
            return Tone::agx;
        case PictureView::ocio:
            return Tone::ocio;
        default:
            return Tone::clipped;
    }
}

}  // namespace

PngView png_view(const PngRequest& wanted, const Brightness& brightness, bool exposed) {
    const bool chosen = exposed || wanted.view == PictureView::plain;
    const double usual = chosen ? 0 : helpful_stops(brightness).value_or(0);
    return {wanted.stops.value_or(usual), tone_by(wanted.view), wanted.ocio, wanted.alpha};
}

bool hardly_lit(const Brightness& brightness) { return brightness.black > most && brightness.lit < hardly_any; }

}  // namespace lightnet
