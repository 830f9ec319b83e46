#include "core/film/picture.hpp"

#include <algorithm>
#include <cassert>

namespace lightnet {

std::vector<Rgb> sum_of(const std::vector<PictureLayer>& layers) {
    if (layers.empty()) return {};
    std::vector<Rgb> sum = layers.front().pixels;
    for (std::size_t k = 1; k < layers.size(); ++k) {
        assert(layers[k].pixels.size() == sum.size() && "layers of one picture have one size");
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += layers[k].pixels[i];
    }
    return sum;
}

void blacken_overflow(Picture& picture) {
    for (std::size_t i = 0; i < picture.beauty.size(); ++i) {
        const bool sound = finite(picture.beauty[i]) &&
                           std::all_of(picture.layers.begin(), picture.layers.end(),
                                       [&](const PictureLayer& layer) { return finite(layer.pixels[i]); });
        bool over = !sound;
        if (!sound) {
            picture.beauty[i] = {};
            for (auto& layer : picture.layers) layer.pixels[i] = {};
        }
        for (auto& layer : picture.shown)
            if (!finite(layer.pixels[i])) layer.pixels[i] = {}, over = true;
        picture.overflowed += over;
    }
}

}  // namespace lightnet
