#include "core/film/picture.hpp"

#include <half.h>

#include <algorithm>
#include <cassert>

namespace lightnet {
namespace {

// A sum of finite layers may still be more than a float32 holds.
bool adds_up(const std::vector<PictureLayer>& layers, std::size_t pixel) {
    Rgb sum;
    for (const auto& layer : layers) sum += layer.pixels[pixel];
    return finite(sum);
}

void blacken_layers(Picture& picture, std::size_t pixels) {
    for (std::size_t i = 0; i < pixels; ++i) {
        bool over = !adds_up(picture.layers, i);
        if (over)
            for (auto& layer : picture.layers) layer.pixels[i] = {};
        for (auto& layer : picture.shown)
            if (!finite(layer.pixels[i])) layer.pixels[i] = {}, over = true;
        picture.overflowed += over;
    }
}

}  // namespace

void round_to_half(std::vector<Rgb>& pixels) {
    const auto rounded = [](float value) {
        constexpr float most = HALF_MAX;
        return float(half(std::clamp(value, -most, most)));
    };
    for (Rgb& pixel : pixels) pixel = {rounded(pixel.r), rounded(pixel.g), rounded(pixel.b)};
}

const std::vector<std::string>& lossless_compressions() {
    static const std::vector<std::string> all{"none", "rle", "zips", "zip", "piz"};
    return all;
}

std::vector<Rgb> sum_of(const std::vector<PictureLayer>& layers) {
    if (layers.empty()) return {};
    std::vector<Rgb> sum(layers.front().pixels.size());
    for (std::size_t k = 0; k < layers.size(); ++k) {
        assert(layers[k].pixels.size() == sum.size() && "layers of one picture have one size");
        for (std::size_t i = 0; i < sum.size(); ++i) {
            const Rgb part = layers[k].gain * layers[k].pixels[i];
            sum[i] = k == 0 ? part : sum[i] + part;
        }
    }
    return sum;
}

void blacken_overflow(Picture& picture) {
    blacken_layers(picture, std::size_t{picture.width} * picture.height);
    make_beauty(picture);
}

// DECISIONS: gains-after-all
void make_beauty(Picture& picture) {
    picture.beauty = sum_of(picture.layers);
    for (auto& pixel : picture.beauty)
        if (!finite(pixel)) pixel = {}, ++picture.overflowed;
}

}  // namespace lightnet
