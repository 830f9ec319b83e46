#include "core/film/picture.hpp"

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

}  // namespace lightnet
