#include "core/film/clean/rounds.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/film/clean/clean.hpp"

namespace lightnet {
namespace {

// Of a pixel that is off by `error`, in parts of the root of value² + 0.01: what is darker than 0.1 is not known
// better.
double noise_of(const Rgb& value, double error, double scale) {
    double sum = 0;
    for (const double channel : {value.r, value.g, value.b}) sum += std::sqrt(channel * channel + 0.01) * scale;
    return error * sum / scale_of_noise(sum);
}

// Of each pixel of a picture after cleaning.
std::vector<double> noise_left(Picture noisy, double scale) {
    for (auto& layer : noisy.layers) layer.gain = {1, 1, 1};
    const Picture picture = clean(std::move(noisy)).picture;
    const auto error = std::find_if(picture.shown.begin(), picture.shown.end(),
                                    [](const auto& shown) { return shown.name == clean_error; });
    std::vector<double> noise(picture.beauty.size());
    for (std::size_t i = 0; i < noise.size() && error != picture.shown.end(); ++i)
        noise[i] = noise_of(picture.beauty[i], error->pixels[i].r, scale);
    return noise;
}

}  // namespace

// DECISIONS: rounds-by-the-cleaned-picture
std::vector<Tile> end_round_if_over(Film& film) {
    if (!film.round_is_over()) return {};
    return film.end_round(noise_left(film.picture(), film.scale()));
}

}  // namespace lightnet
