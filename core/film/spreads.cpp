#include "core/film/spreads.hpp"

#include <algorithm>
#include <cmath>

namespace lightnet {

double scale_of_noise(double sum) { return 1e-4 + (sum < 1 ? std::sqrt(std::max(0.0, sum)) : sum); }

void Spreads::note(std::size_t pixel, const Rgb& sum, double scale, std::uint32_t blocks) {
    const double block[3] = {sum.r * scale, sum.g * scale, sum.b * scale};
    PixelSpread& spread = all_[pixel];
    for (int c = 0; c < 3; ++c) {
        const double step = block[c] - spread.mean[c];
        spread.mean[c] += step / (blocks + 1);
        spread.squares[c] += step * (block[c] - spread.mean[c]);
    }
}

double Spreads::noise_of(std::size_t pixel, std::uint32_t blocks) const {
    const auto& [mean, squares] = all_[pixel];
    double deviation = 0;
    for (const double square : squares) deviation += std::sqrt(square / (double(blocks) * (double(blocks) - 1)));
    return deviation / scale_of_noise(mean[0] + mean[1] + mean[2]);
}

}  // namespace lightnet
